# SPDX-License-Identifier: GPL-3.0-or-later
"""Measured and forecast spectra from files: a new ocean of them, or a layer of the active one."""

import math
from pathlib import Path

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, CollectionProperty, EnumProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..core import OceanParameters, ParameterError, WaveLayer
from ..core.data.printable import printable
from ..export.spectra.reading import chosen_place, chosen_times, measured_layer, measured_sea, read_spectra
from ..export.spectra.records import Record, time_text
from ..scene import middle, ocean_object, water_material
from ..scene.settings import VIEWPORT_RESOLUTION, OceanObjectError, settings_of
from .active_ocean import refuse, shown_ocean
from .adding import InObjectMode, default_sea, make_active

_ERRORS = (ParameterError, OceanObjectError, OSError, *ocean_object.EXPECTED_ERRORS)


class OCEAN_OT_import_measured(InObjectMode, bpy.types.Operator, ImportHelper):
    """Read spectra that buoys measured or wave models made."""

    bl_idname = "ocean.import_measured"
    bl_description = (
        "Read spectra of NDBC's buoys (select all five files of a buoy, and its weather for the wind) or of "
        "the wave model SWAN"
    )
    bl_label = "Import Measured Sea"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(
        default="*.data_spec;*.swdir;*.swdir2;*.swr1;*.swr2;*.txt;*.gz;*.spec;*.spc;*.swn", options={"HIDDEN"}
    )
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    target: EnumProperty(
        name="As",
        items=[
            ("OCEAN", "New Ocean", "Add an ocean on a domain that has room for the waves"),
            ("LAYER", "Layer", "Add a layer to the active ocean"),
        ],
        options={"SKIP_SAVE"},
        description="What is made of the spectra",
    )
    time: StringProperty(
        name="Time (UTC)",
        description="Such as 2020-06-08T03:50; one to another with / between; all; empty for the latest",
    )
    place: StringProperty(
        name="Place", description="Which of several places in the file; empty for the first with energy"
    )
    tail: BoolProperty(
        name="Short Waves",
        default=True,
        description="Continue the spectrum beyond its highest frequency as f⁻⁵. Buoys measure no waves "
        "shorter than about 6 m, and without them the water looks too smooth",
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Read the files and make the sea, or change nothing."""
        try:
            records = read_spectra(self._paths())
            chosen = chosen_times(
                chosen_place(records, self.place.strip() or None), self.time.strip() or None
            )
            self._add(context, chosen)
        except _ERRORS as error:
            return refuse(self, error)
        self.report({"INFO"}, _told(chosen))
        return {"FINISHED"}

    def _paths(self) -> list[Path]:
        names = [each.name for each in self.files if each.name]
        return [Path(self.directory) / name for name in names] or [Path(self.filepath)]

    def _add(self, context: bpy.types.Context, chosen: Record) -> None:
        if self.target == "OCEAN":
            _add_ocean(context, measured_sea(chosen, self.tail))
            return
        item = shown_ocean(context)
        if item is None:
            raise OceanObjectError("There is no ocean for a layer: choose As New Ocean, or add one first")
        if item.library is not None or item.override_library is not None:
            raise OceanObjectError(f"{item.name} is of another file: make it local, or import a new ocean")
        settings = settings_of(item)
        before = settings.to_parameters(context.scene)
        own = [index for index, layer in enumerate(before.layers) if isinstance(layer, WaveLayer)]
        place = own[-1] + 1
        layers = (*before.layers[:place], measured_layer(chosen, self.tail), *before.layers[place:])
        settings.from_parameters(before.replace(layers=layers), context.scene)
        settings.active_layer = place


def _add_ocean(context: bpy.types.Context, sea: OceanParameters) -> None:
    """An ocean around the 3D cursor, as Add > Mesh > Ocean adds it."""
    scene = context.scene
    parameters = sea.replace(timing=default_sea(scene).timing)
    item = ocean_object.add(
        scene, parameters, collection=context.collection, viewport_resolution=VIEWPORT_RESOLUTION
    )
    water_material.assign(item, water_material.water_material())
    water_material.describe(item, parameters, scene)
    middle.put(item, scene.cursor.location)
    make_active(item, context.view_layer)


def _told(chosen: Record) -> str:
    """What was read, in a line."""
    state = chosen.summary(len(chosen.times) - 1)
    text = translated("{place}, {time}: Hs {height:.2f} m, Tp {period:.1f} s").format(
        place=printable(chosen.place), time=time_text(chosen.times[-1]),
        height=state.significant_wave_height, period=state.peak_period,
    )  # fmt: skip
    if math.isfinite(state.mean_direction):
        text += translated(", from {degrees:.0f}°").format(degrees=state.comes_from)
    return text


def draw_import_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Draw the entry in File > Import."""
    self.layout.operator(OCEAN_OT_import_measured.bl_idname, text="Measured Sea (NDBC, SWAN)")


CLASSES = (OCEAN_OT_import_measured,)
