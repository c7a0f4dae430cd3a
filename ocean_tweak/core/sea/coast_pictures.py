# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea's long waves over a bed: one fixed complex picture per frequency.

The waves are those of the sea. Over the rim, where the depth is that of the open sea, a picture is the sum of
the waves of its frequency, each with its own wave vector; from there this sum is marched over the bed.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics.memo import total_bytes
from ..numerics.threads import default_workers, run_blocks
from ..parameters.ocean_parameters import OceanParameters
from ..spectral import dispersion
from ..synthesis.coefficients import InitialState
from ..waves.coast import march
from ..waves.coast.ground import Ground

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]

#: part of what pictures are kept under: another, whenever the same waves over the same bed become others
_EDITION = 1

#: energy of a wave over that of the highest, below which it is as good as none
_FAINTEST = 1e-12
#: of waves that run towards the shore, the largest angle to the march
_WIDEST = np.radians(70.0)


class Incoming(NamedTuple):
    """The waves of a sea's first patch that reach its coast.

    modes : (N, N//2+1, 2) which of its modes they are, of those along +k and along -k
    number : (waves,) of the frequency, in whole turns in the time after which the sea repeats
    along, across : (waves,) rad/m, their wave vectors along the march and along its rows
    amplitude : (waves,) complex, m, at the sea's origin and time 0
    """

    modes: NDArray[np.bool_]
    number: NDArray[np.intp]
    along: Array
    across: Array
    amplitude: ComplexArray


def incoming(sea: OceanParameters, state: InitialState, ground: Ground) -> Incoming:
    """Select waves that are long enough and run towards the shore."""
    grid, coast, period = state.grid, ground.coast, sea.repeats_after
    assert period is not None
    turn = ground.turn - ground.rotation
    c, s = round(np.cos(turn)), round(np.sin(turn))
    along = np.broadcast_to(c * grid.kx + s * grid.ky, grid.shape)
    across = np.broadcast_to(c * grid.ky - s * grid.kx, grid.shape)
    long = grid.usable & (grid.k <= 2.0 * np.pi / coast.shortest_wavelength)
    # the lattice's own numbers are rounded: which half of it a wave is of must not depend on that
    straight = long & (np.abs(along) >= np.cos(_WIDEST) * grid.k)
    modes = np.stack((straight & (along > 0.0), straight & (along < 0.0)), axis=-1)
    energy = np.abs(np.stack((state.h_plus, state.h_minus), axis=-1)) ** 2
    modes &= energy > _FAINTEST * energy.max()
    plus, minus = modes[..., 0], modes[..., 1]
    twice = np.broadcast_to(grid.multiplicity, grid.shape)
    number = np.rint(state.omega * (float(period) / (2.0 * np.pi))).astype(np.intp)
    return Incoming(
        modes,
        np.concatenate((number[plus], number[minus])),
        np.concatenate((along[plus], -along[minus])),
        np.concatenate((across[plus], -across[minus])),
        np.concatenate(((twice * state.h_plus)[plus], np.conj(twice * state.h_minus)[minus])).astype(complex),
    )


def most_frequencies(sea: OceanParameters) -> int:
    """Upper bound on the number of frequencies of waves that reach a coast."""
    assert sea.coast is not None
    assert sea.repeats_after is not None
    # no grid has shorter waves than along its diagonal
    k = np.pi * min(2.0 / sea.coast.shortest_wavelength, math.sqrt(2.0) * sea.resolution / sea.domain_size)
    highest = float(dispersion.angular_frequency(np.array(k), sea.dispersion, sea.water))
    return int(highest * float(sea.repeats_after) / (2.0 * np.pi)) + 1


@dataclass(frozen=True, eq=False)
class Pictures:
    """Of each frequency the elevation and the potential of the horizontal displacement, over all wet samples.

    numbers : (frequencies,) in whole turns in the time after which the sea repeats
    elevation, potential : (frequencies, wet samples) complex64, m and m²: the fields are the real parts of
        the pictures times e^(-iωt)
    """

    numbers: NDArray[np.intp]
    elevation: ComplexArray
    potential: ComplexArray

    @property
    def nbytes(self) -> int:
        """Bytes of all of them."""
        return total_bytes((self.elevation, self.potential))

    @cached_property
    def energy(self) -> Array:
        """(frequencies,) mean squares of their elevation over all wet samples, m²."""
        parts = self.elevation.view(np.float32)
        squares = np.einsum("ij,ij->i", parts, parts)
        return squares.astype(np.float64) / max(self.elevation.shape[1], 1)

    @cached_property
    def rms_height(self) -> Array:
        """(wet samples,) root mean square height in m."""
        parts = self.elevation.view(np.float32)
        squares = np.einsum("ij,ij->j", parts, parts).reshape(-1, 2).sum(axis=1)
        return 2.0 * np.sqrt(squares.astype(np.float64))

    def signal(self, factor: ComplexArray) -> ComplexArray:
        """(wet samples,) complex64 sum of the elevation's pictures, each times a factor."""
        return factor.astype(np.complex64) @ self.elevation

    def potential_sum(self, factor: ComplexArray) -> RealArray:
        """(wet samples,) float32 real part of the sum of the potential's pictures, each times a factor."""
        return (factor.astype(np.complex64) @ self.potential).real


