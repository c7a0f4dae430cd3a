# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds functions and classes of `ocean_tweak` that nothing in it uses: part of `make lint`.

What only tests call is tested and does not ship. What is meant for others stands in PUBLIC, with the reason.
Functions of a module are looked up by module and name, methods by their name alone.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from .project import ROOT

PACKAGE = "ocean_tweak"

#: what nothing in the program calls → why it is there
PUBLIC = {
    "__getattr__": "`ocean_tweak.read_sea` and `write_sea` (README)",
    "core.waves.image.filters.unit_gain": "the gain with which Mastin's images were made (make papers)",
    "core.spectral.sea_state.field_state": "measures any elevation field (make demo)",
    "core.spectral.wave_number_spectra.jonswap": "for a transform of one's own (docs/python.md)",
    "core.spectral.wave_number_spectra.phillips": "for a transform of one's own (docs/python.md)",
    "core.spectral.wave_number_spectra.pierson_moskowitz": "for a transform of one's own, as above",
    "core.spectral.wave_number_spectra.tessendorf_constant": "mends Tessendorf's amplitudes (docs/python.md)",
    "core.waves.wake.elevation.wake_elevation": "a wake by itself, for scripts (docs/python.md)",
    "core.waves.wind_field.wind.sampled_wind": "a wind given as a function (docs/wind-fields.md)",
    "core.waves.coast.march.propagate": "single waves over any bed, without a sea (docs/python.md)",
    "registration.register": "the extension's door, __init__.py at the top, calls it",
}

#: methods that Blender or Python calls by their name
CALLED_FROM_OUTSIDE = frozenset(
    (
        "cancel", "check", "description", "draw", "draw_header", "draw_item", "draw_prepare", "emit",
        "execute", "handleError", "invoke", "modal", "poll", "setup",
    )
)  # fmt: skip


def main() -> int:
    """Print what is unused, or listed without need; return 1 where there is any."""
    modules = read_package(ROOT / PACKAGE)
    unused = set(unused_names(modules))
    for name in sorted(unused - PUBLIC.keys()):
        print(f"{PACKAGE}.{name}: nothing in {PACKAGE} uses it. Remove it, or list it in tools/unused.py")
    for name in sorted(PUBLIC.keys() - unused):
        print(f"{PACKAGE}.{name}: is listed in tools/unused.py, and is used or not there")
    return 1 if unused ^ PUBLIC.keys() else 0


def read_package(folder: Path) -> dict[str, ast.Module]:
    """Modules by their dotted names below the package; the package's own is ""."""
    found = {}
    for path in sorted(folder.rglob("*.py")):
        parts = path.relative_to(folder).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        found[name] = ast.parse(path.read_text(encoding="utf-8"))
        found[name].is_package = parts[-1] == "__init__"  # type: ignore[attr-defined]
    return found


def unused_names(modules: Mapping[str, ast.Module]) -> Iterator[str]:
    """Functions, classes and methods that no other code uses, as `module.name` or `module.Class.name`."""
    known = {name: {item.name for item in _definitions(tree)} for name, tree in modules.items()}
    used: set[tuple[str, str]] = set()
    attributes: set[str] = set()
    for name, tree in modules.items():
        uses = _Uses(name, modules, known)
        uses.visit(tree)
        used |= uses.found
        attributes |= uses.attributes
    used |= {_origin(module, name, modules) for module, name in used}
    for module, tree in modules.items():
        for item in _definitions(tree):
            if (module, item.name) not in used:
                yield f"{module}.{item.name}".lstrip(".")
            elif isinstance(item, ast.ClassDef):
                for method in _definitions(item):
                    if not _is_called(method.name, attributes):
                        yield f"{module}.{item.name}.{method.name}"


def _definitions(tree: ast.Module | ast.ClassDef) -> list[ast.FunctionDef | ast.ClassDef]:
    return [item for item in tree.body if isinstance(item, ast.FunctionDef | ast.ClassDef)]


def _is_called(method: str, attributes: set[str]) -> bool:
    return method.startswith("__") or method in CALLED_FROM_OUTSIDE or method in attributes


def _imports(tree: ast.AST, module: str, is_package: bool) -> Iterator[tuple[str, str, str]]:
    """Module, name in it and name here, of relative imports at any depth."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level:
            parts = module.split(".") if module else []
            up = node.level - (1 if is_package else 0)
            base = [*parts[: len(parts) - up], *(node.module.split(".") if node.module else [])]
            for alias in node.names:
                yield ".".join(base), alias.name, alias.asname or alias.name


def _origin(module: str, name: str, modules: Mapping[str, ast.Module]) -> tuple[str, str]:
    """Where a name that a module only hands on was defined."""
    tree = modules.get(module)
    if tree is None or name in {item.name for item in _definitions(tree)}:
        return module, name
    for source, imported, here in _imports(tree, module, tree.is_package):  # type: ignore[attr-defined]
        if here == name and (source, imported) != (module, name):
            return _origin(source, imported, modules)
    return module, name


class _Uses(ast.NodeVisitor):
    """What a module uses: (module, name) of definitions, and all attributes' names."""

    def __init__(self, module: str, modules: Mapping[str, ast.Module], known: Mapping[str, set[str]]) -> None:
        self.found: set[tuple[str, str]] = set()
        self.attributes: set[str] = set()
        self._module, self._own = module, known[module]
        self._modules: dict[str, str] = {}
        self._names: dict[str, tuple[str, str]] = {}
        self._inside: list[str] = []
        tree = modules[module]
        for source, name, here in _imports(tree, module, tree.is_package):  # type: ignore[attr-defined]
            whole = f"{source}.{name}".lstrip(".")
            if whole in modules:
                self._modules[here] = whole
            else:
                self._names[here] = (source, name)

    def _visit_definition(self, node: ast.FunctionDef | ast.ClassDef) -> None:
        self._inside.append(node.name)
        self.generic_visit(node)
        self._inside.pop()

    visit_FunctionDef = visit_ClassDef = _visit_definition

    def visit_Name(self, node: ast.Name) -> None:
        """A name, but not where a function calls itself."""
        if node.id in self._own and node.id not in self._inside[:1]:
            self.found.add((self._module, node.id))
        elif node.id in self._names:
            self.found.add(self._names[node.id])

    def visit_Attribute(self, node: ast.Attribute) -> None:
        """An attribute: of a module what it defines, of all else a method or property."""
        if isinstance(node.value, ast.Name) and node.value.id in self._modules:
            self.found.add((self._modules[node.value.id], node.attr))
        else:
            self.attributes.add(node.attr)
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        """Texts are attributes' names too: `getattr`, Blender's properties."""
        if isinstance(node.value, str):
            self.attributes.add(node.value.rpartition(".")[2])


if __name__ == "__main__":
    sys.exit(main())
