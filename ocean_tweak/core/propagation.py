# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea's Fourier coefficients at a time, from the initial state alone: any frame, in any order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .initial_state import InitialState


def phase(omega: NDArray[np.float64], time: float) -> NDArray[np.float64]:
    """ωt reduced to [-π, π] in float64, so that single precision loses nothing afterwards."""
    turns = omega * (time / (2.0 * np.pi))
    turns -= np.rint(turns)
    turns *= 2.0 * np.pi
    return turns


def propagate(state: InitialState, time: float, dtype: type = np.complex64) -> NDArray[np.complexfloating]:
    """ĥ(k, t) = h₊·exp(-iωt) + h₋·exp(+iωt), (N, N//2+1) of dtype, m.

    Horvath (2015), § 7.1.2: waves along +k and along -k are separate; Chen (2014), eq. 9.
    """
    real = np.float32 if dtype is np.complex64 else np.float64
    angle = phase(state.omega, time).astype(real, copy=False)
    turn = np.empty(angle.shape, dtype)
    turn.real, turn.imag = np.cos(angle), np.sin(angle)
    forward = state.h_plus.astype(dtype, copy=False) * turn.conj()
    return forward + state.h_minus.astype(dtype, copy=False) * turn  # type: ignore[no-any-return]
