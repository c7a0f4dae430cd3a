# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea summed cosine by cosine: slow, plain, and independent of every transform; and the other way."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ocean_tweak.core import OceanParameters
from ocean_tweak.core.synthesis.channels import OF_WAVES
from ocean_tweak.core.synthesis.coefficients import InitialState
from ocean_tweak.core.synthesis.transforms import Rows, Synthesis

Wave = tuple[float, float, float, float, float]


def waves(state: InitialState) -> Iterator[Wave]:
    """kx, ky, ω, amplitude and phase ε of each wave a cos(k·x - ωt + ε).

    Each coefficient h_plus is one wave along +k; each h_minus one along -k, which in the column kx = 0 is
    another row's h_plus and must not count twice.
    """
    grid = state.grid
    for (i, j), omega in np.ndenumerate(state.omega):
        kx, ky = grid.kx[0, j], grid.ky[i, 0]
        found = [(kx, ky, state.h_plus[i, j])]
        if j > 0:
            found.append((-kx, -ky, np.conj(state.h_minus[i, j])))
        for wave_x, wave_y, coefficient in found:
            if coefficient != 0.0:
                yield wave_x, wave_y, float(omega), 2.0 * abs(coefficient), float(np.angle(coefficient))


def fields(
    state: InitialState,
    time: float,
    choppiness: float,
    horizontal_factor: Callable[[float], float] = lambda k: 1.0,
    weight: Callable[[float], float] = lambda k: 1.0,
) -> dict[str, np.ndarray]:
    """Position and its derivatives, all (N, N), m, m/m and m/s: keys "x", "x_x", "x_y", "x_t", "y", …

    h = Σ a cos(k·x - ωt + ε) and D = -λ Σ (k/|k|) a sin(k·x - ωt + ε), Chen (2014), eq. 5 and 11, and what
    follows by differentiating each term by hand.
    """
    n = state.grid.resolution
    x = state.grid.domain_size / n * np.arange(n)
    X, Y = np.meshgrid(x, x)
    result = {c + d: np.zeros((n, n)) for c in "xyz" for d in ("", "_x", "_y", "_t")}
    for kx, ky, omega, a, phase in waves(state):
        k = np.hypot(kx, ky)
        a = a * weight(k)
        angle = kx * X + ky * Y - omega * time + phase
        sine, cosine = a * np.sin(angle), a * np.cos(angle)
        result["z"] += cosine
        for name, rate in (("_x", kx), ("_y", ky), ("_t", -omega)):
            result["z" + name] -= rate * sine
        for component, along in (("x", kx), ("y", ky)):
            factor = choppiness * horizontal_factor(k) * along / k
            result[component] -= factor * sine
            for name, rate in (("_x", kx), ("_y", ky), ("_t", -omega)):
                result[component + name] -= factor * rate * cosine
    return result


def surface_of(state: InitialState, time: float = 0.0, dtype: type = np.complex128) -> dict:
    """All fields of a state at a time by the transforms under test, with choppiness 1."""
    fields = {name: np.empty(output.shape(state.grid.resolution)) for name, output in OF_WAVES.items()}

    def write(block: slice, rows: Rows) -> None:
        for name, output in OF_WAVES.items():
            output.write(rows, fields[name][block])

    needs = {need for output in OF_WAVES.values() for need in output.needs}
    Synthesis(state, OceanParameters(), dtype=dtype).fill(time, needs, write)
    return fields
