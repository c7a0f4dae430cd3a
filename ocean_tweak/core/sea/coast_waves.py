# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea's waves over its bed, which replace those of the open sea.

With W the weight of the coast, 0 in the open sea, and L the factor by which depth limits waves that do not
follow the bed, the sea is

    (1 - W + W L) · all waves of the open sea  +  W · the pictures' waves  -  W L · the open sea's long waves

The first factor is a weight for all patches, like a mask; the rest are added like the waves of a layer that
does not repeat. Where W is 0, nothing is added and the first factor is 1.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..masks.weights import Weights, unweighted, weighted
from ..numerics.interpolation import Between, smoothstep
from ..numerics.memo import MEMO, total_bytes
from ..parameters.ocean_parameters import OceanParameters
from ..statistics.sea_spectrum import SeaSpectrum
from ..statistics.sea_statistics import continuous_state
from ..synthesis.transforms import Synthesis, Z
from ..waves.coast.breakers import breaker_spray, broken_share
from ..waves.coast.ground import Ground
from ..waves.contribution import OwnFoam, OwnSpray
from .coast_field import OverBed
from .coast_pictures import Incoming, Pictures, fingerprint, incoming, pictures
from .coast_state import StateFields, flow_over_bed, open_state, turned_by
from .coast_swash import Swash
from .memory import check_coast_memory
from .part_waves import PartWaves, components, real_type
from .placed_waves import ADDED, adding_fields, as_field
from .sampling import Grid, Key, Summed, closed, turned
from .surfaces import Field

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: of waves that break for lack of depth, significant height over depth: √2 · 0.42
_LARGEST = 0.6

#: m, over which it is told how high the long waves around a place are, and how steep the foreshore is
_AROUND, _FORESHORE = 12.0, 5.0

#: m, depth from which waves of objects are whole
_AFLOAT = 1.0

_PICTURES = "pictures of coasts"
_FIELDS = "fields of coasts"
MEMO.limit(_FIELDS, 4)


