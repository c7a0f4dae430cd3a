# SPDX-License-Identifier: GPL-3.0-or-later
"""A file with node groups of another version gets the present ones, and keeps what was set on them."""

import dataclasses
import importlib
import pkgutil

import bpy
import pytest


@pytest.fixture
def inputs(extension):
    return extension("nodes.modifier_inputs")


@pytest.fixture
def versioned(extension):
    return extension("nodes.versioned")


@pytest.fixture
def old_kind(extension):
    """The ocean's group as another version had it: fewer inputs, in another order, and one that is gone."""
    kind, building = extension("nodes.ocean").ocean_group(1), extension("nodes.building")

    def build(tree):
        plugs = (
            ("Domain Size", "NodeSocketFloat", 1.0, ""),
            ("Gone", "NodeSocketInt", 3, ""),
            ("Move", "NodeSocketFloat", 1.0, ""),  # a number then, a switch now
            ("Displacement", "NodeSocketImage", None, ""),
            ("Resolution", "NodeSocketInt", 4, ""),
        )
        builder = building.Builder(tree, plugs)
        builder.finish(builder.given("Geometry"))

    return dataclasses.replace(kind, version=kind.version - 1, build=build)


@pytest.fixture
def open_again(tmp_path):
    def save_and_open():
        file = str(tmp_path / "old.blend")
        bpy.ops.wm.save_as_mainfile(filepath=file)
        bpy.ops.wm.read_homefile(use_empty=True)
        bpy.ops.wm.open_mainfile(filepath=file)

    return save_and_open


def test_a_modifier_gets_the_present_group_and_keeps_its_inputs(
    extension, inputs, versioned, old_kind, empty_scene, open_again
):
    item = bpy.data.objects.new("Plane", bpy.data.meshes.new("Plane"))
    empty_scene.collection.objects.link(item)
    modifier = item.modifiers.new("Waves", "NODES")
    modifier.node_group = versioned.node_group(old_kind)
    image = bpy.data.images.new("Waves", 4, 4)
    inputs.set_inputs(modifier, {"Domain Size": 77.0, "Gone": 9, "Displacement": image, "Resolution": 8})
    open_again()
    modifier = bpy.data.objects["Plane"].modifiers["Waves"]
    kind = extension("nodes.ocean").ocean_group(1)
    assert modifier.node_group == versioned.node_group(kind)
    found = inputs.all_inputs(modifier)
    assert found["Domain Size"] == 77.0
    assert found["Displacement"] == bpy.data.images["Waves"]
    assert found["Resolution"] == 8
    assert found["Move"] is True or found["Move"] == 1  # the default: its type has changed
    assert found["Repeats X"] == 1
    assert "Gone" not in found
    tags = [group.get("ocean_tweak_group") for group in bpy.data.node_groups]
    assert old_kind.tag not in tags


def test_an_ocean_s_own_modifier_too(
    extension, inputs, versioned, old_kind, ocean_object, make_parameters, expected, evaluated, empty_scene,
    open_again,
):  # fmt: skip
    item = ocean_object.add(empty_scene, make_parameters())
    group = item.modifiers[0].node_group
    group["ocean_tweak_group"] = old_kind.tag
    open_again()
    item = bpy.data.objects["Ocean"]
    assert [modifier.type for modifier in item.modifiers] == ["NODES"]
    assert item.modifiers[0].node_group["ocean_tweak_group"] != old_kind.tag
    assert abs(evaluated(item) - expected(make_parameters(), 1)).max() < 1e-4


def test_a_baked_ocean_s_modifier_learns_what_is_new(
    inputs, old_kind, ocean_object, make_parameters, bake, empty_scene, open_again
):
    """Nothing else renews the inputs of an ocean that files move."""
    parameters = make_parameters()
    item = ocean_object.add(empty_scene, parameters, "NODES", "SEQUENCE", bake(parameters, 1, 3))
    (modifier,) = item.modifiers
    inputs.set_input(modifier, "Seconds per File", 0.0)
    modifier.node_group["ocean_tweak_group"] = old_kind.tag
    open_again()
    item = bpy.data.objects["Ocean"]
    values = [inputs.get_input(modifier, "Seconds per File") for modifier in item.modifiers]
    assert values == [pytest.approx(1 / 24)]


def test_a_node_in_another_group_keeps_links_and_values(
    extension, versioned, old_kind, empty_scene, open_again
):
    mine = bpy.data.node_groups.new("Mine", "GeometryNodeTree")
    mine.use_fake_user = True
    builder = extension("nodes.building").Builder(mine, (("Side", "NodeSocketFloat", 5.0, ""),))
    node = builder.group(versioned.node_group(old_kind), {"Domain Size": builder.given("Side")})
    node.inputs["Resolution"].default_value = 64
    mine.links.new(builder.given("Geometry"), node.inputs["Geometry"])
    builder.finish(node.outputs["Geometry"])
    open_again()
    mine = bpy.data.node_groups["Mine"]
    node = next(node for node in mine.nodes if node.bl_idname == "GeometryNodeGroup")
    assert node.node_tree == versioned.node_group(extension("nodes.ocean").ocean_group(1))
    assert node.inputs["Resolution"].default_value == 64
    assert node.inputs["Domain Size"].links[0].from_socket.name == "Side"
    assert node.inputs["Geometry"].links[0].from_node.bl_idname == "NodeGroupInput"
    assert node.outputs["Geometry"].links[0].to_node.bl_idname == "NodeGroupOutput"
    assert node.inputs["Repeats X"].default_value == 1


def test_every_kind_is_renewed(extension, package):
    """A kind that is forgotten would stay at its old version in old files."""
    nodes = extension("nodes")
    kind_of_group = extension("nodes.versioned").GroupKind
    known = extension("nodes.kinds").ALL_KINDS
    names = [module.name for module in pkgutil.iter_modules(nodes.__path__)]
    modules = [importlib.import_module(f"{nodes.__name__}.{name}") for name in names]
    made = {
        value for module in modules for value in vars(module).values() if isinstance(value, kind_of_group)
    }
    assert len(made) > 10
    assert made <= set(known)
    assert {extension("nodes.ocean").ocean_group(count) for count in (1, 2, 8)} <= set(known)


def test_newer_groups_are_kept_and_told(extension, ocean_object, make_parameters, empty_scene, open_again):
    item = ocean_object.add(empty_scene, make_parameters())
    kind = extension("nodes.ocean").ocean_group(1)
    newer = f"{kind.name} {kind.version + 1}"
    item.modifiers[0].node_group["ocean_tweak_group"] = newer
    open_again()
    item = bpy.data.objects["Ocean"]
    assert item.modifiers[0].node_group["ocean_tweak_group"] == newer
    assert item.ocean_tweak.error == (
        f"node group {kind.name} = {kind.version + 1}: was written by a newer Ocean Tweak, and this one "
        f"reads up to {kind.version}: update the extension"
    )
