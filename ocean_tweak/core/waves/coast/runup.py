# SPDX-License-Identifier: GPL-3.0-or-later
"""How far up a beach waves run."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: slopes of the foreshores from which the formula comes (Stockdon and others 2006, table 1)
GENTLEST, STEEPEST = 0.01, 0.16


def run_up(height: float, wavelength: float, slope: Array) -> tuple[Array, Array]:
    """Set-up of the waterline above still water, and swash, the whole way up and down around it, in m.

    height, wavelength : of the waves in deep water, significant and at the peak, m
    slope : of the foreshore, rise over run; beyond what was measured it counts as the next that was

    Stockdon, Holman, Howd and Sallenger (2006), eq. 10 to 12 with the coefficients of eq. 19.
    """
    held = np.clip(slope, GENTLEST, STEEPEST)
    scale = math.sqrt(height * wavelength)
    return 0.35 * held * scale, np.sqrt(0.563 * held**2 + 0.004) * scale


def highest_run_up(setup: Array, swash: Array) -> Array:
    """Height above still water in m that 2 % of run-ups exceed: 1.1 (set-up + swash/2), eq. 9 and 19."""
    result: Array = 1.1 * (setup + 0.5 * swash)
    return result
