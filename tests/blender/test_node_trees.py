# SPDX-License-Identifier: GPL-3.0-or-later
"""The node groups are what they were, for each Blender, or the change is meant.

After a meant change, raise the version of the group's kind and write the snapshots anew, with each Blender:

    RENEW_SNAPSHOTS=1 .tools/python-5.2/bin/python -m pytest tests/blender/test_node_trees.py
    RENEW_SNAPSHOTS=1 .tools/python-4.5/bin/python -m pytest tests/blender/test_node_trees.py
"""

import os
from pathlib import Path

import bpy
import pytest

from .node_tree_text import tree_text

SNAPSHOTS = Path(__file__).parent / "snapshots"
BLENDER = f"{bpy.app.version[0]}.{bpy.app.version[1]}"
KINDS = {
    "ocean": ("nodes.ocean", lambda module: module.ocean_group(1)),
    "ocean-2-patches": ("nodes.ocean", lambda module: module.ocean_group(2)),
    "patch": ("nodes.patch", lambda module: module.PATCH),
    "patch-points": ("nodes.patch_points", lambda module: module.PATCH_POINTS),
    "absence": ("nodes.extension_check", lambda module: module.ABSENCE),
    "frame": ("nodes.shown_frame", lambda module: module.SHOWN_FRAME),
    "frame-warnings": ("nodes.frame_warnings", lambda module: module.WARNINGS),
    "grid": ("nodes.grid", lambda module: module.GRID),
    "camera-grid": ("nodes.camera_grid", lambda module: module.CAMERA_GRID),
    "next-averages": ("nodes.averages", lambda module: module.NEXT_AVERAGES),
    "averages": ("nodes.averages", lambda module: module.AVERAGES),
    "averaged": ("nodes.averaged", lambda module: module.AVERAGED),
    "camera-patch": ("nodes.camera_patch", lambda module: module.CAMERA_PATCH),
    "camera-sum": ("nodes.camera_sum", lambda module: module.CAMERA_SUM),
    "foam-facts": ("nodes.camera_foam", lambda module: module.RING_FACTS),
    "foam-ring": ("nodes.camera_foam", lambda module: module.RING),
    "camera-foam": ("nodes.camera_foam", lambda module: module.CAMERA_FOAM),
    "camera-fan": ("nodes.camera_foam", lambda module: module.CAMERA_FAN),
    "foam-pile": ("nodes.foam_pile", lambda module: module.FOAM_PILE),
    "camera-surface": ("nodes.camera_surface", lambda module: module.CAMERA_SURFACE),
    "coast": ("nodes.coast", lambda module: module.COAST),
    "wet-bed": ("nodes.wet_bed", lambda module: module.WET_BED),
    "area": ("nodes.held", lambda module: module.AREA),
    "wake-points": ("nodes.wake_points", lambda module: module.WAKE_POINTS),
    "dry": ("nodes.held", lambda module: module.DRY),
    "no-bows": ("nodes.held", lambda module: module.NO_BOWS),
    "driftless": ("nodes.held", lambda module: module.DRIFTLESS),
    "grid-facts": ("nodes.rest_grid", lambda module: module.GRID_FACTS),
    "cell": ("nodes.rest_grid", lambda module: module.CELL),
    "over-bed": ("nodes.over_bed", lambda module: module.OVER_BED),
    "bed-points": ("nodes.over_bed", lambda module: module.BED_POINTS),
    "surface": ("nodes.surface", lambda module: module.SURFACE),
    "sample": ("nodes.sample", lambda module: module.SAMPLE),
    "stencil": ("nodes.floating", lambda module: module.STENCIL),
    "ride": ("nodes.floating", lambda module: module.RIDE),
    "float": ("nodes.floating", lambda module: module.FLOAT),
    "carrier": ("nodes.floating", lambda module: module.CARRIER),
    "horizon": ("nodes.horizon", lambda module: module.HORIZON),
    "spray": ("nodes.spray", lambda module: module.SPRAY),
    "spray-look": ("nodes.spray_look", lambda module: module.SPRAY_LOOK),
    "solid-foam": ("nodes.solid_foam", lambda module: module.SOLID_FOAM),
    "ripples": ("nodes.water_pattern", lambda module: module.RIPPLES),
    "lace": ("nodes.water_pattern", lambda module: module.LACE),
    "billows": ("nodes.water_pattern", lambda module: module.BILLOWS),
    "water": ("nodes.water", lambda module: module.WATER),
    "contact": ("nodes.contact", lambda module: module.CONTACT),
    "wet-band": ("nodes.contact", lambda module: module.WET_BAND),
    "collar": ("nodes.contact", lambda module: module.COLLAR),
    "ripple-normal": ("nodes.contact", lambda module: module.RIPPLE_NORMAL),
    "hull-place": ("nodes.hull_cut", lambda module: module.HULL_PLACE),
    "hull-cut": ("nodes.hull_cut", lambda module: module.HULL_CUT),
}


@pytest.fixture
def built(extension, empty_scene):
    """Build a group by its name in KINDS; returns its kind and the tree."""

    def build(name):
        module, choose = KINDS[name]
        kind = choose(extension(module))
        return kind, extension("nodes.versioned").node_group(kind)

    return build


@pytest.mark.parametrize("name", KINDS)
def test_as_the_snapshot(built, name):
    kind, tree = built(name)
    text = f"version {kind.version}\n{tree_text(tree)}"
    file = SNAPSHOTS / f"{name}-{BLENDER}.txt"
    if os.environ.get("RENEW_SNAPSHOTS"):
        file.write_text(text, encoding="utf-8")
    assert text == file.read_text(encoding="utf-8"), f"{file.name} differs: see the top of {__file__}"


@pytest.mark.parametrize("name", KINDS)
def test_every_link_is_valid(built, name):
    _, tree = built(name)
    assert all(link.is_valid for link in tree.links)


# a shader's nodes that nothing reads are no work: Blender leaves them out
@pytest.mark.parametrize("name", [name for name in KINDS if name != "water"])
def test_every_node_is_used(built, name):
    _, tree = built(name)
    read = {link.from_node for link in tree.links}
    assert [node.name for node in tree.nodes if node not in read] == ["Group Output"]


@pytest.mark.parametrize("name", KINDS)
def test_a_group_is_built_once(built, name):
    assert built(name)[1] == built(name)[1]


@pytest.mark.parametrize("patches", [0, 9])
def test_too_many_patches_are_refused(extension, patches):
    with pytest.raises(ValueError, match=f"patches = {patches}: must be from 1 to 8"):
        extension("nodes.ocean").ocean_group(patches)
