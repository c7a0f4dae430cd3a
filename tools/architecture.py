# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws docs/architecture.svg from the imports of the code itself: `make docs`.

A room is a package, or a module above those beside it. It stands on the floor above all that it imports; an
arrow leads to what it imports, unless others lead there already by way of a third room. Rooms that import
each other cannot be drawn.
"""

from __future__ import annotations

import ast
import sys
import textwrap
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

import grimp

from .project import ROOT, ToolError

PICTURE = ROOT / "docs" / "architecture.svg"
PACKAGE = "ocean_tweak"

#: of a room, and between rooms and floors, pixels
WIDTH, HEIGHT, GAP, STAIRS = 250, 72, 30, 36
MARGIN = 24
#: letters of a line in a room, and lines of what is told of it
LETTERS, LINES = 42, 2
#: of the ground floor's packages, by the first package under `ocean_tweak`
COLOURS = {
    "core": "#dbeafe", "export": "#dcfce7", "nodes": "#fef9c3", "scene": "#ffedd5", "ui": "#fce7f3",
    "cli": "#ede9fe",
}  # fmt: skip


@dataclass(frozen=True)
class Room:
    """A package, or one module.

    name : its dotted path below `ocean_tweak`
    about : first sentence of its docstring
    modules : how many it has in all
    """

    name: str
    about: str
    modules: int


Imports = Mapping[str, frozenset[str]]


def main() -> int:
    """Write the picture; return the exit code."""
    try:
        PICTURE.write_text(picture(*house()), encoding="utf-8")
    except ToolError as error:
        print(f"architecture failed: {error}", file=sys.stderr)
        return 1
    return 0


def house() -> tuple[dict[str, Room], Imports]:
    """Return the rooms by name, and which others each imports."""
    graph = grimp.build_graph(PACKAGE, exclude_type_checking_imports=True, cache_dir=None)
    modules = {module.removeprefix(PACKAGE).removeprefix("."): module for module in graph.modules}
    below = {name: _names(graph.find_modules_directly_imported_by(path)) for name, path in modules.items()}
    rooms_of = {name: _room_of(name, below) for name in modules if name}
    imports: dict[str, set[str]] = {room: set() for room in rooms_of.values()}
    for name, room in rooms_of.items():
        imports[room] |= {rooms_of[other] for other in below[name] if other} - {room}
    rooms = {room: _room(room, [name for name in rooms_of if rooms_of[name] == room]) for room in imports}
    return rooms, {room: frozenset(others) for room, others in imports.items()}


def _names(modules: Iterable[str]) -> set[str]:
    return {module.removeprefix(PACKAGE).removeprefix(".") for module in modules}


def _room_of(name: str, below: Imports) -> str:
    """Return the room of a module: the package at most two names deep in which it is.

    A module beside packages is in one room with its like, unless it imports from those: then it is above
    them, and a room of its own.
    """
    package, *inside = name.split(".")
    if not inside:
        return package
    folder = ROOT / PACKAGE / package
    if _is_package(folder / inside[0]):
        return f"{package}.{inside[0]}"
    seen, left = {name}, [name]
    while left:
        for other in below[left.pop()] - seen:
            if other.startswith(f"{package}."):
                if _is_package(folder / other.split(".")[1]):
                    return name
                seen.add(other)
                left.append(other)
    return package


def _room(name: str, modules: Sequence[str]) -> Room:
    path = ROOT / PACKAGE / Path(*name.split("."))
    about = path / "__init__.py" if _is_package(path) else path.with_suffix(".py")
    files = [path for module in modules for path in _files(module) if path.stat().st_size]
    return Room(
        name,
        (ast.get_docstring(ast.parse(about.read_text(encoding="utf-8"))) or "").split("\n")[0],
        len(files),
    )


def _is_package(path: Path) -> bool:
    """Whether this is a package, and not what Python left where one was."""
    return (path / "__init__.py").exists()


def _files(module: str) -> list[Path]:
    path = ROOT / PACKAGE / Path(*module.split("."))
    return [file for file in (path.with_suffix(".py"), path / "__init__.py") if file.exists()]


def floors(imports: Imports) -> dict[str, int]:
    """Return the floor of each room, 0 for those that import none.

    Raises `ToolError` for rooms that import each other.
    """
    found: dict[str, int] = {}
    while len(found) < len(imports):
        ready = [name for name in imports if name not in found and imports[name] <= found.keys()]
        if not ready:
            circle = ", ".join(sorted(imports.keys() - found.keys()))
            raise ToolError(f"among these rooms are some that import each other: {circle}")
        found |= {name: 1 + max((found[below] for below in imports[name]), default=-1) for name in ready}
    return found


def without_detours(imports: Imports) -> dict[str, set[str]]:
    """Return the imports without those that others imply: transitive reduction."""
    height = floors(imports)
    reachable: dict[str, set[str]] = {}
    for name in sorted(imports, key=height.__getitem__):
        reachable[name] = set(imports[name]).union(*(reachable[below] for below in imports[name]))
    return {
        name: {below for below in others if not any(below in reachable[other] for other in others)}
        for name, others in imports.items()
    }


def picture(rooms: Mapping[str, Room], imports: Imports) -> str:
    """Return the SVG. Raises `ToolError` for rooms that import each other."""
    arrows = without_detours(imports)
    rows = _rows(floors(imports), arrows)
    widest = max(len(row) for row in rows)
    width = 2 * MARGIN + widest * (WIDTH + GAP) - GAP
    height = 2 * MARGIN + len(rows) * (HEIGHT + STAIRS) - STAIRS
    places = {
        name: (
            width / 2 + (index - (len(row) - 1) / 2) * (WIDTH + GAP),
            height - MARGIN - HEIGHT - floor * (HEIGHT + STAIRS),
        )
        for floor, row in enumerate(rows)
        for index, name in enumerate(row)
    }
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        'font-family="system-ui, sans-serif" font-size="11">',
        f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
        '<defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" '
        'orient="auto"><path d="M0 0 8 4 0 8z" fill="#64748b"/></marker></defs>',
    ]
    for name, others in sorted(arrows.items()):
        parts += [_arrow(places[name], places[below]) for below in sorted(others)]
    parts += [_box(rooms[name], *places[name]) for name in sorted(places)]
    return "\n".join([*parts, "</svg>", ""])


def _rows(height: Mapping[str, int], arrows: Mapping[str, set[str]]) -> list[list[str]]:
    """Rooms floor by floor, each under what imports it as far as there is room (barycentres, a few times)."""
    rows: list[list[str]] = [[] for _ in range(max(height.values()) + 1)]
    for name in sorted(height):
        rows[height[name]].append(name)
    above = defaultdict(set)
    for name, others in arrows.items():
        for other in others:
            above[other].add(name)
    for turn in range(24):
        place = {name: index - (len(row) - 1) / 2 for row in rows for index, name in enumerate(row)}
        neighbours = arrows if turn % 2 else above
        for row in rows if turn % 2 else rows[::-1]:
            centre = {
                name: sum(place[other] for other in near) / len(near)
                if (near := neighbours[name])
                else place[name]
                for name in row
            }
            row.sort(key=lambda name: (centre[name], name))
            place |= {name: index - (len(row) - 1) / 2 for index, name in enumerate(row)}
    return rows


def _arrow(start: tuple[float, float], end: tuple[float, float]) -> str:
    x1, y1, x2, y2 = start[0], start[1] + HEIGHT, end[0], end[1] - 2
    bend = min(60.0, (y2 - y1) / 2)
    return (
        f'<path d="M{x1:.0f} {y1:.0f}C{x1:.0f} {y1 + bend:.0f} {x2:.0f} {y2 - bend:.0f} {x2:.0f} {y2:.0f}" '
        'fill="none" stroke="#94a3b8" stroke-width="1.2" marker-end="url(#head)"/>'
    )


def _box(room: Room, x: float, y: float) -> str:
    colour = COLOURS.get(room.name.partition(".")[0], "#f1f5f9")
    left = x - WIDTH / 2
    about = textwrap.wrap(room.about, LETTERS, max_lines=LINES, placeholder=" …")
    size = f"{room.modules} module{'s' * (room.modules != 1)}"
    rows = [
        (17, "bold", room.name),
        *((33 + 14 * n, "normal", line) for n, line in enumerate([*about, size])),
    ]
    texts = "".join(
        f'<text x="{x:.0f}" y="{y + down:.0f}" text-anchor="middle" font-weight="{weight}" fill="#0f172a">'
        f"{escape(text)}</text>"
        for down, weight, text in rows
    )
    title = f"<title>{escape(room.about)}</title>"
    return (
        f'<g>{title}<rect x="{left:.0f}" y="{y:.0f}" width="{WIDTH}" height="{HEIGHT}" rx="7" '
        f'fill="{colour}" stroke="#64748b"/>{texts}</g>'
    )


if __name__ == "__main__":
    sys.exit(main())
