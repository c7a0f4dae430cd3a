# SPDX-License-Identifier: GPL-3.0-or-later
"""Fresh foam lies on breaking crests, thrown forward, and nowhere else."""

import bpy
import numpy as np
import pytest

SIDE, HEIGHT = 40, 0.1
CREST, SPEED = 3.0, (0.0, -2.0, 0.0)  # m, m/s


@pytest.fixture
def offsets(extension, empty_scene):
    """The offset of foam on a level square of SIDE² vertices, 1 m apart."""
    building, fields = extension("nodes.building"), extension("nodes.fields")
    tree = bpy.data.node_groups.new("Pile Test", "GeometryNodeTree")
    build = building.Builder(tree, (building.Plug("Breaking", "NodeSocketFloat", 0.0, ""),))
    inputs = {"Velocity": SPEED, "Breaking": build.given("Breaking"), "Height": HEIGHT, "Lump": 4.0}
    inputs["Displacement"] = fields.combined(build, 0.0, 0.0, CREST)
    pile = build.group(
        extension("nodes.versioned").node_group(extension("nodes.foam_pile").FOAM_PILE), inputs
    )
    build.finish(
        build.store(build.given("Geometry"), "offset", building.output(pile, "Offset"), "FLOAT_VECTOR")
    )
    mesh = bpy.data.meshes.new("Square")
    mesh.from_pydata([(x, y, 0.0) for y in range(SIDE) for x in range(SIDE)], [], [])
    item = bpy.data.objects.new("Square", mesh)
    empty_scene.collection.objects.link(item)
    modifier = item.modifiers.new("Pile", "NODES")
    modifier.node_group = tree

    def at(breaking):
        extension("nodes.modifier_inputs").set_inputs(modifier, {"Breaking": breaking})
        item.update_tag()
        bpy.context.view_layer.update()
        shown = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        values = np.empty(3 * SIDE**2, np.float32)
        shown.attributes["offset"].data.foreach_get("vector", values)
        return values.reshape(-1, 3)

    return at


def test_it_is_as_high_as_asked_in_the_mean_and_uneven(offsets):
    up = offsets(1.0)[:, 2]
    assert up.mean() == pytest.approx(HEIGHT * CREST, rel=0.15)
    assert 0.0 <= up.min() <= up.max() < 2.0 * HEIGHT * CREST  # lumps, no spikes
    assert up.std() > 0.2 * up.mean()


def test_it_hangs_forward_with_the_water_s_motion(offsets):
    x, y, up = offsets(1.0).T
    np.testing.assert_allclose(x, 0.0, atol=1e-6)
    assert np.all(y <= 0.0)
    assert np.corrcoef(y, up)[0, 1] < -0.99


def test_where_nothing_breaks_the_water_is_untouched(offsets):
    assert np.abs(offsets(0.0)).max() == 0.0
    assert 0.0 < offsets(0.1).max() < offsets(1.0).max()
