# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields over the patch, from the sea's Fourier coefficients."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from .grid import WaveVectorGrid

OUTPUTS = ("displacement",)


class SurfaceFields:
    """Fields of one instant on the (N, N) samples [y, x]; only those asked for exist.

    displacement : (N, N, 3) m: what is added to the rest position (x, y, 0), choppiness applied
    """

    def __init__(self, time: float, fields: dict[str, NDArray[np.floating]]) -> None:
        self.time = time
        self._fields = fields

    def __getattr__(self, name: str) -> NDArray[np.floating]:
        if name in OUTPUTS:
            try:
                return self.__dict__["_fields"][name]  # type: ignore[no-any-return]
            except KeyError:
                made = ", ".join(sorted(self.__dict__.get("_fields", ()))) or "nothing"
                raise AttributeError(
                    f"{name} was not computed (only {made}): ask for it with surface(time, outputs={{'{name}'}})"
                ) from None
        raise AttributeError(f"surface fields have no {name!r}: known are {', '.join(OUTPUTS)}")


def checked_outputs(outputs: Iterable[str]) -> frozenset[str]:
    """The wanted outputs as a set. Raises ValueError for a name that is not known."""
    wanted = frozenset((outputs,) if isinstance(outputs, str) else outputs)
    unknown = sorted(wanted - set(OUTPUTS))
    if unknown:
        raise ValueError(f"outputs = {unknown[0]!r}: must be among {', '.join(OUTPUTS)}")
    return wanted


def inverse_transform(coefficients: NDArray[np.complexfloating]) -> NDArray[np.floating]:
    """(N, N) real field Σ ĥ(k) exp(ik·x) of a half plane of coefficients, in their precision.

    NumPy before 2.0 transforms in double precision only; the result is rounded back.
    """
    n = coefficients.shape[0]
    real = np.float32 if coefficients.dtype == np.complex64 else np.float64
    return np.fft.irfft2(coefficients, s=(n, n)).astype(real, copy=False) * real(n * n)


def displacement(
    coefficients: NDArray[np.complexfloating], grid: WaveVectorGrid, choppiness: float
) -> NDArray[np.floating]:
    """(N, N, 3) m: (λDx, λDy, h) with D(k) = +i (k/|k|) ĥ.

    The transform of Chen (2014), eq. 11: points move towards the crests and sharpen them for λ > 0
    (Tessendorf's and Lantz's -i flattens them).
    """
    elevation = inverse_transform(coefficients)
    result = np.empty((*elevation.shape, 3), elevation.dtype)
    result[..., 2] = elevation
    along = coefficients * coefficients.dtype.type(1j * choppiness)
    k = np.where(grid.k > 0.0, grid.k, 1.0)
    result[..., 0] = inverse_transform(along * (grid.kx / k).astype(elevation.dtype))
    result[..., 1] = inverse_transform(along * (grid.ky / k).astype(elevation.dtype))
    return result
