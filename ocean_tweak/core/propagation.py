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


@dataclass(frozen=True)
class PropagatedState:
    """Coefficients at one time.

    elevation : (N, N//2+1) complex64 or complex128, m
    rate : its derivative in time, m/s, or None where it was not asked for
    """

    elevation: ComplexArray
    rate: ComplexArray | None


def phase(state: InitialState, time: float | Fraction) -> Array:
    """ωt reduced to [-π, π] in float64, so that single precision loses nothing afterwards.

    In a loop, ω is a whole number of turns a loop and the time is reduced exactly: the end of the loop
    has the phases of its start to the bit.
    """
    if state.loop_duration is None:
        turns = state.omega * (float(time) / (2.0 * np.pi))
    else:
        period = state.loop_duration
        turns_a_loop = np.rint(state.omega * (float(period) / (2.0 * np.pi)))
        turns = turns_a_loop * float(Fraction(time) % period / period)
    turns -= np.rint(turns)
    turns *= 2.0 * np.pi
    return turns


def propagate(
    state: InitialState, time: float | Fraction, dtype: type = np.complex64, with_rate: bool = False
) -> PropagatedState:
    """ĥ(k, t) = h₊·exp(-iωt) + h₋·exp(+iωt), and its derivative in time.

    Horvath (2015), § 7.1.2: waves along +k and along -k are separate; Chen (2014), eq. 9.
    """
    real = np.float32 if dtype is np.complex64 else np.float64
    angle = phase(state, time).astype(real, copy=False)
    turn: ComplexArray = np.empty(angle.shape, dtype)
    turn.real, turn.imag = np.cos(angle), np.sin(angle)
    along = state.h_plus.astype(dtype, copy=False) * turn.conj()
    against = state.h_minus.astype(dtype, copy=False) * turn
    rate = dtype(-1j) * state.omega.astype(real) * (along - against) if with_rate else None
    return PropagatedState(along + against, rate)
