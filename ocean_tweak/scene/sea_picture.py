# SPDX-License-Identifier: GPL-3.0-or-later
"""A small picture of a sea under a sky, made in a moment without a scene or an engine."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters
from ..core.numerics.interpolation import between
from ..core.spectral.spectra import wind_at_10_m
from ..core.waves.spectral import WaveLayer

Array = NDArray[np.float64]

#: pixels along each side
SIZE = 192
#: light that comes out of clear sea water, linear
CLEAR_WATER = (0.006, 0.045, 0.070)
#: samples along each side of the sea, and steps of a ray
_SAMPLES, _STEPS = 256, 700
#: m: where rays begin and end, and how high the eye is above the waves
_NEAR, _FAR, _EYE = 4.0, 6000.0, 3.5
#: share of the picture's height above the horizon, and pixels of a slope of 1
_SKY, _FOCUS = 0.42, 1.1
#: m/s: from this wind on the sky is overcast, and from that on wholly
_FAIR, _OVERCAST = 12.0, 24.0
#: of a ball in the water: middle and radius, as shares of the picture
_BALL = np.array((0.5, 0.46, 0.17))
_HORIZON, _ZENITH = np.array((0.50, 0.61, 0.70)), np.array((0.05, 0.17, 0.40))
_CLOUD = np.array((0.30, 0.33, 0.36))
_TO_SUN = np.array((-0.55, 0.75, 0.36)) / np.linalg.norm((-0.55, 0.75, 0.36))
_SUNLIGHT = np.array((1.0, 0.86, 0.66))
#: of dense foam, and the most of the water that it covers
_FOAM, _THICKEST = np.array((0.72, 0.75, 0.77)), 0.8


class SeaView:
    """What an eye above the waves sees of a sea at its time 0, still without colours.

    Raises ParameterError for a sea that cannot be shown on so few samples.
    """

    def __init__(self, parameters: OceanParameters) -> None:
        sea = parameters.on_one_grid(_SAMPLES)
        outputs = {"displacement", "normal"} | ({"foam"} if sea.foam.coverage > 0.0 else set())
        fields = Ocean(sea).surface(0.0, outputs)
        seen, distance = _seen(np.asarray(fields.displacement, np.float64), sea.domain_size)
        self._is_sea = np.isfinite(distance)
        self._distance = distance[self._is_sea][:, np.newaxis]
        x, y = (part[self._is_sea] / sea.domain_size * _SAMPLES for part in seen)
        at = between(y, x, (_SAMPLES, _SAMPLES))
        self._normal = np.stack([at.read(fields.normal[..., axis]) for axis in range(3)], axis=-1)
        foam = np.clip(at.read(fields.foam), 0.0, 1.0) if "foam" in outputs else np.zeros_like(x)
        self._foam = _THICKEST * foam[:, np.newaxis]
        self._wind = _wind(sea)

    def picture(self, water: Sequence[float] = CLEAR_WATER) -> Array:
        """(SIZE, SIZE, 4) in sRGB, the lowest row first.

        water : light that comes out of the water, linear
        """
        overcast = float(np.clip((self._wind - _FAIR) / (_OVERCAST - _FAIR), 0.0, 1.0))
        rays = _directions()
        picture = _sky(rays, overcast)
        shown = _water(self._normal, rays[self._is_sea], self._wind, overcast, np.asarray(water))
        lit = np.clip(self._normal @ _TO_SUN, 0.0, 1.0)[:, np.newaxis]
        shown += self._foam * (_FOAM * (1.0 - 0.4 * overcast) * (0.5 + lit) - shown)
        haze = 1.0 - np.exp(-self._distance / (0.5 * _FAR))
        picture[self._is_sea] = shown + haze * (_sky(np.array((0.0, 1.0, 0.0)), overcast) - shown)
        opaque = np.ones((SIZE, SIZE, 1))
        return np.concatenate([np.clip(picture, 0.0, 1.0) ** (1.0 / 2.2), opaque], axis=-1)


def draw_ball(picture: Array, colour: Sequence[float], wet: float) -> None:
    """Draw a ball that floats in a picture of `SeaView`, to tell one picture from another.

    colour : sRGB
    wet : share of its height that is darker
    """
    place = np.stack(np.meshgrid(np.arange(SIZE), np.arange(SIZE)), axis=-1) / SIZE
    x, y = np.moveaxis((place - _BALL[:2]) / _BALL[2], -1, 0)
    height = np.sqrt(np.clip(1.0 - x**2 - y**2, 0.0, 1.0))
    shade = 0.35 + 0.65 * np.clip(-0.45 * x + 0.6 * y + 0.65 * height, 0.0, 1.0)
    shade = np.where(y < 2.0 * wet - 1.0, 0.45 * shade, shade)[..., np.newaxis]
    is_ball = (height > 0.0) & (y > -0.6)  # the rest is under water
    picture[is_ball, :3] = (np.asarray(colour) * shade)[is_ball]


def write_png(picture: Array, path: Path) -> None:
    """Write a picture of `SeaView`. Raises OSError for what the disk refuses."""
    image = bpy.data.images.new(path.stem, SIZE, SIZE)
    try:
        image.pixels.foreach_set(np.ascontiguousarray(picture, np.float32).ravel())
        image.filepath_raw, image.file_format = str(path), "PNG"
        image.save()
    except RuntimeError as error:
        raise OSError(f"{path}: {error}") from error
    finally:
        bpy.data.images.remove(image)


def _wind(sea: OceanParameters) -> float:
    """The strongest wind at 10 m of the layers that have one, m/s."""
    layers = [layer for layer in sea.active(WaveLayer) if layer.definition == "WIND"]
    return max((wind_at_10_m(layer.wind_speed, layer.wind_height) for layer in layers), default=0.0)


def _directions() -> Array:
    """(SIZE, SIZE, 3) of rays through the pixels, of length 1, around y; the lowest row first."""
    across = (np.arange(SIZE) + 0.5) / SIZE - 0.5
    up = (np.arange(SIZE) + 0.5) / SIZE - (1.0 - _SKY)
    x, z = np.meshgrid(across / _FOCUS, up / _FOCUS)
    rays = np.stack([x, np.ones_like(x), z], axis=-1)
    return rays / np.linalg.norm(rays, axis=-1, keepdims=True)


def _seen(displacement: Array, size: float) -> tuple[tuple[Array, Array], Array]:
    """Where each pixel's ray meets the water: its place at rest, and its distance in m; infinite in the sky.

    Along a column of pixels water hides what is behind it and lower in the picture.
    """
    away = np.geomspace(_NEAR, _FAR, _STEPS)[:, np.newaxis]
    across = ((np.arange(SIZE) + 0.5) / SIZE - 0.5) / _FOCUS
    x, y = away * across, np.broadcast_to(away, (_STEPS, SIZE))
    rest_x, rest_y = x, y
    cells = displacement.shape[0] / size
    for _ in range(3):  # to the place at rest of the water that is there
        at = between(rest_y * cells, rest_x * cells, displacement.shape)
        moved = [at.read(displacement[..., axis]) for axis in range(2)]
        rest_x, rest_y = x - moved[0], y - moved[1]
    height = between(rest_y * cells, rest_x * cells, displacement.shape).read(displacement[..., 2])
    eye = _EYE + float(displacement[..., 2].max())
    row = SIZE * (1.0 - _SKY + _FOCUS * (height - eye) / away)
    highest = np.maximum.accumulate(row, axis=0)
    wanted = np.arange(SIZE) + 0.5
    first = np.stack([np.searchsorted(highest[:, column], wanted) for column in range(SIZE)], axis=1)
    step = np.minimum(first, _STEPS - 1)
    column = np.broadcast_to(np.arange(SIZE), (SIZE, SIZE))
    distance = np.where(first < _STEPS, away[step, 0], np.inf)
    return (rest_x[step, column], rest_y[step, column]), distance


def _sky(rays: Array, overcast: float) -> Array:
    """Light from directions (…, 3)."""
    up = np.clip(rays[..., 2:], 0.0, 1.0)
    clear = _ZENITH + (_HORIZON - _ZENITH) * np.exp(-4.0 * up)
    glow = np.clip(rays @ _TO_SUN, 0.0, 1.0)[..., np.newaxis]
    clear = clear + 0.25 * _SUNLIGHT * glow**8
    return clear + overcast * (_CLOUD * (1.0 + 0.25 * (1.0 - up)) - clear)


def _water(normal: Array, rays: Array, wind: float, overcast: float, body: Array) -> Array:
    """Light from the water in places (n, 3): what it mirrors, and what comes out of it.

    The mean of Fresnel's reflection over the ripples that the samples do not hold is that of Bruneton, Neyret
    and Holzschuch (2010), with the slopes of Cox and Munk (1954) for the wind.
    """
    roughness = np.sqrt(0.003 + 0.00512 * wind)
    cosine = np.clip(-np.sum(normal * rays, axis=-1), 0.0, 1.0)
    fresnel = (1.0 - cosine) ** (5.0 * np.exp(-2.69 * roughness)) / (1.0 + 22.7 * roughness**1.5)
    mirrored = rays + 2.0 * cosine[:, np.newaxis] * normal
    mirrored[:, 2] = np.abs(mirrored[:, 2])
    share = (0.02 + 0.98 * fresnel)[:, np.newaxis]
    light = share * _sky(mirrored, overcast) + (1.0 - share) * body * (1.0 - 0.5 * overcast)
    glint = np.clip(mirrored @ _TO_SUN, 0.0, 1.0)[:, np.newaxis]
    return light + (1.0 - overcast) * _SUNLIGHT * glint**120
