# SPDX-License-Identifier: GPL-3.0-or-later
"""The wave vectors of a periodic square patch, in the layout of a real FFT."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: modes in a block of columns: a few such arrays fill the level-2 cache
_BLOCK_MODES = 2**17


@dataclass(frozen=True)
class WaveVectorGrid:
    """Wave vectors 2π/L · (j, i) of an N x N patch with side L metres, in FFT order.

    Arrays are [ky, kx] with shape (N, N//2+1), the half plane kx ≥ 0 of `numpy.fft.rfft2`; the other
    half is its point reflection. Mean and Nyquist modes are not waves: see `usable`.
    """

    resolution: int
    domain_size: float

    @property
    def spacing(self) -> float:
        """Δk = 2π/L, rad/m."""
        return 2.0 * np.pi / self.domain_size

    @property
    def cell_area(self) -> float:
        """Δkx Δky, rad²/m²."""
        return self.spacing**2

    @property
    def shape(self) -> tuple[int, int]:
        """(N, N//2+1), of arrays over the half plane."""
        return self.resolution, self.resolution // 2 + 1

    @cached_property
    def kx(self) -> Array:
        """(1, N//2+1) rad/m, ascending from 0."""
        return (self.spacing * np.arange(self.resolution // 2 + 1, dtype=np.float64))[np.newaxis, :]

    @cached_property
    def ky(self) -> Array:
        """(N, 1) rad/m in FFT order: 0, Δk, …, -N/2 Δk, …, -Δk."""
        n = self.resolution
        index = np.arange(n, dtype=np.float64)
        return (self.spacing * np.where(index < n // 2, index, index - n))[:, np.newaxis]

    @property
    def k(self) -> Array:
        """(N, N//2+1) rad/m, the wave numbers; recomputed on each access, so that cached grids stay small."""
        return np.hypot(self.kx, self.ky)

    @property
    def usable(self) -> NDArray[np.bool_]:
        """(N, N//2+1) bool: all modes except the mean and those at Nyquist; recomputed on each access."""
        mask = np.ones(self.shape, bool)
        mask[0, 0] = False
        mask[:, -1] = False
        mask[self.resolution // 2, :] = False
        return mask

    @cached_property
    def multiplicity(self) -> Array:
        """(1, N//2+1): number of modes of the full plane that each column represents, 1 or 2."""
        weight = np.full(self.resolution // 2 + 1, 2.0)
        weight[0] = weight[-1] = 1.0
        return weight[np.newaxis, :]

    def column_blocks(self) -> Iterator[slice]:
        """The columns in blocks that fit into the processor's cache."""
        width = max(1, _BLOCK_MODES // self.resolution)
        for first in range(0, self.resolution // 2 + 1, width):
            yield slice(first, min(first + width, self.resolution // 2 + 1))

    def mirror(self, half: NDArray[Any]) -> NDArray[Any]:
        """(…, N) values of an even function at all ky in FFT order, from its (…, N//2+1) values at 0 …
        N/2."""
        n = self.resolution
        full = np.empty((*half.shape[:-1], n), half.dtype)
        full[..., : n // 2 + 1] = half
        full[..., n // 2 + 1 :] = half[..., n // 2 - 1 : 0 : -1]
        return full
