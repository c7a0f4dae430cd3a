# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea's Fourier coefficients at a time, from the initial state alone: any frame, in any order."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from .initial_state import InitialState

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating]

ALL = slice(None)


@dataclass(frozen=True)
class PropagatedState:
    """Coefficients at one time, of all columns or of a block of them, indexed [ky, kx].

    elevation : complex64 or complex128, m
    rate : its derivative in time, m/s, or None where it was not asked for
    """

    elevation: ComplexArray
    rate: ComplexArray | None


def turns(state: InitialState, time: float | Fraction, columns: slice = ALL) -> Array:
    """ωt/2π for ky from 0 to N/2, (columns, N//2+1), reduced to [-½, ½] in float64, so that single
    precision loses nothing afterwards; for all ky, (columns, N), where ω is not even in ky.

    In a loop, ω is a whole number of turns a loop and the time is reduced exactly: the end of the loop
    has the phases of its start to the bit.
    """
    rows = state.grid.resolution // 2 + 1 if state.mirrored else state.grid.resolution
    omega = state.omega.T[columns, :rows]
    if state.loop_duration is None:
        result = omega * (float(time) / (2.0 * np.pi))
    else:
        period = state.loop_duration
        turns_a_loop = np.rint(omega * (float(period) / (2.0 * np.pi)))
        result = turns_a_loop * float(Fraction(time) % period / period)
    result -= np.rint(result)
    return result


def propagate(
    state: InitialState,
    time: float | Fraction,
    dtype: type = np.complex64,
    with_rate: bool = False,
    columns: slice = ALL,
    scale: float = 1.0,
) -> PropagatedState:
    """ĥ(k, t) = h₊·exp(-iωt) + h₋·exp(+iωt), and its derivative in time, times `scale`, for some columns kx.

    The state's others are in the sum. Horvath (2015), § 7.1.2: waves along +k and along -k are separate;
    Chen (2014), eq. 9.
    """
    real = np.float32 if dtype is np.complex64 else np.float64
    angle = np.asarray(2.0 * np.pi * turns(state, time, columns), real)
    half: ComplexArray = np.empty(angle.shape, dtype)  # ω, and with it exp(iωt), is mostly even in ky
    np.cos(angle, out=half.real)
    np.sin(angle, out=half.imag)
    if scale != 1.0:
        half *= real(scale)
    turn = state.grid.mirror(half) if state.mirrored else half
    against = np.multiply(state.h_minus.T[columns].astype(dtype, copy=False), turn, out=np.empty_like(turn))
    along = np.conjugate(turn, out=turn)
    along *= state.h_plus.T[columns].astype(dtype, copy=False)
    rate = None
    if with_rate:
        rate = ((dtype(-1j) * state.omega.T[columns].astype(real)) * (along - against)).T
    # adding complex numbers as pairs of real ones takes half the time
    np.add(along.view(real), against.view(real), out=along.view(real))
    for other in state.others:
        moved = propagate(other, time, dtype, with_rate, columns, scale)
        along += moved.elevation.T
        if rate is not None and moved.rate is not None:
            rate += moved.rate
    return PropagatedState(along.T, rate)
