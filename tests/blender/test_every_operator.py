# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds for every operator: without an ocean it says what is missing, and one undo takes it back."""

import bpy
import pytest

#: those that need no ocean; what they do need is tested where they are
WITHOUT_OCEAN = {
    "mesh.ocean_tweak_add", "ocean.add_scene", "ocean.install_assets", "node.ocean_tweak_add_group",
    "ocean.convert", "ocean.delete_preset", "ocean.rename_preset", "ocean.import_preset",
    "ocean.export_preset", "ocean.import_measured", "ocean.import_usd", "ocean.stop_usd", "ocean.verify_usd",
    "object.ocean_tweak_float", "object.ocean_tweak_float_bake", "object.ocean_tweak_float_remove",
    "object.ocean_tweak_contact",
}  # fmt: skip


def operators():
    """Classes of the extension's operators by idname."""
    found = {}
    for kind in bpy.types.Operator.__subclasses__():
        if "ocean_tweak" in kind.__module__ and getattr(kind, "bl_idname", ""):
            found[kind.bl_idname] = kind
    return found


def call(idname):
    group, _, name = idname.partition(".")
    return getattr(getattr(bpy.ops, group), name)


def state():
    """What of the file these operators change."""
    scene = bpy.context.scene
    return {
        item.name: (
            item.ocean_tweak.to_parameters(scene), item.ocean_tweak.source, item.ocean_tweak.use_ocean_time,
            [material.name for material in item.data.materials], [each.type for each in item.modifiers],
            item.animation_data is not None and item.animation_data.action is not None,
        )
        for item in bpy.data.objects
        if item.type == "MESH" and item.ocean_tweak.is_ocean
    }  # fmt: skip


@pytest.fixture
def active(ocean_object, make_parameters, empty_scene):
    item = ocean_object.add(empty_scene, make_parameters())
    bpy.context.view_layer.objects.active = item
    bpy.ops.ocean.layer_add()
    return item


@pytest.fixture
def files(active, bake, make_parameters, tmp_path):
    """Files to read, by name."""
    parameters = tmp_path / "sea.json"
    parameters.write_text(make_parameters(seed=77, choppiness=0.3).to_json())
    return {"json": str(parameters), "sequence": str(bake(make_parameters(seed=3), 1, 3).path(1))}


#: operator → its arguments, and what must have happened before
STEPS = {
    "mesh.ocean_tweak_add": lambda files: {"method": "NODES"},
    "ocean.import_parameters": lambda files: {"filepath": files["json"]},
    "ocean.use_sequence": lambda files: {"filepath": files["sequence"]},
    "ocean.use_live": lambda files: bpy.ops.ocean.use_sequence(filepath=files["sequence"]) and {},
    "ocean.layer_add": lambda files: {},
    "ocean.layer_remove": lambda files: {},
    "ocean.layer_duplicate": lambda files: {},
    "ocean.layer_move": lambda files: {"direction": "UP"},
    "ocean.layer_solo": lambda files: {},
    "ocean.plan_patches": lambda files: {},
    "ocean.patch_add": lambda files: {},
    "ocean.patch_remove": lambda files: bpy.ops.ocean.patch_add() and {},
    "ocean.one_patch": lambda files: bpy.ops.ocean.patch_add() and {},
    "ocean.apply_preset": lambda files: {"key": "gale"},
    "ocean.match_sea_state": lambda files: {},
    "ocean.use_water_material": lambda files: {},
}


@pytest.mark.parametrize("idname", STEPS)
def test_one_undo_takes_it_back(files, window, empty_scene, idname):
    with window.override():
        arguments = STEPS[idname](files)
        before = state()
        bpy.ops.ed.undo_push(message="before")
        assert call(idname)(**arguments) == {"FINISHED"}
        bpy.ops.ed.undo_push(message="after")
        after = state()
        assert after != before
        bpy.ops.ed.undo()
        assert state() == before
        bpy.ops.ed.redo()
        assert state() == after


def test_without_an_ocean_they_say_so(empty_scene):
    found = operators()
    assert len(found) > 25
    assert found.keys() >= WITHOUT_OCEAN
    for idname in sorted(found.keys() - WITHOUT_OCEAN):
        assert not call(idname).poll(), idname
        with pytest.raises(RuntimeError, match=r"ocean|Nothing|bake"):
            call(idname)()


def test_what_changes_the_file_can_be_undone():
    # bakes, exports, presets and assets are files; undo is not theirs
    files_only = ("bake", "export", "preset", "install", "usd")
    for idname, kind in operators().items():
        if not any(word in idname for word in files_only):
            assert "UNDO" in kind.bl_options, idname


def test_they_can_be_read_in_menus():
    for idname, kind in operators().items():
        description = getattr(kind, "bl_description", "") or kind.__doc__
        assert kind.bl_label, idname
        assert len(description) > 10, idname
        assert not description.endswith("."), idname  # Blender adds it
