# SPDX-License-Identifier: GPL-3.0-or-later
"""Sums of the parts of a sea: on the samples of its tile, or at any places, including waves without a grid.

The tile is that of merged patches, or of waves under masks. The first patch has the samples of the tile; the
others are interpolated. Waves shorter than two samples of the tile are omitted, as they would alias to longer
ones.

A patch whose period does not fit the square is made periodic: along the far sides it blends into its
continuation before the near ones. Both have the same spectrum and are independent, so weights whose squares
add up to 1 preserve the variance.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..masks.noise import SeaTime
from ..masks.parameters import Mask
from ..masks.weights import Weights, move, unweighted, weighted, weights, weights_on_grid
from ..numerics.interpolation import Reader
from ..numerics.memo import MEMO, total_bytes
from ..numerics.threads import default_workers, row_blocks, run_blocks
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import Part
from ..synthesis.channels import CHANNELS, memory_groups
from .coast_waves import CoastWaves
from .part_waves import PartWaves
from .placed_waves import PlacedWaves
from .query import SurfacePoints, find_summed_points
from .sampling import (
    GRADIENT,
    Components,
    Geometry,
    Grid,
    Key,
    StrainFields,
    StrainGrid,
    Summed,
    closed,
)
from .surfaces import Field, summed_field, weighted_field

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: width of the blend at the far sides, in longest waves of the patch, and its maximum in sides of the square
_BORDER_WAVES, _WIDEST_BORDER = 2.0, 0.1

#: strains for the foam at places: with more than a quarter of the memory they would evict everything else
_STRAINS = "strains"
MEMO.limit(_STRAINS, 4)

#: positions of a tile's samples in other grids
_PLACES = "places of tiles"
MEMO.limit(_PLACES, 4)


class TileSum:
    """The (N, N) samples of a sea's tile, on which its parts are summed.

    parameters : of the sea
    parts : the summands
    dtype : of the fields
    workers : threads for interpolation, by default a suitable number
    """

    def __init__(
        self, parameters: OceanParameters, parts: Sequence[PartWaves], dtype: type, workers: int | None
    ) -> None:
        self._parts = parts
        self._samples = parameters.resolution
        self._side = parameters.domain_size
        self._loop_duration = parameters.loop_duration
        self._dtype = dtype
        self._workers = workers

    def fill(self, time: float | Fraction, wanted: frozenset[str], fields: Mapping[str, RealArray]) -> None:
        """Fill the arrays of all outputs except foam."""
        for group in memory_groups(wanted):
            needs = frozenset().union(*(CHANNELS[name].needs for name in group))
            sums: dict[Key, RealArray] = {}
            for waves in self._parts:
                self._add(waves, time, needs, sums)
            for name in group:
                CHANNELS[name].write(Summed([sums]), fields[name])

    def _add(
        self, waves: PartWaves, time: float | Fraction, needs: frozenset[Key], sums: dict[Key, RealArray]
    ) -> None:
        """Add the (N, N) components of a part to the sums."""
        wanted = needs if waves.is_on_tile else unweighted(closed(needs))
        masks = waves.part.masks
        if masks:
            wanted = unweighted(wanted, moves=move(masks))
        own = waves.components(time, wanted, closed=not waves.is_on_tile)
        if not waves.is_on_tile:
            own = self._read(own, waves.part, {} if masks else sums)
        if masks:
            when = SeaTime(time, self._loop_duration)
            own = weighted(own, weights_on_grid(masks, self._side, self._samples, self._dtype, when))
        for key, value in own.items():
            if key not in sums:
                sums[key] = value
            elif sums[key] is not value:
                sums[key] += value

    def _read(self, components: Components, part: Part, sums: dict[Key, RealArray]) -> dict[Key, RealArray]:
        """Interpolate a part in the sea's axes, made periodic with the square.

        If sums are given, it is added to them block by block, and they are returned.
        """
        n, side = self._samples, self._side
        grid = Grid(components, part.parameters.domain_size, part.rotation)
        border = min(_BORDER_WAVES * part.parameters.patches[0].longest_wavelength, _WIDEST_BORDER * side)
        where = (grid.geometry, side, n, border)
        places = MEMO.get(_PLACES, where, lambda: TilePlaces(*where))
        result = sums or {key: np.zeros((n, n), self._dtype) for key in components}

        def add(piece: Piece) -> None:
            for key, value in piece.read(grid).items():
                if key in result:
                    result[key][piece.rows, piece.columns] += value

        run_blocks(add, places.pieces, self._workers or default_workers(len(components) * n * n))
        return result


@dataclass(frozen=True)
class Piece:
    """A piece of a tile, and the readers of a grid there: one, or several with weights in the blend."""

    rows: slice
    columns: slice
    shape: tuple[int, int]
    readings: tuple[tuple[NDArray[np.bool_], Reader, Weights] | Reader, ...]

    def read(self, grid: Grid) -> dict[Key, RealArray]:
        """Components on the samples of this piece."""
        total: dict[Key, RealArray] = {}
        for reading in self.readings:
            if isinstance(reading, Reader):
                return {key: value.reshape(self.shape) for key, value in grid.read_by(reading).items()}
            there, reader, shares = reading
            for key, value in grid.read_by(reader, shares).items():
                total.setdefault(key, np.zeros(self.shape, value.dtype))[there] += value
        return total


class TilePlaces:
    """Positions of a tile's samples in another grid, which do not change in time.

    geometry : of the grid
    side, samples : of the tile, in m, and per side
    border : width of the blend at the far sides in m
    """

    def __init__(self, geometry: Geometry, side: float, samples: int, border: float) -> None:
        self._along = side / samples * np.arange(samples)
        self._geometry, self._side, self._border = geometry, side, border
        inner = int(np.searchsorted(self._along, side - border))
        within, beyond = slice(0, inner), slice(inner, samples)
        pieces = [self._piece(rows, within, False) for rows in row_blocks(inner, samples)]
        pieces += [self._piece(within, beyond, True), self._piece(beyond, slice(0, samples), True)]
        self.pieces = tuple(pieces)

    @property
    def nbytes(self) -> int:
        """Bytes of all readers and blend weights."""
        readings = [each for piece in self.pieces for each in piece.readings]
        parts = [(each,) if isinstance(each, Reader) else (each[0], each[1], *each[2]) for each in readings]
        return total_bytes(itertools.chain(*parts))

    def _piece(self, rows: slice, columns: slice, is_shared: bool) -> Piece:
        x, y = np.meshgrid(self._along[columns], self._along[rows])
        if not is_shared:
            reader = self._geometry.reader(x.ravel(), y.ravel())
            return Piece(rows, columns, x.shape, (reader,))
        readings = []
        along_x, along_y = (border_shares(place, self._side, self._border) for place in (x, y))
        for (share_x, slope_x, back_x), (share_y, slope_y, back_y) in itertools.product(along_x, along_y):
            there = (share_x > 0.0) & (share_y > 0.0)
            shares = (share_x * share_y, slope_x * share_y, share_x * slope_y)
            reader = self._geometry.reader(x[there] - back_x, y[there] - back_y)
            readings.append((there, reader, Weights(*(part[there] for part in shares))))
        return Piece(rows, columns, x.shape, tuple(readings))


def border_shares(place: Array, side: float, border: float) -> tuple[tuple[Array, Array, float], ...]:
    """Blend weights of a place and of the place one side before, their derivatives, and the side.

    The weights are cosine and sine of an angle that rises smoothly from 0 to a quarter turn within the
    border.
    """
    part = np.clip((place - (side - border)) / border, 0.0, 1.0)
    angle = 0.5 * np.pi * part * part * (3.0 - 2.0 * part)
    rate = 3.0 * np.pi * part * (1.0 - part) / border
    cosine, sine = np.cos(angle), np.sin(angle)
    return (cosine, -sine * rate, 0.0), (sine, cosine * rate, side)


class _AfloatWaves:
    """Waves of a layer without a grid over the bed of a coast: none on land."""

    def __init__(self, waves: PlacedWaves, coast: CoastWaves) -> None:
        self._waves, self._coast = waves, coast

    def at(self, x: Array, y: Array, time: float | Fraction, keys: Iterable[Key]) -> dict[Key, RealArray]:
        """Components of the displacement at flat arrays of rest positions in m."""
        return weighted(self._waves.at(x, y, time, unweighted(keys)), self._coast.afloat(x, y))

    def field(self, time: float | Fraction) -> Field:
        """The surface of these waves at a time."""
        return weighted_field(self._waves.field(time), self._coast.afloat)


class AnywhereSum:
    """The sum of a sea's waves at any rest positions, with interpolated parts.

    parameters, precision : of the sea
    parts, placed, coast : whose sum it is
    """

    def __init__(
        self,
        parameters: OceanParameters,
        parts: Sequence[PartWaves],
        placed: Sequence[PlacedWaves],
        precision: str,
        coast: CoastWaves | None = None,
    ) -> None:
        self._parameters = parameters
        self._parts = parts
        self._placed: Sequence[PlacedWaves | _AfloatWaves | CoastWaves] = (
            placed if coast is None else (*(_AfloatWaves(waves, coast) for waves in placed), coast)
        )
        self._coast = coast
        self._precision = precision

    def fill(
        self,
        x: Array,
        y: Array,
        time: float | Fraction,
        wanted: Iterable[str],
        fields: Mapping[str, RealArray],
    ) -> None:
        """Fill the arrays of outputs that do not depend on earlier times, at flat x and y in m."""
        needs = frozenset().union(*(CHANNELS[name].needs for name in wanted))
        sums = self._sums(x, y, time, needs, [self._grid(waves, time, needs) for waves in self._parts])
        for name in wanted:
            components = CHANNELS[name].components
            made: RealArray = np.empty((x.size, components) if components else x.size, fields[name].dtype)
            CHANNELS[name].write(sums, made)
            fields[name][...] = made.reshape(fields[name].shape)

    def compression_at(self, x: Array, y: Array, time: Fraction) -> RealArray:
        """(places,) float32 compression, negative where the surface is stretched.

        The strains are cached, because the next frame's foam needs them too, as may other seas of the same
        patches.
        """
        total, *others = self._strains_at(x, y, time)
        for strains in others:
            total.add(strains)
        return total.compression().astype(np.float32, copy=False)

    def _strains_at(self, x: Array, y: Array, time: Fraction) -> Iterator[StrainFields]:
        """Strains of each part, and of waves without a grid."""
        known: dict[tuple[Mask, ...], Weights] = {}
        for waves in self._parts:
            grid = self._strains(waves, time)
            if isinstance(grid, StrainGrid):
                yield grid.read(x, y)
            else:
                yield StrainFields.of(grid.read(x, y, self._weights(waves.part.masks, x, y, time, known)))
        for placed in self._placed:
            yield StrainFields.of(placed.at(x, y, time, GRADIENT))

    def _strains(self, waves: PartWaves, time: Fraction) -> Grid | StrainGrid:
        def make() -> Grid | StrainGrid:
            if self._is_weighted(waves):
                return self._grid(waves, time, GRADIENT)
            components = waves.components(time, GRADIENT, closed=True)
            return StrainGrid(components, waves.part.parameters.domain_size, waves.part.rotation)

        key = (waves.parameters, waves.part.rotation, self._is_weighted(waves), self._precision, time)
        return MEMO.get(_STRAINS, key, make)

    def exact_field(self, time: float | Fraction) -> Field:
        """The band-limited surface. Raises ValueError with trough damping and a coast: no sums of waves."""
        if self._coast is not None:
            raise ValueError("surface = 'exact': not available over the bed of a coast; use mesh")
        return summed_field([waves.exact_field(time) for waves in self._parts] + self._placed_fields(time))

    def points_above(
        self, x: ArrayLike, y: ArrayLike, time: float | Fraction, with_velocity: bool
    ) -> tuple[SurfacePoints, float]:
        """Points of the sum of the parts' bilinear surfaces, and the smallest sample spacing in m."""
        fields, reaches = zip(*(waves.mesh_field(time, with_velocity) for waves in self._parts), strict=True)
        if self._coast is not None:
            fields = tuple(weighted_field(field, self._coast.shares) for field in fields)
        spacings = [waves.part.spacing for waves in self._parts]
        finest, reach = min(spacings), sum(reaches)
        for waves in self._placed:
            moved = waves.at(np.ravel(x), np.ravel(y), time, ((0, ""), (1, "")))
            reach += float(np.max(np.hypot(moved[0, ""], moved[1, ""]), initial=0.0))
        placed = self._placed_fields(time)
        spacings += [finest] * len(placed)
        return find_summed_points(x, y, [*fields, *placed], spacings, reach, with_velocity), finest

    def _placed_fields(self, time: float | Fraction) -> list[Field]:
        return [waves.field(time) for waves in self._placed]

    def _grid(self, waves: PartWaves, time: float | Fraction, needs: Iterable[Key]) -> Grid:
        """The components of a part on its own samples."""
        wanted = closed(needs)
        if wanted and self._is_weighted(waves):
            wanted = unweighted(wanted, moves=move(waves.part.masks))
        components = waves.components(time, wanted, closed=True) if wanted else {}
        return Grid(components, waves.part.parameters.domain_size, waves.part.rotation)

    def _sums(
        self,
        x: Array,
        y: Array,
        time: float | Fraction,
        needs: Iterable[Key],
        grids: Sequence[Grid],
    ) -> Summed:
        known: dict[tuple[Mask, ...], Weights] = {}
        found = [
            grid.read(x, y, self._weights(waves.part.masks, x, y, time, known))
            for waves, grid in zip(self._parts, grids, strict=True)
        ]
        return Summed([*found, *(waves.at(x, y, time, needs) for waves in self._placed)])

    def _weights(
        self,
        masks: tuple[Mask, ...],
        x: Array,
        y: Array,
        time: float | Fraction,
        known: dict[tuple[Mask, ...], Weights],
    ) -> Weights | None:
        """What parts under some masks weigh at places, made once; None without masks and coast."""
        if self._coast is not None and masks not in known:
            known[masks] = self._coast.shares(x, y)
        elif masks and masks not in known:
            when = SeaTime(time, self._parameters.loop_duration)
            known[masks] = weights(masks, self._parameters.domain_size, x, y, when)
        return known.get(masks)

    def _is_weighted(self, waves: PartWaves) -> bool:
        return bool(waves.part.masks) or self._coast is not None
