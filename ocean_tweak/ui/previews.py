# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures in panels: the spectrum of an ocean, and thumbnails for choosing a preset.

The choice is a property of the window manager, not of the file.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import bpy.utils.previews
import numpy as np

from ..core import OceanParameters
from ..scene import user_presets
from ..scene.refinement import has_window, redraw_views
from ..scene.settings import is_ocean, settings_of
from .active_ocean import shown_ocean
from .spectrum_plot import SIZE, spectrum_plot

_THUMBNAILS = Path(__file__).parent / "thumbnails"
_SPECTRUM = "spectrum"
# delay in s after a change of the sea, as dragging causes many
_PAUSE = 0.1


class Previews:
    """Blender's preview collection, created on first use."""

    def __init__(self) -> None:
        self._collection: bpy.utils.previews.ImagePreviewCollection | None = None
        self._drawn: OceanParameters | None = None
        self._asked: OceanParameters | None = None

    @property
    def collection(self) -> bpy.utils.previews.ImagePreviewCollection:
        """It is Blender's until `close` gives it back."""
        if self._collection is None:
            self._collection = bpy.utils.previews.new()
        return self._collection

    def spectrum(self, parameters: OceanParameters) -> int:
        """Icon of a sea's spectrum; where it shows another sea, it is drawn in a moment."""
        if _SPECTRUM not in self.collection:
            self.collection.new(_SPECTRUM)
        if parameters is not self._asked:
            self._asked = parameters
            if not has_window():
                draw_spectrum()
            elif not bpy.app.timers.is_registered(draw_spectrum):
                bpy.app.timers.register(draw_spectrum, first_interval=_PAUSE)
        return int(self.collection[_SPECTRUM].icon_id)

    def draw_spectrum(self) -> None:
        """Draw the spectrum of the sea that was asked for last, unless that is there."""
        if self._asked is None:
            return
        shown = _spectral(self._asked)
        if self._drawn != shown:
            picture = self.collection[_SPECTRUM]
            picture.image_size = (SIZE, SIZE)
            picture.image_pixels_float.foreach_set(np.ascontiguousarray(spectrum_plot(shown)).reshape(-1))
            self._drawn = shown
            redraw_views()

    def thumbnail(self, key: str) -> int:
        """Icon of a preset; 0, which is none, where it has no picture."""
        path = user_presets.picture_of(key) if user_presets.is_own(key) else _thumbnails().get(key)
        if path is None or not path.exists():
            return 0
        name = f"{key} {path.stat().st_mtime_ns}"  # one that was replaced has another picture
        if name not in self.collection:
            self.collection.load(name, str(path), "IMAGE")
        return int(self.collection[name].icon_id)

    def close(self) -> None:
        """Give the pictures back to Blender."""
        if bpy.app.timers.is_registered(draw_spectrum):
            bpy.app.timers.unregister(draw_spectrum)
        if self._collection is not None:
            bpy.utils.previews.remove(self._collection)
        self._collection, self._drawn, self._asked = None, None, None


@cache
def _thumbnails() -> dict[str, Path]:
    """The pictures that came along, by the preset's key."""
    return {path.stem: path for path in _THUMBNAILS.glob("*.jpg")}


def _spectral(parameters: OceanParameters) -> OceanParameters:
    """What the picture depends on: a seed or a choppiness gives no other one."""
    default = OceanParameters()
    return parameters.replace(
        seed=0, choppiness=1.0, trough_damping=0.0, orbital_motion="DEEP", foam=default.foam,
        loop_duration=None, amplitudes=default.amplitudes, match_height=False, timing=default.timing,
    )  # fmt: skip


#: what panels show; `close` it when the extension is disabled
PREVIEWS = Previews()


def draw_spectrum() -> None:
    """The timer: panels themselves only draw."""
    PREVIEWS.draw_spectrum()


_NONE = ("NONE", "Custom", "The settings match no preset")


@cache
def _short(title: str) -> str:
    """A title that is not cut under its picture; kept, since Blender reads it later."""
    return title.replace("Beaufort ", "Bft ")


# Blender wants the texts of an enumeration's items to be kept alive
_kept: list[tuple[str, str, str, int, int]] = []


def _items(_owner: object, context: bpy.types.Context | None) -> list[tuple[str, str, str, int, int]]:
    # enumerations must not be made while Blender only collects its properties' documentation
    if context is None:
        return [(*_NONE, _custom_icon(), 0)]
    presets = user_presets.all_presets()
    _kept[:] = [(*_NONE, _custom_icon(), 0)] + [
        (key, _short(preset.title), preset.description, PREVIEWS.thumbnail(key), number)
        for number, (key, preset) in enumerate(presets.items(), start=1)
    ]
    return _kept


def _custom_icon() -> int:
    """Blender's own picture of an ocean."""
    icons = bpy.types.UILayout.bl_rna.functions["prop"].parameters["icon"].enum_items
    return int(icons["MOD_OCEAN"].value)


def _chosen(_owner: object) -> int:
    """The preset whose sea the active ocean has."""
    item = shown_ocean(bpy.context)
    if not is_ocean(item):
        return 0
    title = settings_of(item).preset
    titles = [preset.title for preset in user_presets.all_presets().values()]
    return titles.index(title) + 1 if title in titles else 0


def _choose(_owner: object, number: int) -> None:
    keys = list(user_presets.all_presets())
    if 0 < number <= len(keys) and bpy.ops.ocean.apply_preset.poll():
        bpy.ops.ocean.apply_preset("EXEC_DEFAULT", True, key=keys[number - 1])


def register() -> None:
    """Give windows the property."""
    bpy.types.WindowManager.ocean_tweak_preset = bpy.props.EnumProperty(
        name="Preset", description="A sea by its name", items=_items, get=_chosen, set=_choose
    )


def unregister() -> None:
    """Take it back, with its pictures."""
    del bpy.types.WindowManager.ocean_tweak_preset
    PREVIEWS.close()
    _kept.clear()
