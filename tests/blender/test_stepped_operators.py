# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work a step at a time: given up at any step it leaves nothing; all steps are what one press makes."""

import threading

import bpy
import numpy as np
import pytest

from .test_sea_operators import blenders_ocean  # noqa: F401 - a fixture


@pytest.fixture
def painted(empty_scene):
    """A square over the domain with weights that grow along x."""
    bpy.ops.mesh.primitive_grid_add(
        x_subdivisions=8, y_subdivisions=8, size=200.0, location=(75.0, 75.0, 0.0)
    )
    item = bpy.context.object
    group = item.vertex_groups.new(name="Harbour")
    for vertex in item.data.vertices:
        group.add([vertex.index], (vertex.co.x + 100.0) / 200.0, "REPLACE")
    bpy.context.view_layer.update()
    return item


def counts():
    """How many datablocks of each kind there are."""
    kinds = ("objects", "meshes", "images", "materials", "actions", "textures", "node_groups")
    return {kind: len(getattr(bpy.data, kind)) for kind in kinds}


def given_up_after(work, steps):
    for _ in range(steps):
        if work.done < work.steps:
            work.advance()
    work.cancel()


@pytest.mark.parametrize("steps", [0, 1, 2, 3])
def test_weights_that_are_given_up_leave_nothing(ocean, painted, extension, empty_scene, steps):
    before = counts(), ocean.ocean_tweak.to_parameters(empty_scene)
    reading = extension("scene.vertex_weights").WeightsReading(ocean, painted, "Harbour", empty_scene, 512)
    assert reading.steps > 10
    given_up_after(reading, steps)
    assert (counts(), ocean.ocean_tweak.to_parameters(empty_scene)) == before


def test_weights_a_step_at_a_time_are_those_of_the_mesh(ocean, painted, extension, empty_scene):
    """Linear in x on the mesh, so they are on the domain: 1/8 at its left edge, 7/8 at its right one."""
    module = extension("scene.vertex_weights")
    reading = module.WeightsReading(ocean, painted, "Harbour", empty_scene, 96)
    done = []
    while reading.done < reading.steps:
        reading.advance()
        done.append(reading.done)
    assert done == list(range(1, reading.steps + 1))
    x = (np.arange(96) + 0.5) / 96
    expected = np.broadcast_to(0.125 + 0.75 * x, (96, 96))
    np.testing.assert_allclose(reading.finish().values[..., 0], expected, atol=1e-5)


@pytest.mark.parametrize("steps", [0, 1, 100])
def test_a_conversion_that_is_given_up_leaves_nothing(blenders_ocean, extension, empty_scene, steps):  # noqa: F811
    before = counts()
    conversion = extension("scene.conversion")
    work = conversion.Converting(blenders_ocean, blenders_ocean.modifiers[0], empty_scene)
    given_up_after(work, steps)
    assert counts() == before
    assert blenders_ocean.name == "Old Sea"
    assert not blenders_ocean.hide_get()


def test_waves_of_a_conversion_are_made_once(blenders_ocean, extension, empty_scene):  # noqa: F811
    """Those that were made while Esc was heard are those that the ocean shows."""
    evaluation, plans = extension("scene.evaluation"), extension("scene.plan")
    modifier = blenders_ocean.modifiers[0]
    work = extension("scene.conversion").Converting(blenders_ocean, modifier, empty_scene)
    while work.done < work.steps:
        work.advance()
    wanted = extension("scene.conversion").convert(blenders_ocean, modifier, empty_scene)
    assert wanted.viewport_resolution < wanted.parameters.resolution
    sea = plans.new_viewport_sea(wanted.parameters, wanted.viewport_resolution)
    kept = evaluation.surfaces_of(sea)
    made = work.finish()
    plan = plans.plan_for(made.ocean, made.ocean.ocean_tweak, empty_scene)
    assert evaluation.surfaces_of(plan.viewport_sea()) is kept


class Timer:
    """An event of a window."""

    def __init__(self, kind):
        self.type, self.value = kind, "PRESS"


class LoggedWork:
    """Work of three steps, of which the second raises what the operator says."""

    steps, done = 3, 0

    def __init__(self, operator):
        self._operator = operator

    def advance(self):
        self.done += 1
        if self._operator.fails is not None and self.done == 2:
            raise self._operator.fails
        self._operator.log.append(self.done)

    def finish(self):
        self._operator.log.append("finished")
        return "result"

    def cancel(self):
        self._operator.log.append("cancelled")

    def abandon(self):
        self._operator.log.append("abandoned")


@pytest.fixture
def stepped(extension, monkeypatch):
    """An operator whose steps are longer than a turn, with the list of what happens to it."""
    module = extension("ui.stepped_operator")
    monkeypatch.setattr(module, "_TURN", -1.0)

    class Operator(module.SteppedOperator):
        def begin(self, _context):
            return LoggedWork(self)

        def conclude(self, _context, result):
            self.log.append(result)
            return {"FINISHED"}

        def report(self, *told):
            self.log.append(told[0])

        def _tell(self, _context):
            pass

        def _clean_up(self, _context):
            self.log.append("cleaned")

    operator = Operator()
    operator.log, operator.fails = [], None
    operator._work = operator.begin(None)
    return operator


