# SPDX-License-Identifier: GPL-3.0-or-later
"""Inverse transforms in two passes, from Fourier coefficients to fields over the patch.

The position of the sample that rests at (x, y, 0) is (x, y, 0) + P with P = (λDx, λDy, h). Everything follows
from two scalar fields and their derivatives: the elevation h, and the potential Φ with Φ(k) = ĥ/|k|, whose
gradient is D. So D(k) = +i (k/|k|) ĥ, the transform of Chen (2014), eq. 11, with which points move towards
the crests and sharpen them for λ > 0 (Tessendorf's and Lantz's -i flattens them).

The first pass works on blocks of columns kx: it propagates the coefficients in time, multiplies by (i ky)ⁿ
and transforms along y. The second works on blocks of rows y: it multiplies by (i kx)ᵐ, which commutes with
the first transform, and transforms along x. Fields that differ only in m share a first pass.

The horizontal displacement of waves from a wind field is not a gradient. With such waves, λDx and λDy, each
with its own first pass, replace the potential, and h, λDx and λDy each hold the sum of both kinds of waves.
"""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ..numerics.memo import MEMO
from ..numerics.threads import default_workers, run_blocks
from ..parameters.ocean_parameters import OceanParameters
from ..waves.contribution import BlockShares, Shares, Sharing
from .coefficients import InitialState, PropagatedState, propagate
from .trough_damping import TroughDamping

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]

X, Y, Z = 0, 1, 2

#: complex numbers in the blocks processed at once in either pass, by all workers together: larger is faster,
# up to the size of a cache
_BLOCK = 2**17
#: lower limit of that, for grids so small that memory does not matter
_LEAST = 2**14

#: bytes per sample that a surface may use beyond its outputs, that a column uses, and of the temporaries for
# each number of a block
_MEMORY, _COLUMN, _TEMPORARIES = 24, 4, 50

#: padding between the rows of a block: without it, the elements of a column would compete for the same few
# cache lines during transposition
_PADDING = 8

_NUMPY_TRANSFORMS_IN_PLACE = int(np.__version__.partition(".")[0]) >= 2


#: contents of a column: h, Φ, λDx or λDy
ELEVATION, POTENTIAL, ALONG_X, ALONG_Y = range(4)


class Column(NamedTuple):
    """The input of a first pass: h, Φ, λDx or λDy, or a rate, of all or only the long waves, times (i
    ky)ⁿ."""

    source: int
    rate: bool
    long: bool
    y_order: int


class Term(NamedTuple):
    """A real field: a column times (i kx)ᵐ."""

    column: Column
    x_order: int


def term(component: int, derivative: str = "", long: bool = False, gradient: bool = True) -> Term:
    """The field of P[component] or of its derivative by "x", "y" or "t".

    gradient : whether the horizontal displacement is the gradient of Φ
    """
    rate, along_x, along_y = derivative == "t", derivative == "x", derivative == "y"
    if component == Z:
        return Term(Column(ELEVATION, rate, long, along_y), along_x)
    if not gradient:
        return Term(Column(ALONG_X if component == X else ALONG_Y, rate, long, along_y), along_x)
    return Term(Column(POTENTIAL, rate, long, along_y + (component == Y)), along_x + (component == X))


