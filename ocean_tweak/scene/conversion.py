# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts Blender's Ocean modifier to a sea, and lists settings that cannot be converted."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from typing import NamedTuple

import bpy
from mathutils import Matrix

from ..core import Foam, OceanParameters, Timing, Water, WaveLayer
from . import ocean_object
from .animated import OCEAN_TIME, channel_bags, curves_of
from .evaluation import surfaces_of
from .plan import new_viewport_sea
from .settings import settings_of
from .units import frame_rate, metres_per_unit

#: Blender's spectra and ours
_SPECTRA = {
    "PHILLIPS": "PHILLIPS",
    "PIERSON_MOSKOWITZ": "PIERSON_MOSKOWITZ",
    "JONSWAP": "JONSWAP",
    "TEXEL_MARSEN_ARSLOE": "TMA",
}
_MOMENT = 0.05  # s
_WITH_FETCH = ("JONSWAP", "TEXEL_MARSEN_ARSLOE")


class Conversion(NamedTuple):
    """A sea, and how it lies.

    parameters : the sea
    repeats : patches along x and y
    viewport_resolution : samples along each side in the viewport
    lost : a sentence for each setting that has no counterpart
    """

    parameters: OceanParameters
    repeats: tuple[int, int]
    viewport_resolution: int
    lost: tuple[str, ...]


def ocean_modifier(item: bpy.types.Object | None) -> bpy.types.OceanModifier | None:
    """An object's first Ocean modifier, or None."""
    if item is None:
        return None
    return next((modifier for modifier in item.modifiers if modifier.type == "OCEAN"), None)


def convert(item: bpy.types.Object, modifier: bpy.types.OceanModifier, scene: bpy.types.Scene) -> Conversion:
    """The sea that corresponds to a modifier's settings. Raises ParameterError if there is none."""
    metres = float(metres_per_unit(scene))
    layer = {
        "spectrum": _SPECTRA[modifier.spectrum],
        "wind_speed": modifier.wind_velocity,
        "wind_direction": modifier.wave_direction,
    }
    if modifier.spectrum in _WITH_FETCH:
        layer["fetch"] = 1000.0 * modifier.fetch_jonswap
    parameters = OceanParameters(
        resolution=_samples(modifier.resolution),
        domain_size=modifier.spatial_size * modifier.size * metres,
        seed=modifier.random_seed,
        choppiness=modifier.choppiness,
        water=Water(depth=modifier.depth * metres),
        layers=(WaveLayer(**layer),),
        foam=Foam(coverage=1.0 if modifier.use_foam else 0.0),
        timing=Timing(fps=frame_rate(scene), start_frame=scene.frame_start),
    )
    return Conversion(
        parameters,
        (modifier.repeat_x, modifier.repeat_y),
        _samples(modifier.viewport_resolution),
        tuple(_lost(item, modifier)),
    )


class Made(NamedTuple):
    """The result of a conversion.

    original : still as it was
    lost : a sentence for each setting that has no counterpart
    """

    original: bpy.types.Object
    ocean: bpy.types.Object
    lost: tuple[str, ...]


class Converting:
    """A conversion that can be cancelled while its waves are computed on another thread.

    `finish` replaces the object by the ocean, once `done` is `steps`. Raises ParameterError for settings that
    cannot be converted.
    """

    steps = 1

    def __init__(
        self, original: bpy.types.Object, modifier: bpy.types.OceanModifier, scene: bpy.types.Scene
    ) -> None:
        self._original, self._modifier, self._scene, self.done = original, modifier, scene, 0
        self._result = convert(original, modifier, scene)
        sea = new_viewport_sea(self._result.parameters, self._result.viewport_resolution)
        self._worker = ThreadPoolExecutor(1, "Ocean Tweak")
        self._waves = self._worker.submit(surfaces_of(sea).ocean.prepare)

    def advance(self) -> None:
        """Wait briefly for the waves. Raises MemoryError for a sea too large."""
        wait([self._waves], _MOMENT)
        if self._waves.done():
            self._waves.result()
            self.done = 1

    def finish(self) -> Made:
        """Add the ocean. Raises what `ocean_object.add` raises; then nothing is added."""
        self._worker.shutdown()
        original, result = self._original, self._result
        item = ocean_object.add(
            self._scene, result.parameters, name=original.name, collection=original.users_collection[0],
            viewport_resolution=result.viewport_resolution,
        )  # fmt: skip
        settings_of(item).repeats_x, settings_of(item).repeats_y = result.repeats
        item.matrix_world = original.matrix_world @ Matrix.Translation((*corner(self._modifier), 0.0))
        for material in original.data.materials:
            item.data.materials.append(material)
        carry_time(original, self._modifier, item)
        return Made(original, item, result.lost)

    def cancel(self) -> None:
        """Cancel; nothing was changed."""
        self.abandon()

    def abandon(self) -> None:
        """End the thread without waiting for it."""
        self._worker.shutdown(wait=False, cancel_futures=True)