def fingerprint(sea: OceanParameters, waves: Incoming, ground: Ground) -> str:
    """Name of all that pictures follow from, for keeping them on disk."""
    numbers = (
        _EDITION, sea.repeats_after, sea.water.depth, sea.water.gravity, sea.orbital_motion, ground.step,
        ground.first, ground.rim_rows, ground.coast.breaking, ground.coast.mirror,
    )  # fmt: skip
    of = hashlib.sha256(repr(numbers).encode())
    for array in (ground.depth, ground.late_on_rim, *waves[1:]):
        of.update(repr((array.shape, array.dtype.str)).encode())
        of.update(np.ascontiguousarray(array))
    return of.hexdigest()


def pictures(
    sea: OceanParameters,
    waves: Incoming,
    ground: Ground,
    tell: Callable[[float], None] = lambda done: None,
) -> Pictures:
    """March the waves over the bed. `tell` is told again and again which share is done."""
    assert sea.repeats_after is not None
    numbers, of_number = np.unique(waves.number, return_inverse=True)
    omega = numbers.astype(np.float64) * (2.0 * np.pi / float(sea.repeats_after))
    rim, wet = ground.rim_rows, ground.depth > 0.0
    over_rim = _over_rim(waves, of_number, len(numbers), ground, rim)
    # what walls throw back runs over the rim too
    mirror = ground.coast.mirror
    start = 0 if mirror > 0.0 else rim - 1
    bed = march.Bed.of(ground.depth[start:], ground.step, sea.water.gravity)
    amplitudes = np.ones(len(numbers)) if ground.coast.breaking else None
    workers = default_workers(over_rim[:, -1].size * 64)
    marched = march.march(bed, omega, over_rim[:, start], None, amplitudes, mirror, workers, tell)
    deep = sea.water.depth if sea.orbital_motion == "FINITE_DEPTH" else np.inf
    wider = waves._replace(amplitude=waves.amplitude * _wider(np.hypot(waves.along, waves.across), deep))
    own = _over_rim(wider, of_number, len(numbers), ground, rim)
    # each wave's own number on the rim, from there on one for all of a frequency: no step between
    late = ground.late_on_rim[:, np.newaxis]
    elevation, potential = (np.empty((len(numbers), int(wet.sum())), np.complex64) for _ in range(2))
    depth = np.concatenate((np.broadcast_to(bed.depth[0], (start, ground.columns)), bed.depth))

    def finish(index: int) -> None:
        whole = np.concatenate((over_rim[index], marched[index, rim - start :]))
        k = march.wave_numbers(omega[index], depth, sea.water.gravity)
        k = np.minimum(k, march.MOST_TURN / ground.step)
        wider = _wider(k, depth if np.isfinite(deep) else np.inf)
        wide = whole * wider
        wide[:rim] += (1.0 - late) * (own[index] - wide[:rim])
        if mirror > 0.0:
            thrown_back = marched[index, :rim] - over_rim[index]
            whole[:rim] += thrown_back
            wide[:rim] += thrown_back * wider[:rim]
        for target, field in ((elevation, whole), (potential, wide)):
            target[index] = field[wet]

    run_blocks(finish, range(len(numbers)), workers)
    return Pictures(numbers, elevation, potential)


def _wider(k: Array, depth: Array | float) -> Array:
    """From the elevation to the potential, as `InitialState.potential_factor` has it."""
    result: Array = 1.0 / (k * np.tanh(k * depth))
    return result


def _over_rim(
    waves: Incoming, of_number: NDArray[np.intp], count: int, ground: Ground, rows: int
) -> ComplexArray:
    """(frequencies, rows, columns) complex64 sums of the waves of each frequency over the flat rim."""
    along = ground.first[0] + ground.step * np.arange(rows)
    across = ground.first[1] + ground.step * np.arange(ground.columns)
    result: ComplexArray = np.empty((count, rows, ground.columns), np.complex64)
    for index in range(count):
        own = of_number == index
        to_shore = np.exp(1j * along[:, np.newaxis] * waves.along[own]) * waves.amplitude[own]
        result[index] = to_shore @ np.exp(1j * waves.across[own, np.newaxis] * across)
    return result
