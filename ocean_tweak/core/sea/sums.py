# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of a sea added up: on the samples of its one tile, or anywhere, where waves on no grid add to them.

The tile is that of patches that are merged, or of waves under masks. The first patch's own samples are the
tile's; the others are read between theirs. Waves shorter than two samples of the tile are left out, or they
would show as longer ones.

A patch that does not fit the square is made to repeat with it: along the far sides it goes over into what
lies before the near ones. Both are of the same spectrum and independent, so shares whose squares add up to 1
keep the variance.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..masks.noise import SeaTime
from ..masks.parameters import Mask
from ..masks.weights import Weights, move, weights, weights_on_grid
from ..numerics.memo import MEMO
from ..numerics.threads import default_workers
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import Part
from ..synthesis.channels import CHANNELS, memory_groups
from .part_waves import PartWaves
from .placed_waves import PlacedWaves
from .query import SurfacePoints, find_summed_points
from .sampling import Components, Grid, Key, Summed, closed, unweighted, weighted
from .surfaces import Field, summed_field

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: rows of the grid that are read at once between the samples of another
_ROWS = 64

#: width in which a patch goes over at the far sides: in its longest waves, and in sides of the square at most
_BORDER_WAVES, _WIDEST_BORDER = 2.0, 0.1

#: what the foam of places looks back at: with more than a quarter of the memory it would push out all else
_STRAINS = "strains"
MEMO.limit(_STRAINS, 4)


class TileSum:
    """The (N, N) samples of a sea's one tile, on which its parts are added up.

    parameters : of the sea
    parts : whose sum it is
    dtype : of the fields' numbers
    workers : threads that read between samples, by default as many as help
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
        """Fill the arrays of all outputs but foam."""
        for group in memory_groups(wanted):
            needs = frozenset().union(*(CHANNELS[name].needs for name in group))
            sums = Summed(self._of_part(waves, time, needs) for waves in self._parts)
            for name in group:
                CHANNELS[name].write(sums, fields[name])

    def _of_part(
        self, waves: PartWaves, time: float | Fraction, needs: frozenset[Key]
    ) -> dict[Key, RealArray]:
        """The (N, N) components of a part."""
        wanted = needs if waves.is_on_tile else unweighted(closed(needs))
        masks = waves.part.masks
        if masks:
            wanted = unweighted(wanted, moves=move(masks))
        components = waves.components(time, wanted, closed=not waves.is_on_tile)
        on_tile = components if waves.is_on_tile else self._read(components, waves.part)
        if not masks:
            return weighted(on_tile, None)
        when = SeaTime(time, self._loop_duration)
        found = weights_on_grid(masks, self._side, self._samples, self._dtype, when)
        return weighted(on_tile, found)

    def _read(self, components: Components, part: Part) -> dict[Key, RealArray]:
        """A part between its samples, in the sea's axes, made to repeat with the square."""
        n, side = self._samples, self._side
        longest = part.parameters.patches[0].longest_wavelength
        border = min(_BORDER_WAVES * longest, _WIDEST_BORDER * side)
        grid = Grid(components, part.parameters.domain_size, part.rotation)
        result: dict[Key, RealArray] = {key: np.empty((n, n), self._dtype) for key in components}
        along = side / n * np.arange(n)
        inner = int(np.searchsorted(along, side - border))

        def fill(rows: slice, columns: slice, within: bool) -> None:
            x, y = (place.ravel() for place in np.meshgrid(along[columns], along[rows]))
            found = grid.read(x, y) if within else _repeating(grid, x, y, side, border)
            for key, value in found.items():
                result[key][rows, columns] = value.reshape(result[key][rows, columns].shape)

        blocks = [slice(first, min(first + _ROWS, inner)) for first in range(0, inner, _ROWS)]
        beyond = slice(inner, n)
        areas = [(rows, slice(0, inner), True) for rows in blocks]
        areas += [(slice(0, inner), beyond, False), (beyond, slice(0, n), False)]
        workers = self._workers or default_workers(len(result) * n * n)
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(lambda area: fill(*area), areas))
        return result