class CoastWaves:
    """The waves over the bed of a sea, in the sea's axes.

    sea : which has a coast
    parts : all of its waves, those of the first patch first
    """

    def __init__(self, sea: OceanParameters, parts: Sequence[PartWaves]) -> None:
        assert sea.coast is not None
        self._sea, self._parts, self._waves = sea, parts, parts[0]
        self._pictures: Pictures | None = None
        waves, first = self._waves, self._waves.parameters
        self.ground = Ground.of(
            sea.coast, first.domain_size, first.resolution, waves.part.rotation, sea.water.depth
        )

    @cached_property
    def incoming(self) -> Incoming:
        """The long waves that run ashore."""
        return incoming(self._sea, self._waves.initial_state, self.ground)

    @property
    def pictures(self) -> Pictures:
        """What becomes of them; made once, whatever acts after the waves are drawn."""
        return self.make()

    @property
    def is_made(self) -> bool:
        """Whether the pictures are at hand, so that fields are quickly made."""
        return self._pictures is not None or MEMO.find(_PICTURES, self._made_of) is not None

    def make(self, tell: Callable[[float], None] = lambda done: None) -> Pictures:
        """The pictures, where they are not at hand from the shelf or computed.

        tell : is told again and again which share is computed; what it raises ends that

        Raises MemoryError if the machine has too little memory.
        """
        if self._pictures is None:
            self._pictures = MEMO.get(_PICTURES, self._made_of, lambda: self._found_or_made(tell))
        return self._pictures

    @property
    def _made_of(self) -> tuple[OceanParameters, Ground, str]:
        return self._waves.drawn_from, self.ground, self._waves.precision

    def _found_or_made(self, tell: Callable[[float], None]) -> Pictures:
        check_coast_memory(self._sea)
        shelf, name = MEMO.shelf, fingerprint(self._sea, self.incoming, self.ground)
        found = None if shelf is None else shelf.find(name)
        if found is not None:
            return Pictures(*found)
        made = pictures(self._sea, self.incoming, self.ground, tell)
        if shelf is not None:
            shelf.keep(name, (made.numbers, made.elevation, made.potential))
        return made

    def shares(self, x: Array, y: Array) -> Weights:
        """Of the open sea, at places in m."""
        return self._weights.read(0, self.ground.between(x, y))

    def afloat(self, x: Array, y: Array) -> Weights:
        """Of waves that come from elsewhere, as wakes do, at places in m: 0 on land."""
        return self._afloat.read(0, self.ground.between(x, y))

    def at(self, x: Array, y: Array, time: float | Fraction, keys: Iterable[Key]) -> dict[Key, RealArray]:
        """What is added at rest positions in m, of one flat shape."""
        return self._added(x, y, self.ground.between(x, y), time, keys)

    def over(
        self, open_sea: Mapping[str, RealArray], x: Array, y: Array, time: float | Fraction
    ) -> dict[str, Array]:
        """ADDING over the bed, float64, from those of the open sea, at flat rest positions in m."""
        share = self.shares(x, y)
        added = adding_fields(Summed([self.at(x, y, time, ADDED)]), x.shape)
        whole = {name: share.value[:, np.newaxis] * open_sea[name] + added[name] for name in added}
        dx, dy, dz = np.asarray(open_sea["displacement"], np.float64).T
        whole["slope"] += np.stack((dz * share.by_x, dz * share.by_y), axis=-1)
        shear = 0.5 * (dx * share.by_y + dy * share.by_x)
        whole["strain"] += np.stack((dx * share.by_x, dy * share.by_y, shear), axis=-1)
        return whole

    def on_samples(self, time: float | Fraction) -> dict[str, RealArray]:
        """ADDING of what is added, on the bed's samples: (rows, columns, …) float32 each."""
        x, y = self.ground.places
        added = self._added(x.ravel(), y.ravel(), _Samples(), time, ADDED)
        return adding_fields(Summed([added]), x.shape)

    def _added(
        self, x: Array, y: Array, where: Between | _Samples, time: float | Fraction, keys: Iterable[Key]
    ) -> dict[Key, RealArray]:
        """What is added at places in m, which lie so among the bed's samples."""
        wanted = unweighted(closed(keys))
        made = _made_together(wanted)
        over_bed, open_sea = self._field(time, made), self._long(time, made)
        here = weighted(over_bed.read(where, wanted), self._weights.read(1, where))
        instead_of = weighted(open_sea.read(x, y), self._weights.read(2, where))
        return {key: here[key] - instead_of[key] for key in wanted}

    def field(self, time: float | Fraction) -> Field:
        """Their own surface at a time."""
        return as_field(lambda x, y, keys: self.at(x, y, time, keys))

    def _long(self, time: float | Fraction, keys: frozenset[Key]) -> Grid:
        """The long waves of the open sea, on the first patch's samples."""

        def make() -> Grid:
            part = self._waves.part
            return Grid(components(self._open, time, keys, True), part.parameters.domain_size, part.rotation)

        key = (self._waves.parameters, self.ground, self._waves.precision, time, keys, "open")
        return MEMO.get(_FIELDS, key, make)

    @cached_property
    def _open(self) -> Synthesis:
        # a mode along +k is one of the coefficients h₊, its opposite of h₋
        return self._waves.some(self.incoming.modes)

    def _field(self, time: float | Fraction, keys: frozenset[Key]) -> _BedGrid:
        key = (self._waves.parameters, self.ground, self._waves.precision, time, keys, "bed")
        return MEMO.get(_FIELDS, key, lambda: self._made(time, keys))

    def _made(self, time: float | Fraction, keys: frozenset[Key]) -> _BedGrid:
        values = self.over_bed.components(time, keys)
        return _BedGrid(turned(values, self.ground.turn))

    @cached_property
    def over_bed(self) -> OverBed:
        """What the pictures' waves are at a time."""
        broken = self.broken_share if self.ground.coast.breaking else np.zeros(self.ground.depth.shape)
        dtype = real_type(self._waves.precision)
        return OverBed(self._sea, self.pictures, self.ground, broken, dtype)

    def foam(self, x: Array, y: Array, time: float | Fraction) -> OwnFoam:
        """Of waves that break for lack of depth, at rest positions in m, of one flat shape."""
        return self._foam(self.ground.between(x, y), time)

    def foam_on_samples(self, time: float | Fraction) -> OwnFoam:
        """The same on the bed's samples, (rows, columns)."""
        found = self._foam(_Samples(), time)
        return OwnFoam(*(field.reshape(self.ground.depth.shape) for field in found))

    def _foam(self, where: Between | _Samples, time: float | Fraction) -> OwnFoam:
        # of the whole sea: which waves break follows from those of all patches
        key = (self._sea, self._waves.precision, time, "foam")
        foam, breaking, age = MEMO.get(_FIELDS, key, lambda: _FoamOverBed(self.over_bed.foam(time))).fields
        share = self._weights.read(1, where).value.astype(np.float32)
        here = [where.read(each).astype(np.float32) for each in (foam, breaking, age)]
        return OwnFoam(here[0] * share, here[1] * share, here[2])

    def state(self, x: Array, y: Array) -> StateFields:
        """Height, breaking and direction of all waves at places in m, of one flat shape."""
        where = self.ground.between(x, y)
        share = self._weights.read(1, where).value
        variance, flow = open_state(self._parts)
        over_bed = (self.significant_height / 4.0) ** 2
        return StateFields.of(
            variance + share * (where.read(over_bed) - variance),
            share * where.read(self.broken_share),
            np.stack(
                [
                    own + share * (where.read(field) - own)
                    for own, field in zip(flow, self._flow, strict=True)
                ],
                -1,
            ),
        )

    @cached_property
    def state_tag(self) -> str:
        """What tells it from that of other waves or over another bed."""
        return f"{zlib.crc32(self.significant_height)} {zlib.crc32(self._flow)}"

    @cached_property
    def _flow(self) -> Array:
        """(2, rows, columns) m² along the sea's axes, of all waves over the bed, around each place."""
        period = self._sea.repeats_after
        assert period is not None
        # what waves of one frequency come to where they cross is no direction of theirs
        alone = flow_over_bed(self.pictures, self.ground, float(period), self._sea.water.gravity)
        alone = np.stack(
            [smoothed(each, _AROUND / self.ground.step) for each in np.moveaxis(alone, -1, 0)], -1
        )
        waves = self.incoming
        k = np.hypot(waves.along, waves.across)
        first = self._waves.initial_state
        expected = np.concatenate([
            (of * first.grid.multiplicity)[waves.modes[..., side]]
            for side, of in enumerate((first.expected_plus, first.expected_minus))
        ])  # fmt: skip
        follow = np.array([expected @ (waves.along / k), expected @ (waves.across / k)])
        rest = open_state(self._parts)[1] - turned_by(self.ground.turn, follow)
        whole = turned_by(self.ground.turn, alone) + rest * self._limit[..., np.newaxis] ** 2
        return np.ascontiguousarray(np.moveaxis(whole, -1, 0))

    def breaks(self, x: Array, y: Array, time: float | Fraction) -> NDArray[np.bool_]:
        """Whether fronts of broken waves are at rest positions in m, of one flat shape."""
        white, _ = self._fronts(time)
        return np.asarray(self.ground.between(x, y).read(white) > 0.0)

    def spray(self, x: Array, y: Array, time: float | Fraction, velocity: Array) -> OwnSpray:
        """What waves that break for lack of depth throw up at rest positions in m, of one flat shape.

        velocity : of the water there, (places, 3) m/s
        """
        where = self.ground.between(x, y)
        white, height = (where.read(field).astype(np.float64) for field in self._fronts(time))
        share = self._weights.read(1, where).value
        depth = where.read(self.ground.depth).astype(np.float64)
        return breaker_spray(white * share, height, depth, velocity, self._sea.water.gravity)

    def _fronts(self, time: float | Fraction) -> tuple[RealArray, RealArray]:
        key = (self._sea, self._waves.precision, time, "fronts")
        return MEMO.get(_FIELDS, key, lambda: _Fronts(*self.over_bed.fronts(time)))

    def wet(self, x: Array, y: Array, time: float | Fraction) -> NDArray[np.float32]:
        """0…1 at places of the bed and the land in m, of one flat shape: 1 in water, and on land less the
        longer ago a wave ran up there.
        """
        return self.swash.wet(x, y, time)

    @cached_property
    def swash(self) -> Swash:
        """How far up the shore waves run."""
        state = continuous_state(SeaSpectrum(self._sea))
        # a flat sea has no period
        wavelength = self._sea.water.gravity * np.nan_to_num(state.peak_period) ** 2 / (2.0 * math.pi)
        depth = smoothed(self.ground.depth, _FORESHORE / self.ground.step)
        slope = np.hypot(*np.gradient(depth, self.ground.step))
        height = state.significant_wave_height
        return Swash(self.over_bed, self.pictures, self.ground, self.broken_share, slope, height, wavelength)

    @cached_property
    def _weights(self) -> _BedWeights:
        share = np.repeat(self.ground.blend[:, np.newaxis], self.ground.columns, axis=1)
        limited = share * self._limit
        return _BedWeights(self.ground, (1.0 - share + limited, share, limited))

    @cached_property
    def _afloat(self) -> _BedWeights:
        # of the depth alone, whatever the waves
        return _BedWeights(self.ground, (smoothstep(self.ground.depth / _AFLOAT),))

    @property
    def share_of_energy(self) -> float:
        """Of all waves, that of those which follow the bed, 0…1."""
        follow, every = self._energy
        return follow / every if every > 0.0 else 0.0

    @cached_property
    def _energy(self) -> tuple[float, float]:
        """Variances in m² that are expected of the waves that follow the bed, and of all."""
        first = self._waves.initial_state
        follow = [
            float(np.sum((of * first.grid.multiplicity)[self.incoming.modes[..., side]]))
            for side, of in enumerate((first.expected_plus, first.expected_minus))
        ]
        every = [
            float(np.sum((state.expected_plus + state.expected_minus) * state.grid.multiplicity))
            for waves in self._parts
            for state in waves.initial_state.parts
        ]
        return sum(follow), sum(every)

    @cached_property
    def significant_height(self) -> Array:
        """(rows, columns) m, of all waves over the bed, the long ones as this seed has them."""
        follow, every = self._energy
        variance = np.zeros(self.ground.depth.shape)
        variance[self.ground.depth > 0.0] = self.pictures.rms_height**2 / 8.0
        return 4.0 * np.sqrt(variance + max(every - follow, 0.0) * self._limit**2)

    @cached_property
    def broken_share(self) -> Array:
        """(rows, columns) share of waves that are broken for lack of depth."""
        return broken_share(self.significant_height / math.sqrt(2.0), self.ground.depth)

    @cached_property
    def _limit(self) -> Array:
        """(rows, columns) what depth and shelter leave of waves that do not follow the bed."""
        follow, every = self._energy
        depth, height = np.maximum(self.ground.depth, 0.0), 4.0 * math.sqrt(max(every - follow, 1e-12))
        limit = np.tanh(_LARGEST * depth / height) / math.tanh(_LARGEST * self.ground.deep / height)
        result: Array = np.minimum(limit, self._sheltered)
        return result

    @cached_property
    def _sheltered(self) -> Array:
        """(rows, columns) how high the long waves around are over how high they came, at most 1: where these
        do not reach, shorter ones do not either.
        """
        wet, step = self.ground.depth > 0.0, self.ground.step
        if not len(self.pictures.numbers):
            return np.ones(wet.shape)  # none came that a shelter could be seen by
        squares = np.zeros(wet.shape)
        squares[wet] = self.pictures.rms_height**2
        came = max(float(squares[: self.ground.rim_rows].mean()), 1e-12)
        around = smoothed(squares, _AROUND / step) / np.maximum(
            smoothed(wet.astype(float), _AROUND / step), 1e-6
        )
        share = self.ground.bed_share[:, np.newaxis]
        return 1.0 - share * (1.0 - np.sqrt(np.clip(around / came, 0.0, 1.0)))


