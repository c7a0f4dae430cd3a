# SPDX-License-Identifier: GPL-3.0-or-later
"""Directional distributions from a buoy's four moments per frequency.

A buoy measures a₁ + ib₁ = ∫D e^{iθ} dθ and a₂ + ib₂ = ∫D e^{2iθ} dθ. Of all densities D with these moments,
the one of maximum entropy is nowhere negative and adds no structure beyond them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

#: largest length of the moments, still distinguishable from waves of a single direction
_LONGEST = 0.999


def feasible(moments: ArrayLike) -> Array:
    """The nearest feasible moments, (…, 4): a₁, b₁, a₂, b₂.

    Noise can cause moments that no distribution has. It has |c₁| < 1 and |c₂ - c₁²| < 1 - |c₁|² (Toeplitz's
    condition); if that fails, c₂ is moved towards c₁².

    Examples
    --------
    >>> feasible([0.5, 0.0, 0.25, 0.0])
    array([0.5 , 0.  , 0.25, 0.  ])
    """
    first, second = _complex(moments)
    first = first * np.minimum(1.0, _LONGEST / np.maximum(np.abs(first), 1e-12))
    most = _LONGEST * (1.0 - np.abs(first) ** 2)
    beyond = second - first**2
    second = first**2 + beyond * np.minimum(1.0, most / np.maximum(np.abs(beyond), 1e-12))
    return np.stack([first.real, first.imag, second.real, second.imag], axis=-1)


def maximum_entropy(moments: ArrayLike, theta: ArrayLike) -> Array:
    """D of maximum entropy in 1/rad at directions in rad. Lygre & Krogstad (1986), eq. 13.

    moments : (…, 4) a₁, b₁, a₂, b₂, feasible
    theta : (directions,) rad, evenly spaced over the circle, at most 1° apart, to integrate narrow peaks

    Returns (…, directions), with a mean of 1/2π exactly.

    Examples
    --------
    >>> maximum_entropy([0.0, 0.0, 0.0, 0.0], np.linspace(0.0, 6.0, 3)).round(4)
    array([0.1592, 0.1592, 0.1592])
    """
    first, second = (part[..., np.newaxis] for part in _complex(moments))
    p1 = (first - second * np.conj(first)) / (1.0 - np.abs(first) ** 2)
    p2 = second - first * p1
    turn = np.exp(-1j * np.asarray(theta, np.float64))
    power = (1.0 - p1 * np.conj(first) - p2 * np.conj(second)).real
    density = power / np.abs(1.0 - p1 * turn - p2 * turn**2) ** 2
    return density / (2.0 * np.pi * np.mean(density, axis=-1, keepdims=True))


def _complex(moments: ArrayLike) -> tuple[ComplexArray, ComplexArray]:
    m = np.asarray(moments, np.float64)
    return m[..., 0] + 1j * m[..., 1], m[..., 2] + 1j * m[..., 3]