def _repeating(grid: Grid, x: Array, y: Array, side: float, border: float) -> dict[Key, RealArray]:
    """A grid at places in a square, near whose far sides it goes over into what lies before the near ones."""
    along_x, along_y = border_shares(x, side, border), border_shares(y, side, border)
    total: dict[Key, RealArray] = {}
    for share_x, slope_x, back_x in along_x:
        for share_y, slope_y, back_y in along_y:
            there = (share_x > 0.0) & (share_y > 0.0)
            shares = Weights(share_x * share_y, slope_x * share_y, share_x * slope_y)
            inside = Weights(shares.value[there], shares.by_x[there], shares.by_y[there])
            for key, value in grid.read(x[there] - back_x, y[there] - back_y, inside).items():
                if key not in total:
                    total[key] = np.zeros(x.shape, value.dtype)
                total[key][there] += value
    return total


def border_shares(place: Array, side: float, border: float) -> tuple[tuple[Array, Array, float], ...]:
    """How much counts of what is there and of what is a side before, the derivative of that, and the side.

    Shares are cosine and sine of an angle that rises smoothly from 0 to a quarter turn within the border.
    """
    part = np.clip((place - (side - border)) / border, 0.0, 1.0)
    angle = 0.5 * np.pi * part * part * (3.0 - 2.0 * part)
    rate = 3.0 * np.pi * part * (1.0 - part) / border
    cosine, sine = np.cos(angle), np.sin(angle)
    return (cosine, -sine * rate, 0.0), (sine, cosine * rate, side)


class AnywhereSum:
    """The sum of a sea's waves at any rest positions: parts are read between their samples.

    parameters, precision : of the sea
    parts, placed : whose sum it is
    """

    def __init__(
        self,
        parameters: OceanParameters,
        parts: Sequence[PartWaves],
        placed: Sequence[PlacedWaves],
        precision: str,
    ) -> None:
        self._parameters = parameters
        self._parts = parts
        self._placed = placed
        self._precision = precision

    def fill(
        self,
        x: Array,
        y: Array,
        time: float | Fraction,
        wanted: Iterable[str],
        fields: Mapping[str, RealArray],
    ) -> None:
        """Fill the arrays of outputs that have no memory, whose first axes hold the flat x and y in m."""
        needs = frozenset().union(*(CHANNELS[name].needs for name in wanted))
        sums = self._sums(x, y, time, needs, [self._grid(waves, time, needs) for waves in self._parts])
        for name in wanted:
            components = CHANNELS[name].components
            made: RealArray = np.empty((x.size, components) if components else x.size, fields[name].dtype)
            CHANNELS[name].write(sums, made)
            fields[name][...] = made.reshape(fields[name].shape)

    def compression_at(self, x: Array, y: Array, time: Fraction) -> RealArray:
        """(places,) float32 compression, below 0 where the surface is stretched.

        The strains it is made of are remembered, for the next frame's foam looks back at them too, and so
        may other seas of the same patches.
        """
        channel = CHANNELS["min_eigenvalue"]
        left = np.empty(x.shape, np.float32)
        grids = [self._strains(waves, time, channel.needs) for waves in self._parts]
        channel.write(self._sums(x, y, time, channel.needs, grids), left)
        return np.subtract(1.0, left, out=left)

    def _strains(self, waves: PartWaves, time: Fraction, needs: Iterable[Key]) -> Grid:
        key = (waves.parameters, waves.part.rotation, bool(waves.part.masks), self._precision, time)
        return MEMO.get(_STRAINS, key, lambda: self._grid(waves, time, needs))

    def exact_field(self, time: float | Fraction) -> Field:
        """The band-limited surface. Raises ValueError with trough damping, which leaves no sum of waves."""
        return summed_field([waves.exact_field(time) for waves in self._parts] + self._placed_fields(time))

    def points_above(
        self, x: ArrayLike, y: ArrayLike, time: float | Fraction, with_velocity: bool
    ) -> tuple[SurfacePoints, float]:
        """Points of the sum of the parts' bilinear surfaces, and the fewest metres between samples."""
        fields, reaches = zip(*(waves.mesh_field(time, with_velocity) for waves in self._parts), strict=True)
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
        """What is read of a part: its components on its own samples."""
        wanted = closed(needs)
        if wanted and waves.part.masks:
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
        when = SeaTime(time, self._parameters.loop_duration)
        found = []
        for waves, grid in zip(self._parts, grids, strict=True):
            part = waves.part
            if part.masks and part.masks not in known:
                known[part.masks] = weights(part.masks, self._parameters.domain_size, x, y, when)
            found.append(grid.read(x, y, known.get(part.masks)))
        return Summed([*found, *(waves.at(x, y, time, needs) for waves in self._placed)])
