# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever an artist types, the ocean is shown or says why not, and no exception comes."""

import random

import bpy
import numpy as np
import pytest

#: what would only cost time: these are tried with small values
LARGEST = {"resolution": 48, "viewport_resolution": 48, "mesh_resolution": 40, "repeats_x": 3, "repeats_y": 3}
LEFT_OUT = {"rna_type", "name", "is_ocean", "is_quiet", "source", "use_foam", "exact"}


def editable(group):
    """The properties of a group that a panel may show."""
    return [
        prop for prop in group.bl_rna.properties
        if prop.identifier not in LEFT_OUT and not prop.is_hidden and not prop.is_readonly
        and prop.type in ("FLOAT", "INT", "BOOLEAN", "ENUM")
    ]  # fmt: skip


def some_value(chance, prop):
    if prop.type == "BOOLEAN":
        return chance.random() < 0.5
    if prop.type == "ENUM":
        return chance.choice(prop.enum_items.keys())
    low, high = prop.hard_min, min(prop.hard_max, LARGEST.get(prop.identifier, prop.hard_max))
    if prop.type == "INT":
        return chance.choice((low, high, chance.randint(low, high)))
    near = 10.0 ** chance.uniform(-3.0, 5.0)
    return chance.choice((low, min(high, 1e6), min(max(near, low), high), prop.default))


@pytest.fixture
def ocean(ocean_object, make_parameters, empty_scene):
    item = ocean_object.add(empty_scene, make_parameters())
    bpy.context.view_layer.objects.active = item
    item.ocean_tweak.use_foam = False  # it looks back over many surfaces, whatever is edited
    bpy.ops.ocean.layer_add()
    return item


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of seas that no float32 can hold
@pytest.mark.parametrize(("patches", "edits"), [(0, 300), (3, 150)])
def test_random_edits_leave_no_exception(ocean, empty_scene, extension, patches, edits):
    chance = random.Random(2)
    settings = ocean.ocean_tweak
    while len(settings.patches) < patches:
        bpy.ops.ocean.patch_add()
        settings.patches[-1].resolution = 32
    groups = [settings, settings.water, settings.foam, settings.timing, *settings.layers, *settings.patches]
    told = shown = 0
    for number in range(edits):
        group = chance.choice(groups)
        prop = chance.choice(editable(group))
        setattr(group, prop.identifier, some_value(chance, prop))
        if number % 10 == 0:
            empty_scene.frame_set(chance.randint(-50, 5000))
        if settings.error:
            told += 1
            assert len(settings.error) > 10
            # a remedy is at hand: the default is a sea, and so are fewer samples
            setattr(group, prop.identifier, LARGEST.get(prop.identifier, prop.default))
        else:
            shown += 1
            mesh = ocean.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
            places = np.empty(3 * len(mesh.vertices), np.float32)
            mesh.vertices.foreach_get("co", places)
            assert np.all(np.isfinite(places)), (prop.identifier, number)
    assert shown > edits // 3
    assert told > 3
    settings.from_parameters(extension("core").OceanParameters(resolution=32), empty_scene)
    assert not settings.error
