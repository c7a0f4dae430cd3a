# SPDX-License-Identifier: GPL-3.0-or-later
"""What one copy of the package makes of a sea, as pairs of a label and a value that can be compared."""

from __future__ import annotations

import importlib
import tempfile
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

TIMES = (Fraction(0), Fraction(13, 4))
#: places off the samples, some outside of the domain, m
X, Y = np.array([1.0, 37.3, -8.0, 222.0, 90.5]), np.array([2.0, 81.9, 44.0, -3.0, 91.0])

Made = tuple[str, Any]

#: what labels of node groups begin with
_GROUP = "node group"


def part(package: ModuleType, *names: str) -> Any:
    """Return a module of a copy of the package: the first of these that it has, for rooms were moved."""
    for name in names:
        path = Path(package.__path__[0], *name.split("."))
        if path.with_suffix(".py").exists() or (path / "__init__.py").exists():
            return importlib.import_module(f"{package.__name__}.{name}")
    raise ModuleNotFoundError(f"{package.__name__} has none of {', '.join(names)}")


def channels(package: ModuleType) -> tuple[str, ...]:
    """Return the names of all fields; their table was another one once."""
    table = part(package, "core.synthesis.channels", "core.channels", "core.fields")
    return tuple(table.CHANNELS if hasattr(table, "CHANNELS") else table.KNOWN)


def of_sea(package: ModuleType, data: dict[str, Any]) -> Iterator[Made]:
    """Yield all fields, heights and numbers of a sea given as JSON has it."""
    core = part(package, "core")
    parameters = core.OceanParameters.from_dict(data)
    if parameters.is_cascade:
        yield from _of_patches(package, parameters)
    else:
        yield from _of_grid(package, parameters)


def _of_grid(package: ModuleType, parameters: Any) -> Iterator[Made]:
    core, known = part(package, "core"), channels(package)
    make = core.grid_sea if hasattr(core, "grid_sea") else core.Ocean
    for precision in ("single", "double"):
        sea = make(parameters, precision)
        for time in TIMES:
            fields = sea.surface(time, known)
            yield from ((f"{precision} {name} at {time} s", getattr(fields, name)) for name in known)
    sea = make(parameters)
    surfaces = ("mesh",) if parameters.trough_damping else ("mesh", "exact")
    yield from _of_places(sea, surfaces)
    told = sea.statistics().to_dict()
    told.pop("patches", None)  # of joined ones they were not told
    yield "statistics", told
    shot = part(package, "core.parameters.shot", "core.shot").Shot(parameters)
    yield (
        "fingerprint",
        part(package, "core.parameters.fingerprint", "core.fingerprint").shot_fingerprint(shot),
    )


def _of_patches(package: ModuleType, parameters: Any) -> Iterator[Made]:
    core, known = part(package, "core"), channels(package)
    is_one_door = not hasattr(core, "Cascade")
    sea = core.Ocean(parameters) if is_one_door else core.Cascade(parameters)
    for time in TIMES:
        if is_one_door:
            fields = sea.surface(time, known, core.Places(X, Y))
        else:
            fields = sea.fields_at(X, Y, time, known)
        yield from ((f"{name} at {time} s", getattr(fields, name)) for name in known)
        outputs = {"displacement", "strain"}
        for number, patch in enumerate(sea.patches, start=1):
            of_patch = patch.surface(time, outputs)
            yield f"patch {number} displacement at {time} s", of_patch.displacement
            yield f"patch {number} strain at {time} s", of_patch.strain
    yield from _of_places(sea, ("mesh", "exact"))
    yield "statistics", sea.statistics().to_dict()


def _of_places(sea: Any, surfaces: tuple[str, ...]) -> Iterator[Made]:
    for surface in surfaces:
        points = sea.points_at(X, Y, TIMES[-1], surface, velocity=True)
        for name in ("height", "rest", "normal", "velocity"):
            yield f"{surface} {name}", getattr(points, name)


def of_usd(package: ModuleType, data: dict[str, Any]) -> Iterator[Made]:
    """Yield the values of all attributes of an export in each form, without what names files."""
    from pxr import Sdf, Usd

    core, export = part(package, "core"), part(package, "export.usd.export")
    shot = part(package, "core.parameters.shot", "core.shot").Shot(
        core.OceanParameters.from_dict({**data, "resolution": 16})
    )
    for form in ("points", "clips", "displacement"):
        with tempfile.TemporaryDirectory(prefix="same-seas-") as folder:
            wanted = part(package, "export.usd.package").Package("sea", shot, (1, 2), form=form, proxy=0)
            made = export.Export(wanted, Path(folder) / "sea.usd")
            for _ in made.make(wanted.frames):
                pass
            made.finish()
            stage = Usd.Stage.Open(str(made.top))
            for prim in stage.TraverseAll():
                for attribute in prim.GetAttributes():
                    if attribute.GetTypeName() in (Sdf.ValueTypeNames.Asset, Sdf.ValueTypeNames.String):
                        continue
                    for frame in (1, 2):
                        value = attribute.Get(Usd.TimeCode(frame))
                        yield f"USD {form} {attribute.GetPath()} at {frame}", np.array(value)


def of_node_groups(package: ModuleType, _data: dict[str, Any]) -> Iterator[Made]:
    """Yield each node group as text; nothing where there is no Blender in this Python."""
    try:
        import bpy
    except ImportError:
        return
    from tests.blender.node_tree_text import tree_text

    versioned = part(package, "nodes.versioned")
    bpy.ops.wm.read_homefile(use_empty=True)
    for path in sorted(Path(package.__path__[0], "nodes").glob("*.py")):
        module = part(package, f"nodes.{path.stem}") if path.stem != "__init__" else None
        for value in vars(module).values() if module else ():
            if isinstance(value, versioned.GroupKind):
                versioned.node_group(value)
    for patches in (1, 2):
        versioned.node_group(part(package, "nodes.ocean").ocean_group(patches))
    for tree in bpy.data.node_groups:
        yield f"{_GROUP} {tree.name}", f"{tree.get('ocean_tweak_group')}\n{tree_text(tree)}"
    bpy.ops.wm.read_homefile(use_empty=True)


def difference(label: str, before: Any, after: Any) -> str:
    """Say how two values differ; "" where they are the same to the bit."""
    if before is None or after is None:
        return f"{label} is {'new' if before is None else 'gone'}"
    if label.startswith(_GROUP) and before.partition("\n")[0] != after.partition("\n")[0]:
        return ""  # of another version on purpose; tests/blender/snapshots has what it is now
    if not isinstance(before, np.ndarray) or before.dtype == object:
        return "" if str(before) == str(after) else f"{label}: {_first_difference(str(before), str(after))}"
    if before.shape != after.shape or before.dtype != after.dtype:
        return f"{label} is {after.dtype} {after.shape}, was {before.dtype} {before.shape}"
    if before.tobytes() == after.tobytes():
        return ""
    most = np.abs(after.astype(float) - before.astype(float)).max(initial=0.0)
    return f"{label} by up to {most:.3g}"


def _first_difference(before: str, after: str) -> str:
    place = next(
        (index for index, pair in enumerate(zip(before, after, strict=False)) if pair[0] != pair[1]),
        min(len(before), len(after)),
    )
    start = max(place - 30, 0)
    return f"…{before[start : place + 40]!r} is …{after[start : place + 40]!r} now"
