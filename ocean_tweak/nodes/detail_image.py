# SPDX-License-Identifier: GPL-3.0-or-later
"""The images of the water material, packed into the file: detail finer than any grid, and gusts.

They contain cubic B-spline weights, which both engines interpolate alike. With any other interpolation, EEVEE
mip-maps the pattern of distant water before the shader turns it into foam, and Cycles does not.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from functools import partial

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.numerics.memo import MEMO
from ..core.numerics.rounding import rounded
from .surface_detail import billows, foam_lace, gradient, gusts, normal, ripple_slopes, spline_weights

_KEY = "ocean_tweak_image"
#: in the memo; the patterns of every file are the same
CHANNELS = "channels of images"
_Maker = Callable[[], Iterable[NDArray[np.float64]]]
_RESOLUTION = 512
_GUST_RESOLUTION = 128
#: rounding relative to the root mean square, which reduces the image's size in the file to a third
_PRECISION = 1.0 / 64.0


def make_ahead() -> None:
    """Compute the patterns of missing images on another thread."""
    lacking = [each for each in (_RIPPLES, _LACE, _BILLOWS, _GUSTS) if _present(_tag(*each[:2])) is None]

    def make() -> None:
        for name, version, channels in lacking:
            MEMO.get(CHANNELS, _tag(name, version), partial(_channels, channels))

    threading.Thread(target=make, daemon=True).start()


def ripple_image() -> bpy.types.Image:
    """Slopes of ripples in red and green."""
    return _image(*_RIPPLES)


def lace_image() -> bpy.types.Image:
    """The lace of foam in red, and its derivatives along x and y over a whole side in green and blue."""
    return _image(*_LACE)


def billow_image() -> bpy.types.Image:
    """Billows of foam, normally distributed, in red, and in green and blue their slopes along x and y."""
    return _image(*_BILLOWS)


def gust_image() -> bpy.types.Image:
    """Strength of gusts in red, uniformly distributed over 0…1."""
    return _image(*_GUSTS)


def _lace() -> Iterable[NDArray[np.float64]]:
    lace = foam_lace(_RESOLUTION)
    return lace, *gradient(lace)


def _billows() -> Iterable[NDArray[np.float64]]:
    height = billows(_RESOLUTION)
    return normal(height), *gradient(height)


#: images: name, version, and functions for their channels
_RIPPLES = ("Ocean Tweak Ripples", 1, partial(ripple_slopes, _RESOLUTION))
_LACE = ("Ocean Tweak Lace", 2, _lace)
_BILLOWS = ("Ocean Tweak Billows", 1, _billows)
_GUSTS = ("Ocean Tweak Gusts", 2, lambda: [gusts(_GUST_RESOLUTION)])


def _tag(name: str, version: int) -> str:
    return f"{name} {version}"


def _present(tag: str) -> bpy.types.Image | None:
    own = (image for image in bpy.data.images if image.library is None)
    return next((image for image in own if image.get(_KEY) == tag), None)


def _channels(make: _Maker) -> list[NDArray[np.floating]]:
    return [rounded(spline_weights(field), _PRECISION) for field in make()]


def _image(name: str, version: int, make: _Maker) -> bpy.types.Image:
    """The file's image of this name and version, created if missing."""
    tag = _tag(name, version)
    if (image := _present(tag)) is not None:
        return image
    channels = MEMO.get(CHANNELS, tag, lambda: _channels(make))
    side = len(channels[0])
    pixels = np.zeros((side, side, 4), np.float32)
    pixels[..., 3] = 1.0
    pixels[..., : len(channels)] = np.stack(channels, axis=-1)
    image = bpy.data.images.new(name, side, side, alpha=False, float_buffer=True, is_data=True)
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    image.pack()
    image[_KEY] = tag
    return image