@dataclass(frozen=True)
class Synthesis:
    """Computes a sea's fields.

    state, parameters, damping : the sea
    dtype : complex64 or complex128
    workers : threads, None for a suitable number; the result does not depend on it
    sharing : waves whose horizontal displacement is not a gradient
    """

    state: InitialState
    parameters: OceanParameters
    damping: TroughDamping | None = None
    dtype: type = np.complex64
    workers: int | None = 1
    sharing: tuple[Sharing, ...] = ()

    @cached_property
    def terms(self) -> dict[tuple[int, str, bool], Term]:
        """The field of this sea's P[component] or of its derivative by "x", "y" or "t", of all waves or of
        the long ones.
        """
        keys = itertools.product((X, Y, Z), ("", "x", "y", "t"), (False, True))
        return {key: term(*key, gradient=not self.sharing) for key in keys}

    def x_factor(self, wanted: Term) -> ComplexArray | None:
        """(i kx)ᵐ of a field, (N//2+1,), times the choppiness λ if its column lacks it; None for 1."""
        is_of_potential = wanted.column.source == POTENTIAL and wanted.column.y_order == 0
        return self._factor(self.state.grid.kx[0], wanted.x_order, is_of_potential)

    def y_factor(self, column: Column) -> ComplexArray | None:
        """(i ky)ⁿ of a column, (N,), times the choppiness λ for derivatives of the potential."""
        return self._factor(self.state.grid.ky[:, 0], column.y_order, column.source == POTENTIAL)

    def _factor(self, wave_numbers: Array, order: int, is_of_potential: bool) -> ComplexArray | None:
        if order == 0:
            return None
        key = (len(wave_numbers), order, is_of_potential)
        if key not in self._factors:
            factor = (1j * wave_numbers) ** order
            if is_of_potential:
                factor *= self.parameters.choppiness
            self._factors[key] = factor.astype(self.dtype)
        return self._factors[key]

    @cached_property
    def _factors(self) -> dict[tuple[int, int, bool], ComplexArray]:
        """Factors computed so far, shared by all blocks of a surface."""
        return {}

    def columns(self, wanted: Iterable[tuple[int, str]]) -> list[Column]:
        """The columns needed for some components and derivatives."""
        return sorted({self.terms[key].column for key in self._with_long_waves(wanted)})

    def fill(
        self,
        time: float | Fraction,
        wanted: Iterable[tuple[int, str]],
        write: Callable[[slice, Rows], None],
        most: int = 0,
        count: int = 0,
    ) -> None:
        """Compute components and derivatives, and pass them to `write`, one block of rows at a time.

        most : columns of other parts of the same surface whose arrays are in memory meanwhile
        count : number of fields of the whole surface, from which the number of threads follows
        """
        wanted = frozenset(wanted)
        needed = self.columns(wanted)
        workers = self._threads(max(count, len(wanted)))
        shape = self.state.grid.shape
        # allocating memory takes time: each thread reuses its arrays
        own = (shape, self.dtype, threading.get_ident())
        arrays: ComplexArray | None = MEMO.take("workspaces", own)
        if arrays is None or len(arrays) < len(needed):
            arrays = np.empty((len(needed), *shape), self.dtype)
        first_pass = dict(zip(needed, arrays, strict=False))
        shares = self._shares(time, needed, workers)

        def transform_along_y(block: slice) -> None:
            self._transform_columns(time, block, first_pass, shares)

        def transform_along_x(block: slice) -> None:
            write(block, Rows(self, first_pass, block))

        n = self.state.grid.resolution
        most = max(most, len(needed))
        run_blocks(transform_along_y, self._blocks(n // 2 + 1, most, workers), workers)
        run_blocks(transform_along_x, self._blocks(n, most, workers), workers)
        MEMO.put("workspaces", own, arrays)

    def coefficients(self, time: float | Fraction, columns: Sequence[Column]) -> dict[Column, ComplexArray]:
        """Coefficients (N, N//2+1) of some columns at a time, before any transform, not scaled."""
        with_rate = any(column.rate for column in columns)
        shares = self._shares(time, columns, self._threads(len(columns)))
        added = [share.of_block(slice(None)) for share in shares]
        sources = _Sources(self, propagate(self.state, time, self.dtype, with_rate), slice(None), added)
        return {column: sources.coefficients(column).T for column in columns}

    def _threads(self, fields: int) -> int:
        return self.workers or default_workers(fields * self.state.grid.resolution**2)

    def _shares(self, time: float | Fraction, columns: Iterable[Column], workers: int) -> list[Shares]:
        """The contributions to some columns that are not a gradient."""
        rates = {column.rate for column in columns}
        return [
            waves.shares(float(time), False in rates, True in rates, self.dtype, workers)
            for waves in self.sharing
        ]

    def _with_long_waves(self, wanted: Iterable[tuple[int, str]]) -> set[tuple[int, str, bool]]:
        wanted = set(wanted)
        if self.damping is None:
            return {(*key, False) for key in wanted}
        # a damped derivative also needs the components and the derivative of the long waves' elevation
        wanted |= {(component, "") for component, _ in wanted} | {(Z, "")}
        wanted |= {(Z, derivative) for _, derivative in wanted}
        return {(*key, long) for key in wanted for long in (False, True)}

    def _blocks(self, count: int, columns: int, workers: int) -> Iterator[slice]:
        """Blocks of `count` rows or columns, for a workspace of this many columns."""
        n = self.state.grid.resolution
        spare = max(1, _MEMORY - _COLUMN * columns)
        numbers = min(_BLOCK, max(_LEAST, n * n * spare // _TEMPORARIES))
        if self.sharing:  # their memory is accounted for separately, and small blocks are slow
            numbers = _BLOCK
        size = max(1, numbers // workers // n)
        return (slice(first, min(first + size, count)) for first in range(0, count, size))

    def _transform_columns(
        self,
        time: float | Fraction,
        block: slice,
        first_pass: Mapping[Column, ComplexArray],
        shares: Sequence[Shares],
    ) -> None:
        """The first pass for some columns: transform to y, into the (N, N//2+1) arrays of the first pass."""
        with_rate = any(column.rate for column in first_pass)
        # each inverse transform divides by N, so the input is multiplied by N²
        scale = float(self.state.grid.resolution) ** 2
        moved = propagate(self.state, time, self.dtype, with_rate, block, scale)
        added = [share.of_block(block, scale) for share in shares]
        sources = _Sources(self, moved, block, added)
        for column, target in first_pass.items():
            coefficients = sources.coefficients(column)
            target[:, block] = _inverse(coefficients).T


class _Sources:
    """Coefficients of a block of columns, (columns, N), each computed once."""

    def __init__(
        self, synthesis: Synthesis, moved: PropagatedState, block: slice, added: Sequence[BlockShares]
    ) -> None:
        self._synthesis = synthesis
        self._block = block
        self._added = added
        self._elevations = {False: moved.elevation.T}
        if moved.rate is not None:
            self._elevations[True] = moved.rate.T
        self._bases: dict[Column, ComplexArray] = {}

    def coefficients(self, column: Column) -> ComplexArray:
        """h, Φ, λDx or λDy, or a rate, times (i ky)ⁿ."""
        base = self._base(column._replace(y_order=0))
        factor = self._synthesis.y_factor(column)
        return base if factor is None else base * factor

    def _base(self, column: Column) -> ComplexArray:
        if column not in self._bases:
            self._bases[column] = self._with_shares(column) if self._added else self._spectral(column)
        return self._bases[column]

    def _spectral(self, column: Column) -> ComplexArray:
        """h or Φ of spectral waves only."""
        base = self._elevations[column.rate]
        if column.source != ELEVATION:
            factor = self._synthesis.state.potential_factor.T[self._block]
            base = base * factor.astype(base.dtype, copy=False)
        damping = self._synthesis.damping
        if column.long and damping is not None:
            base = base * damping.long_waves.T[self._block].astype(base.dtype)
        return base

    def _with_shares(self, column: Column) -> ComplexArray:
        """h, λDx or λDy of spectral waves plus those that are not a gradient.

        The latter count as long waves, which trough damping leaves unchanged.
        """
        if column.source == ELEVATION:
            result = self._spectral(column).copy()
            for added in self._added:
                added.add(Z, column.rate, result)
            return result
        potential = column._replace(source=POTENTIAL)
        if potential not in self._bases:
            self._bases[potential] = self._spectral(potential)
        choppiness = self._synthesis.parameters.choppiness
        grid = self._synthesis.state.grid
        east = column.source == ALONG_X
        along = grid.kx[0, self._block, np.newaxis] if east else grid.ky[:, 0]
        result = self._bases[potential] * (1j * choppiness * along).astype(self._synthesis.dtype)
        for added in self._added:
            added.add(X if east else Y, column.rate, result, choppiness)
        return result


class PositionRows(Protocol):
    """Provides components of the displacement and their derivatives, each as one array."""

    def position(self, component: int, derivative: str = "", out: RealArray | None = None) -> RealArray:
        """P[component] in m or its derivative by "x", "y" (m/m) or "t" (m/s); in `out` if given."""


class Rows:
    """Real fields on a block of rows, each transformed once, on first use."""

    def __init__(self, synthesis: Synthesis, first_pass: Mapping[Column, ComplexArray], block: slice) -> None:
        self._synthesis = synthesis
        self._first_pass = first_pass
        self._block = block
        self._made: dict[Term, RealArray] = {}

    def position(self, component: int, derivative: str = "", out: RealArray | None = None) -> RealArray:
        """(rows, N) P[component] in m or its derivative by "x", "y" (m/m) or "t" (m/s); in `out` if given."""
        terms, damping = self._synthesis.terms, self._synthesis.damping
        if damping is None:
            return self._transform(terms[component, derivative, False], out)
        everything = self._transform(terms[component, derivative, False])
        long_waves = self._transform(terms[component, derivative, True])
        weight, slope = damping.weight(self._transform(terms[Z, "", True]))
        result = long_waves + weight * (everything - long_waves)
        if derivative:
            short = self._transform(terms[component, "", False]) - self._transform(terms[component, "", True])
            result += slope * self._transform(terms[Z, derivative, True]) * short
        if out is not None:
            out[...] = result
        return result

    def _transform(self, wanted: Term, out: RealArray | None = None) -> RealArray:
        if wanted in self._made:
            if out is None:
                return self._made[wanted]
            out[...] = self._made[wanted]
            return out
        coefficients = self._first_pass[wanted.column][self._block]
        factor = self._synthesis.x_factor(wanted)
        if factor is not None:
            coefficients = coefficients * factor
        self._made[wanted] = _inverse_real(coefficients, out)
        return self._made[wanted]


def _inverse(coefficients: ComplexArray) -> ComplexArray:
    """Inverse transform along the last axis, divided by N, in the precision of the coefficients.

    NumPy before 2.0 transforms in double precision only; the result is rounded when it is stored.
    """
    if not _NUMPY_TRANSFORMS_IN_PLACE:
        return np.fft.ifft(coefficients, axis=-1)
    rows, n = coefficients.shape
    padded = np.empty((rows, n + _PADDING), coefficients.dtype)
    return np.fft.ifft(coefficients, axis=-1, out=padded[:, :n])


def _inverse_real(coefficients: ComplexArray, out: RealArray | None) -> RealArray:
    """Inverse real transform along the last axis, divided by N, in the precision of the coefficients."""
    if out is None:
        rows, columns = coefficients.shape
        out = np.empty((rows, 2 * (columns - 1)), coefficients.real.dtype)
    if _NUMPY_TRANSFORMS_IN_PLACE:
        np.fft.irfft(coefficients, axis=-1, out=out)
    else:
        out[...] = np.fft.irfft(coefficients, axis=-1)
    return out