def corner(modifier: bpy.types.OceanModifier) -> tuple[float, float]:
    """The corner of the generated surface, in the object's own units.

    Blender puts the centre of the first patch at the origin and the others beyond it.
    """
    half = 0.5 * modifier.spatial_size * modifier.size
    return -half, -half


def _samples(resolution: int) -> int:
    """Blender's grid has the square of its resolution along each side; ours an even number."""
    return min(max(16, (resolution**2 + 1) // 2 * 2), 8192)


def _lost(item: bpy.types.Object, modifier: bpy.types.OceanModifier) -> Iterator[str]:
    if modifier.wave_scale != 1.0:
        yield f"Scale {modifier.wave_scale:.3g}: wind gives the wave height; change it with Amplitude Scale"
    if modifier.wave_alignment > 0.0:
        yield f"Alignment {modifier.wave_alignment:.3g}: use Swell, which stretches waves into trains"
    if modifier.geometry_mode == "DISPLACE":
        yield "The shape of the mesh: the sea gets its own grid"
    if modifier.use_foam and modifier.foam_coverage != 0.0:
        yield f"Foam coverage {modifier.foam_coverage:.3g}: foam follows the wind"
    if modifier.use_spray:
        yield "Spray map: switch Spray on, which throws up particles"
    if modifier.wave_scale_min > 0.02:
        yield f"Smallest wave {modifier.wave_scale_min:.3g} m: use Short Wave Cutoff"
    if modifier.sharpen_peak_jonswap and modifier.spectrum in _WITH_FETCH:
        yield f"Sharpen peak {modifier.sharpen_peak_jonswap:.3g}: use Peak Enhancement"
    if _has_layered_time(item, modifier):
        yield "Keys of Time in the nonlinear animation: the sea follows the scene's frames"


def carry_time(original: bpy.types.Object, modifier: bpy.types.OceanModifier, item: bpy.types.Object) -> None:
    """Copy keys or a driver from a modifier's time, which is in seconds like ours, to an ocean's time."""
    data, path = original.animation_data, _time_path(modifier)
    if data is None:
        return
    driver = next((driver for driver in data.drivers if driver.data_path == path), None)
    if driver is not None:
        item.animation_data_create().drivers.from_existing(src_driver=driver).data_path = OCEAN_TIME
    elif _is_keyed(data, path):
        own = item.animation_data_create()
        own.action = data.action.copy()  # with interpolation, handles and modifiers of its curves
        own.action_slot = next(slot for slot in own.action.slots if slot.handle == data.action_slot.handle)
        for bag in channel_bags(own.action, own.action_slot):
            for curve in list(bag.fcurves):
                if curve.data_path == path:
                    curve.data_path = OCEAN_TIME
                else:
                    bag.fcurves.remove(curve)
    else:
        return
    settings_of(item).use_ocean_time = True


def _time_path(modifier: bpy.types.OceanModifier) -> str:
    return f'modifiers["{bpy.utils.escape_identifier(modifier.name)}"].time'


def _is_keyed(data: bpy.types.AnimData, path: str) -> bool:
    bags = channel_bags(data.action, data.action_slot)
    return any(curve.data_path == path for bag in bags for curve in bag.fcurves)


def _has_layered_time(item: bpy.types.Object, modifier: bpy.types.OceanModifier) -> bool:
    """Whether NLA strips animate the time, and nothing overrides them."""
    data, path = item.animation_data, _time_path(modifier)
    if data is None or _is_keyed(data, path) or any(driver.data_path == path for driver in data.drivers):
        return False
    return any(curve.data_path == path for curve in curves_of(item))
