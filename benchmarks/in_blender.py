# SPDX-License-Identifier: GPL-3.0-or-later
"""Script for Blender: the built-in Ocean modifier against our live oceans, from frame to evaluated mesh.

blender --background --factory-startup --python benchmarks/in_blender.py --
        --sizes 256 512 1024 --latency 512 --rounds 9 --place LABEL [--bake-horizon] --out FILE.json
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks import horizon, playback
from benchmarks.measure import Timings, interleaved
from benchmarks.plan import sea
from benchmarks.rows import Row, ratio_row
from ocean_tweak import registration
from ocean_tweak.export.exr import ExrError, load_openexr
from ocean_tweak.scene import ocean_object
from ocean_tweak.scene.grid_mesh import Grid, fill
from ocean_tweak.scene.refresh import Wanted, refresh
from ocean_tweak.scene.settings import METHODS

#: of an ocean's settings, all of them on by default
SWITCHES = ("use_foam", "use_normals", "use_velocity")

WITH_ALL = "live, nodes, with foam, normals and velocity"

#: frames one after the other that are timed together: foam looks at the sea in some of them only
_PLAYED = 6

#: of seas: those that are alike share surfaces and foam, and would throw each other back in time
_seeds = itertools.count(1)

Contender = tuple[bpy.types.Scene, bpy.types.Object]


def main() -> None:
    """Measure, and write the rows as JSON."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    registration.register()
    bpy.ops.wm.read_homefile(use_empty=True)
    rows = [row for size in arguments.sizes for row in frame_rows(size, arguments)]
    rows += latency_rows(arguments.latency, arguments)
    rows += horizon.rows(live(512, "NODES"), arguments.rounds, f"Blender, {arguments.place}")
    rows += baked_rows(arguments)
    remove_scenes()
    report = {
        "blender": bpy.app.version_string,
        "python": sys.version.split()[0],
        "numpy": np.__version__,
        "rows": [row.to_dict() for row in rows],
    }
    arguments.out.write_text(json.dumps(report), encoding="utf-8")
    registration.unregister()  # while Blender is still whole


def baked_rows(arguments: argparse.Namespace) -> Iterator[Row]:
    """What plays a bake; none where Python has no OpenEXR: a Blender in which no zip is installed."""
    try:
        load_openexr()
    except ExrError as error:
        print(f"no baked rows: {error}", flush=True)
        return
    where = f"Blender, {arguments.place}"
    yield from playback.rows(
        lambda samples: live(samples, "NODES"), sea(arguments.latency), arguments.rounds, where
    )
    if arguments.bake_horizon:
        yield playback.horizon_row(arguments.rounds, where)


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = argparse.ArgumentParser(prog="in_blender.py")
    parser.add_argument("--sizes", type=int, nargs="+", required=True, help="samples along each side")
    parser.add_argument("--latency", type=int, required=True, help="samples where a parameter is changed")
    parser.add_argument("--rounds", type=int, required=True)
    parser.add_argument("--place", required=True, help="which Blender this is")
    parser.add_argument("--judge", type=int, default=1024, help="the size that the targets speak of")
    parser.add_argument("--bake-horizon", action="store_true", help="bake To the Horizon: some minutes")
    parser.add_argument("--out", type=Path, required=True)
    return parser.parse_args(argv)


def modifier_resolution(samples: int) -> int:
    """The Ocean modifier's setting r makes r² samples a side: the largest that makes no more than ours."""
    return int(samples**0.5)


def frame_rows(samples: int, arguments: argparse.Namespace) -> Iterator[Row]:
    """Frame change → evaluated mesh."""
    modifiers = {
        "Generate": built_in(samples, "GENERATE"),
        "Generate with foam": built_in(samples, "GENERATE", foam=True),
        "Displace": built_in(samples, "DISPLACE"),
        "Displace with foam": built_in(samples, "DISPLACE", foam=True),
    }
    ours = {f"live, {method.lower()}": live(samples, method) for method in METHODS}
    foaming = {
        "live, nodes, with foam": live(samples, "NODES", "use_foam"),
        WITH_ALL: live(samples, "NODES", *SWITCHES),
    }
    sides = {name: to_mesh(contender) for name, contender in {**modifiers, **ours, **foaming}.items()}
    timings = interleaved(sides, arguments.rounds)
    remove_scenes()
    side = modifier_resolution(samples) ** 2
    remark = f"seconds for {_PLAYED} frames"
    if samples == arguments.latency:
        yield ratio_row(
            f"Blender, {arguments.place}", f"frame → mesh, {samples}², {WITH_ALL} against live, nodes",
            timings, WITH_ALL, "live, nodes", target="maps", remark=remark,
        )  # fmt: skip
    remark += "" if side == samples else f"; the modifier makes {side}²"
    for mine, theirs in itertools.product(ours, ("Generate", "Displace")):
        judged = samples == arguments.judge and mine == "live, nodes" and theirs == "Generate"
        yield compare(arguments, samples, timings, mine, theirs, remark, "Blender" if judged else None)
    for mine, theirs in itertools.product(foaming, ("Generate with foam", "Displace with foam")):
        judged = samples == arguments.judge and theirs.startswith("Generate")
        target = "Blender, all maps" if mine == WITH_ALL else "Blender, foam"
        yield compare(arguments, samples, timings, mine, theirs, remark, target if judged else None)