def smoothed(field: Array, samples: float) -> Array:
    """A field (rows, columns) under a bell of so many samples' deviation; it repeats along rows, and ends."""
    wide = np.concatenate((field, field[::-1]))  # its own mirror goes on at either end
    along, across = (np.fft.fftfreq(wide.shape[0])[:, np.newaxis], np.fft.rfftfreq(wide.shape[1]))
    bell = np.exp(-2.0 * (np.pi * samples) ** 2 * (along**2 + across**2))
    result: Array = np.fft.irfft2(np.fft.rfft2(wide) * bell, wide.shape)[: len(field)]
    return result


class _Samples:
    """The places of a bed's own samples."""

    def read(self, field: RealArray) -> RealArray:
        """Flat, from (rows, columns)."""
        return field.reshape(-1)


def _made_together(keys: frozenset[Key]) -> frozenset[Key]:
    """Components that are made where some are wanted: of a surface the same ones, for all who look at it."""
    if (Z, "") not in keys:  # of foam's births
        return keys
    moves = any(by == "t" for _, by in keys)
    return keys | {key for key in unweighted(closed(ADDED)) if moves or key[1] != "t"}


class _BedGrid:
    """Components (rows, columns) on the bed's samples, in the sea's axes."""

    def __init__(self, values: dict[Key, RealArray]) -> None:
        self._values = values

    @property
    def nbytes(self) -> int:
        """Bytes of the components."""
        return total_bytes(self._values.values())

    def read(self, where: Between | _Samples, keys: Iterable[Key]) -> dict[Key, RealArray]:
        """Some of them at flat places."""
        return {key: where.read(self._values[key]).astype(self._values[key].dtype) for key in keys}


class _Fronts(NamedTuple):
    """Of broken waves, on the bed's samples: whiteness, and the height of waves."""

    white: RealArray
    height: RealArray

    @property
    def nbytes(self) -> int:
        """Bytes of both."""
        return total_bytes(self)


class _FoamOverBed(NamedTuple):
    """Foam on the bed's samples."""

    fields: OwnFoam

    @property
    def nbytes(self) -> int:
        """Bytes of its fields."""
        return total_bytes(self.fields)


class _BedWeights:
    """Weights on the bed's samples, and beyond its ends those at the ends."""

    def __init__(self, ground: Ground, values: Iterable[Array]) -> None:
        self._fields = []
        c, s = math.cos(ground.turn), math.sin(ground.turn)
        for value in values:
            # from neighbours alone: where a weight is 0 its derivatives are
            along = np.gradient(value, ground.step, axis=0)
            across = (np.roll(value, -1, axis=1) - np.roll(value, 1, axis=1)) / (2.0 * ground.step)
            self._fields.append((value, c * along - s * across, s * along + c * across))

    def read(self, index: int, where: Between | _Samples) -> Weights:
        """One of them at flat places."""
        return Weights(*(np.asarray(where.read(field), np.float64) for field in self._fields[index]))
