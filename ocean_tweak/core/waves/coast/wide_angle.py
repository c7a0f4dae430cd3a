# SPDX-License-Identifier: GPL-3.0-or-later
"""A step of the march for waves along y: those of small ky alone, on as few samples as hold them."""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating]

#: terms of the exponential's series, and of a term over the waves: float32 holds no less, were all rows to
#: add up
_ORDER, _FAINTEST = 3, 1e-10
#: of z⁰ to z⁵ in the numerator of Padé's approximant to e^z of the order 6/6, in which that of z⁶ is 1
_PADE = (665280.0, 332640.0, 75600.0, 10080.0, 840.0, 42.0)
#: lengths of which transforms are quick
_QUICK = sorted(2**a * b for a in range(2, 40) for b in (4, 5, 6, 7))

_Number = TypeVar("_Number", np.float64, np.complexfloating)


class Band:
    """Of waves along y those of small ky, in the transform's order: there are seldom others.

    columns : samples along y
    ky : (waves, columns) rad/m of all, and then of those in the band
    highest : rad/m, of those in the band
    """

    def __init__(self, ky: Array, highest: float) -> None:
        columns = ky.shape[1]
        # ky begins within half a step of 0
        side = math.ceil(highest / float(ky[0, 1] - ky[0, 0])) + 1
        # as many samples hold all that products with a field make of waves in the band again
        enough = next(count for count in _QUICK if count > 4 * side)
        self.is_all = enough >= columns
        self._columns, self._side, self.samples = columns, side, columns if self.is_all else enough
        self.ky = self.of(ky)

    def of(self, waves: NDArray[_Number]) -> NDArray[_Number]:
        """Those in the band, of all."""
        return waves if self.is_all else np.concatenate((waves[:, : self._side], waves[:, -self._side :]), 1)

    def whole(self, waves: ComplexArray) -> ComplexArray:
        """All waves on the columns: 0 beyond the band."""
        return self._filled(waves, self._columns)

    def fields(self, waves: ComplexArray) -> ComplexArray:
        """On as many samples as hold the band."""
        return np.fft.ifft(self._filled(waves, self.samples))

    def waves(self, fields: ComplexArray) -> ComplexArray:
        """In the band, of fields on as many samples as hold it."""
        return self.of(np.fft.fft(fields))

    def factor(self, field: Array) -> Array:
        """What a field on the columns is for products with waves in the band."""
        if self.is_all:
            return field
        kept = np.fft.rfft(field)[:, : 2 * self._side]
        result: Array = np.fft.irfft(kept, self.samples) * (self.samples / self._columns)
        return result

    def _filled(self, waves: ComplexArray, samples: int) -> ComplexArray:
        if self.is_all:
            return waves
        result = np.zeros((len(waves), samples), waves.dtype)
        result[:, : self._side], result[:, -self._side :] = waves[:, : self._side], waves[:, self._side :]
        return result


def squares(field: ComplexArray) -> Array:
    """|field|²."""
    result: Array = np.square(field.real)
    result += np.square(field.imag)
    return result


def turned(angle: Array) -> ComplexArray:
    """e^(i angle) of angles up to 0.6, to 1e-15, by Padé's approximant: the machine's sine and
    cosine take twice as long.
    """
    square = angle * angle
    even = ((-square + _PADE[4]) * square - _PADE[2]) * square + _PADE[0]
    odd = ((_PADE[5] * square - _PADE[3]) * square + _PADE[1]) * angle
    half: ComplexArray = np.empty(angle.shape, np.complex128)
    half.real, half.imag = even, odd
    half *= half
    even *= even
    odd *= odd
    even += odd
    half *= 1.0 / even
    return half


def series(waves: ComplexArray, band: Band, d: Array, first: Array, second: Array, dx: float) -> ComplexArray:
    """exp(i Δx D) of waves along y, D being the symmetric products of δk with first and δk² with second, of
    which no wave leaves the band.

    Terms are added as long as they are more than the pictures' numbers can hold.
    """
    total, term = waves, waves
    d, d2 = band.factor(d), band.factor(d * d)
    least = _FAINTEST * _length(waves)
    for n in range(1, _ORDER + 1):
        here, leaning, leaning2 = (band.fields(each) for each in (term, first * term, second * term))
        leaning *= d
        leaning2 *= d2
        leaning += leaning2
        out = band.waves(leaning)
        out += first * band.waves(d * here)
        out += second * band.waves(d2 * here)
        out *= 0.5j * dx / n
        total = total + out
        if _length(out) < least:
            break
        term = out
    return total


def _length(waves: ComplexArray) -> float:
    """Of the waves' numbers as one vector."""
    return float(np.linalg.norm(waves.view(np.float64)))