def compare(
    arguments: argparse.Namespace,
    samples: int,
    timings: Timings,
    mine: str,
    theirs: str,
    remark: str,
    target: str | None,
) -> Row:
    """One way of ours against one of the modifier's."""
    name = f"frame → mesh, {samples}², {mine} against Ocean modifier {theirs}"
    return ratio_row(
        f"Blender, {arguments.place}", name, timings, mine, theirs, faster=True, target=target, remark=remark
    )


def latency_rows(samples: int, arguments: argparse.Namespace) -> Iterator[Row]:
    """Wind speed set → evaluated mesh."""
    winds = (10.0 + 1e-2 * step for step in itertools.count())
    scene, item = built_in(samples, "GENERATE")
    modifier = item.modifiers["Ocean"]

    def change_modifier() -> None:
        modifier.wind_velocity = next(winds)
        mesh_of(scene, item)

    nodes, displace = live(samples, "NODES"), live(samples, "DISPLACE")
    whole = live(samples, "NODES", *SWITCHES)
    sides = {
        "Generate": change_modifier,
        "live, nodes, all at once": wind_changer(nodes, winds),
        "live, displace, all at once": wind_changer(displace, winds),
        "live, nodes, all maps, what a window shows first": wind_changer(whole, winds, coarse=True),
        "live, nodes, all maps, what a window shows next": wind_changer(whole, winds, coarse=False),
    }
    timings = interleaved(sides, arguments.rounds)
    remove_scenes()
    for name in list(sides)[1:]:
        row = f"wind → mesh, {samples}², {name} against Ocean modifier Generate"
        yield ratio_row(f"Blender, {arguments.place}", row, timings, name, "Generate", faster=True)


def wind_changer(
    contender: Contender, winds: Iterator[float], coarse: bool | None = None
) -> Callable[[], None]:
    """Changes the wind and asks for the mesh.

    coarse : as in a window, which shows few samples first, then all of them, and leaves the statistics and
        the history of the foam to a thread; None does everything at once, as without a window
    """
    scene, item = contender
    settings = item.ocean_tweak

    def run() -> None:
        if coarse is None:
            settings.layers[0].wind_speed = next(winds)
        else:
            with settings.quiet():
                settings.layers[0].wind_speed = next(winds)
            refresh(item, scene, Wanted.SURFACE if coarse else Wanted.SURFACE | Wanted.SAMPLES)
        mesh_of(scene, item)
        if settings.error:
            raise RuntimeError(settings.error)

    return run


def to_mesh(contender: Contender) -> Callable[[], None]:
    """Plays some frames and asks for the mesh of each; raises RuntimeError when it does not move."""
    scene, item = contender
    seen: list[tuple[float, ...]] = [()]
    frames = itertools.count(1)

    def run() -> None:
        for frame in itertools.islice(frames, _PLAYED):
            scene.frame_set(frame)
            place = tuple(mesh_of(scene, item).vertices[1].co)
            if place == seen[0]:
                raise RuntimeError(f"{scene.name}: the sea stands still")
            seen[0] = place

    return run


def mesh_of(scene: bpy.types.Scene, item: bpy.types.Object) -> bpy.types.Mesh:
    """The evaluated mesh."""
    layer = scene.view_layers[0]
    layer.update()
    return item.evaluated_get(layer.depsgraph).data


def new_scene(name: str) -> bpy.types.Scene:
    """A scene of its own for each contender, so that no frame change moves another."""
    scene = bpy.data.scenes.new(name)
    scene.render.fps = 24
    return scene


def remove_scenes() -> None:
    """Take the contenders away, and their oceans with them."""
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    for scene in list(bpy.data.scenes)[1:]:
        bpy.data.scenes.remove(scene)
    bpy.data.orphans_purge()


def built_in(samples: int, geometry: str, foam: bool = False) -> Contender:
    """Blender's own ocean, its time driven by the frame; to displace, a grid as fine as ours."""
    scene = new_scene(f"Ocean modifier {geometry} {foam}")
    mesh = bpy.data.meshes.new("grid")
    if geometry == "DISPLACE":
        fill(mesh, Grid(2000.0, samples, samples))
    else:
        mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    item = bpy.data.objects.new("modifier", mesh)
    scene.collection.objects.link(item)
    modifier = item.modifiers.new("Ocean", "OCEAN")
    modifier.geometry_mode = geometry
    modifier.viewport_resolution = modifier.resolution = modifier_resolution(samples)
    modifier.spatial_size = 2000
    modifier.wind_velocity = 25.0
    modifier.use_foam = foam
    modifier.foam_layer_name = "foam" if foam else ""
    driver = item.driver_add('modifiers["Ocean"].time').driver
    driver.expression = "frame / 24"
    made, wanted = len(mesh_of(scene, item).vertices), samples + 1
    if geometry == "GENERATE":
        wanted = modifier_resolution(samples) ** 2 + 1
    if made != wanted**2:
        raise RuntimeError(f"the Ocean modifier has {made} vertices and not {wanted}²")
    return scene, item


def live(samples: int, method: str, *switches: str) -> Contender:
    """Our ocean with these of SWITCHES on; without any it makes what the modifier makes, displacement.

    Each has a sea of its own.
    """
    scene = new_scene(f"live {method}")
    item = ocean_object.add(scene, sea(samples).replace(seed=next(_seeds)), method, "LIVE")
    with item.ocean_tweak.quiet():
        for name in SWITCHES:
            setattr(item.ocean_tweak, name, name in switches)
    refresh(item, scene)
    made = len(mesh_of(scene, item).vertices)
    if made != (samples + 1) ** 2:
        raise RuntimeError(f"our ocean has {made} vertices and not {samples + 1}²")
    return scene, item


if __name__ == "__main__":
    main()
