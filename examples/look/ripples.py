# SPDX-License-Identifier: GPL-3.0-or-later
"""The waves of a sea that are shorter than its geometry can hold, as an image of heights in metres."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np


@dataclass(frozen=True)
class Ripples:
    """A square, repeating image of heights.

    image : red is metres
    size : side, m
    typical_length : wavelength, m
    fps : frames in a second of the shot
    """

    image: bpy.types.Image
    size: float
    typical_length: float
    fps: float


def make(core, parameters, name, size=48.0, resolution=512, longest=None):
    """Make the ripples of a sea on a small patch.

    core : module `ocean_tweak.core`
    parameters : its `OceanParameters`, of which wind and water are used
    size : side of the patch, m
    longest : wavelength above which there is nothing, m; by default two samples of the sea's own grid
    """
    longest = longest or 2.0 * parameters.domain_size / parameters.resolution
    patch = parameters.replace(domain_size=size, resolution=resolution, choppiness=0.0)
    elevation = core.Ocean(patch).surface(0.0).displacement[..., 2].astype(np.float64)
    k = 2.0 * np.pi * np.fft.fftfreq(resolution, size / resolution)
    kx, ky = k[: resolution // 2 + 1], k[:, None]
    modes = np.fft.rfft2(elevation)
    modes[np.hypot(kx, ky) < 2.0 * np.pi / longest] = 0.0
    return Ripples(
        _image(name, np.fft.irfft2(modes, s=elevation.shape)),
        size,
        0.5 * longest,
        float(parameters.timing.fps),
    )


def _image(name, heights):
    side = heights.shape[0]
    image = bpy.data.images.new(name, side, side, alpha=False, float_buffer=True, is_data=True)
    pixels = np.ones((side, side, 4), np.float32)
    pixels[..., :3] = heights[..., None]
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    return image