@pytest.mark.parametrize("presses", [0, 2])
def test_esc_is_heard_between_steps(stepped, presses):
    """Of an operator that takes one step an event, as long as each takes longer than a turn."""
    for _ in range(presses):
        assert stepped.modal(bpy.context, Timer("TIMER")) == {"RUNNING_MODAL"}
    assert stepped.modal(bpy.context, Timer("MOUSEMOVE")) == {"RUNNING_MODAL"}
    assert stepped.modal(bpy.context, Timer("ESC")) == {"CANCELLED"}
    assert stepped.log == [*range(1, presses + 1), "cancelled", "cleaned", {"WARNING"}]


def test_after_the_last_step_the_window_is_as_before(stepped):
    results = [stepped.modal(bpy.context, Timer("TIMER")) for _ in range(4)]
    assert results == [*[{"RUNNING_MODAL"}] * 3, {"FINISHED"}]
    assert stepped.log == [1, 2, 3, "finished", "result", "cleaned"]


def test_an_error_that_is_expected_is_told(stepped):
    stepped.fails = OSError("the disk is full")
    stepped.modal(bpy.context, Timer("TIMER"))
    assert stepped.modal(bpy.context, Timer("TIMER")) == {"CANCELLED"}
    assert stepped.log == [1, "cancelled", {"ERROR"}, "cleaned"]


def test_an_error_that_nobody_expects_leaves_nothing_in_the_window(stepped):
    """Neither timer nor progress nor status: and it is still seen."""
    stepped.fails = ZeroDivisionError("a bug")
    stepped.modal(bpy.context, Timer("TIMER"))
    with pytest.raises(ZeroDivisionError):
        stepped.modal(bpy.context, Timer("TIMER"))
    assert stepped.log == [1, "cancelled", "cleaned"]


def test_when_blender_ends_it_no_data_are_touched(stepped):
    stepped.modal(bpy.context, Timer("TIMER"))
    stepped.cancel(bpy.context)
    assert stepped.log == [1, "abandoned", "cleaned"]


def test_a_conversion_that_is_abandoned_ends_its_thread(blenders_ocean, extension, empty_scene):  # noqa: F811
    modifier = blenders_ocean.modifiers[0]
    work = extension("scene.conversion").Converting(blenders_ocean, modifier, empty_scene)
    threads = [each for each in threading.enumerate() if each.name.startswith("Ocean Tweak")]
    assert threads
    bpy.data.objects.remove(blenders_ocean)  # as when another file is opened
    work.abandon()
    for thread in threads:
        thread.join(timeout=60.0)
    assert not any(thread.is_alive() for thread in threads)


def steps_of_reading(extension, ocean, painted):
    """Reading weights into a mask of the active layer, begun: the operator's own methods, and its work."""
    bpy.context.view_layer.objects.active = ocean
    bpy.ops.ocean.layer_add(kind="WAVES")
    ocean.ocean_tweak.active_layer = 0
    mask = ocean.ocean_tweak.layers[0].group.mask
    mask.mesh, mask.vertex_group = painted, "Harbour"
    told = []
    operator = reading_operator(extension, told)
    work = operator.begin(bpy.context)
    while work.done < work.steps:
        work.advance()
    return operator, work, told


def reading_operator(extension, told):
    """Read Weights without Blender's part of it, which cannot be made by hand."""
    class_of_it = extension("ui.mask_operators").OCEAN_OT_read_weights
    names = ("begin", "conclude", "_mask", "_same_mask")
    own = {name: vars(class_of_it)[name] for name in names}
    return type(
        "Reading", (), {**own, "patch": -1, "samples": 16, "report": lambda _, *said: told.append(said)}
    )()


def test_weights_are_for_the_mask_that_was_asked(ocean, painted, extension):
    """Whichever layer is active when they are read."""
    operator, work, told = steps_of_reading(extension, ocean, painted)
    first, second = ocean.ocean_tweak.layers
    ocean.ocean_tweak.active_layer = 1
    assert operator.conclude(bpy.context, work.finish()) == {"FINISHED"}
    assert told[0][0] == {"INFO"}
    assert first.group.mask.image is not None
    assert second.group.mask.source == "NONE"
    assert second.group.mask.image is None


@pytest.mark.parametrize("change", ["removed", "another mesh"])
def test_weights_of_a_mask_that_is_gone_are_refused(ocean, painted, extension, change):
    operator, work, told = steps_of_reading(extension, ocean, painted)
    if change == "removed":
        bpy.ops.ocean.layer_remove()
    else:
        ocean.ocean_tweak.layers[0].group.mask.vertex_group = "Coast"
    assert operator.conclude(bpy.context, work.finish()) == {"CANCELLED"}
    assert told[0][0] == {"ERROR"}
    assert "removed or changed" in told[0][1]
    assert all(layer.group.mask.image is None for layer in ocean.ocean_tweak.layers)


def test_without_a_window_a_press_does_all_of_it(ocean, painted):
    mask = ocean.ocean_tweak.mask
    mask.mesh, mask.vertex_group = painted, "Harbour"
    bpy.context.view_layer.objects.active = ocean
    assert bpy.ops.ocean.read_weights("INVOKE_DEFAULT", patch=-2, samples=16) == {"FINISHED"}
    assert mask.source == "VERTEX_GROUP"
    assert mask.image is not None
    mask.mesh = None
    with pytest.raises(RuntimeError, match="Choose a mesh"):
        bpy.ops.ocean.read_weights("INVOKE_DEFAULT", patch=-2)
