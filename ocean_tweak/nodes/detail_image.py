# SPDX-License-Identifier: GPL-3.0-or-later
"""The images of the water material, packed into the file: detail finer than any grid, and gusts.

They contain cubic B-spline weights, which both engines interpolate alike. With any other interpolation, EEVEE
mip-maps the pattern of distant water before the shader turns it into foam, and Cycles does not.
"""

from __future__ import annotations

import base64
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
#: five samples across the smallest domes
_BILLOW_RESOLUTION = 352
_GUST_RESOLUTION = 128
#: rounding relative to the root mean square, fine enough for 16 bits and coarse enough to compress
_PRECISION = 1.0 / 64.0
#: a black OpenEXR image of one pixel, of red, green and blue in 16 bits with ZIP. Blender packs new images in
#: 32 bits without compression, but one that it has read as it was: a quarter of that
_HALVES = base64.b64decode(
    "di8xAQIAAABjaGFubmVscwBjaGxpc3QANwAAAEIAAQAAAAAAAAABAAAAAQAAAEcAAQAAAAAAAAABAAAAAQAAAFIAAQAAAAAA"
    "AAABAAAAAQAAAABjb21wcmVzc2lvbgBjb21wcmVzc2lvbgABAAAAA2RhdGFXaW5kb3cAYm94MmkAEAAAAAAAAAAAAAAAAAAA"
    "AAAAAABkaXNwbGF5V2luZG93AGJveDJpABAAAAAAAAAAAAAAAAAAAAAAAAAAbGluZU9yZGVyAGxpbmVPcmRlcgABAAAAAHBp"
    "eGVsQXNwZWN0UmF0aW8AZmxvYXQABAAAAAAAgD9zY3JlZW5XaW5kb3dDZW50ZXIAdjJmAAgAAAAAAAAAAAAAAHNjcmVlbldp"
    "bmRvd1dpZHRoAGZsb2F0AAQAAAAAAIA/dHlwZQBzdHJpbmcADQAAAHNjYW5saW5laW1hZ2UAXgEAAAAAAAAAAAAABgAAAAAA"
    "AAAAAA=="
)


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
    height = billows(_BILLOW_RESOLUTION)
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
    image = bpy.data.images.new(name, 1, 1, alpha=False, float_buffer=True, is_data=True)
    image.source = "FILE"
    image.pack(data=_HALVES, data_len=len(_HALVES))
    image.scale(side, side)
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    image.pack()
    image[_KEY] = tag
    return image
