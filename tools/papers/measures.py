# SPDX-License-Identifier: GPL-3.0-or-later
"""What the pages measure on their seas."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ocean_tweak.core import Ocean, OceanParameters
from ocean_tweak.core.synthesis.coefficients import InitialState

from .pages import Table

Array = NDArray[np.float64]


def elevation(sea: OceanParameters, time: float = 0.0) -> Array:
    """(N, N) heights of a sea, m."""
    return Ocean(sea).surface(time).displacement[..., 2].astype(float)


def bound(worst: float, limit: float) -> str:
    """A difference in m whose digits depend on the machine."""
    return f"below {limit:g} m" if worst < limit else f"{worst:.1e} m"


def direct_sum(state: InitialState, time: float) -> Array:
    """(N, N, 3) displacement in m by eq. 5 and 11, cosine by cosine, λ = 1."""
    grid = state.grid
    x = grid.domain_size / grid.resolution * np.arange(grid.resolution)
    along = [
        (kx, ky, state.omega[i, j], h[i, j])
        for sign, h in ((1.0, state.h_plus), (-1.0, np.conj(state.h_minus)))
        for i, j in np.argwhere(h != 0.0)
        if sign > 0.0 or j > 0  # in the first column, one half of the plane holds both
        for kx, ky in [(sign * grid.kx[0, j], sign * grid.ky[i, 0])]
    ]
    kx, ky, omega, h = (np.array(part) for part in zip(*along, strict=True))
    amplitude, phase, k = 2.0 * np.abs(h), np.angle(h), np.hypot(kx, ky)
    result = np.zeros((len(x), len(x), 3))
    for row, y in enumerate(x):
        angle = x[:, np.newaxis] * kx + (y * ky - omega * time + phase)
        sine, cosine = np.sin(angle), np.cos(angle)
        parts = [-sine @ (amplitude * kx / k), -sine @ (amplitude * ky / k), cosine @ amplitude]
        result[row] = np.stack(parts, axis=-1)
    return result


def seam_steps(elevation: Array) -> Table:
    """Steps of height from sample to sample, inside a patch (N, N) in m and over its rim."""
    inside = np.sqrt(np.mean(np.diff(elevation, axis=1) ** 2))
    over = np.sqrt(np.mean((elevation[:, 0] - elevation[:, -1]) ** 2))
    return [
        ["step from sample to sample", "rms"],
        ["inside the patch", f"{inside:.3f} m"],
        ["from one patch to the next", f"{over:.3f} m"],
    ]
