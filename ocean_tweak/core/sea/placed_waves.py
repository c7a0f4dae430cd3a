# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves of layers without a grid, which can be evaluated at any place and need not be periodic."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..data.errors import ParameterError
from ..foam.model import Whitecaps
from ..masks.noise import SeaTime
from ..masks.parameters import Mask
from ..masks.weights import Weights, move, unweighted, weighted, weights
from ..numerics.interpolation import smoothstep, smoothstep_slope
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import open_sea
from ..synthesis.channels import ADDING, CHANNELS, SurfaceFields
from ..synthesis.transforms import X, Y, Z
from ..waves.contribution import Contribution, Gives, OwnFoam, OwnSpray
from .regions import Area
from .sampling import Key, Summed
from .surfaces import Field, Values

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: components of the displacement that ADDING need
ADDED = frozenset[Key]().union(*(CHANNELS[name].needs for name in ADDING))

#: what is left of these waves at places in m, if they may run aground
Afloat = Callable[[Array, Array], Weights]

#: how high the hull of a layer is raised at places and a time, m, and how fast, m/s; None without a hull
Lifts = Callable[[Contribution, Array, Array, Fraction], tuple[Array, Array] | None]

#: width of the border in which waves shown in an area fade to 0, relative to its size
_RIM = 0.1


class PlacedWaves:
    """The waves of a layer that provides fields, in the sea's axes, under its mask and the sea's."""

    def __init__(self, layer: Contribution, sea: OceanParameters) -> None:
        self._layer = layer
        self._sea = sea

    def at(self, x: Array, y: Array, time: float | Fraction, keys: Iterable[Key]) -> dict[Key, RealArray]:
        """Components of the displacement at flat arrays of rest positions in m."""
        under = self._weights(x, y, time)
        if under is None:
            return dict(self._fields(x, y, time, frozenset(keys)))
        return weighted(self._fields(x, y, time, unweighted(keys, moves=move(self._masks))), under)

    def _fields(
        self, x: Array, y: Array, time: float | Fraction, keys: Iterable[Key]
    ) -> Mapping[Key, RealArray]:
        """As the layer gives them, carried by the sea's current."""
        if not self._sea.moves:
            return self._layer.fields(self._sea, x, y, time, frozenset(keys))
        moving = [key for key in keys if key[1] == "t"]
        wanted = frozenset(keys) | {(component, by) for component, _ in moving for by in "xy"}
        layer, (come_x, come_y), (ux, uy, _) = self._in_water(time)
        found = dict(layer.fields(self._sea, x - come_x, y - come_y, time, wanted))
        for component, by in moving:
            found[component, by] = found[component, by] - (
                ux * found[component, "x"] + uy * found[component, "y"]
            )
        return found

    def foam(self, x: Array, y: Array, time: float | Fraction) -> OwnFoam | None:
        """What the layer makes of its own at rest positions in m, of one flat shape."""
        layer, (come_x, come_y), _ = self._in_water(time)
        found = layer.own_foam(self._sea, x - come_x, y - come_y, time)
        under = None if found is None else self._weights(x, y, time)
        if found is None or under is None:
            return found
        share = under.value.astype(np.float32)
        return OwnFoam(found.foam * share, found.breaking * share, found.age)

    def spray(
        self, x: Array, y: Array, time: float | Fraction, height: Array, velocity: Array, lifts: Lifts | None
    ) -> OwnSpray | None:
        """What the layer throws up at rest positions in m, of one flat shape.

        height, velocity : of the water there, (places,) m and (places, 3) m/s
        lifts : how its hull rides the other waves; None for one that does not
        """
        layer, (come_x, come_y), drift = self._in_water(time)
        lifted = None if lifts is None else lifts(self._layer, x, y, Fraction(time))
        if lifted is not None:
            raised, rise = lifted
            height, drift = height - raised, drift + rise[:, np.newaxis] * (0.0, 0.0, 1.0)
        found = layer.own_spray(self._sea, x - come_x, y - come_y, time, height, velocity - drift)
        if found is None:
            return None
        under = self._weights(x, y, time)
        strength = found.strength if under is None else found.strength * under.value
        return OwnSpray(strength, found.velocity + drift)

    def _in_water(self, time: float | Fraction) -> tuple[Contribution, tuple[float, float], Array]:
        """The layer as the water has it that the current moves, how far this came in m, and its velocity
        (3,) in m/s."""
        current = self._sea.current
        if current is None or not self._sea.moves:
            return self._layer, (0.0, 0.0), np.zeros(3)
        return (
            self._layer.in_current(current),
            current.carried(float(time)),
            np.array((*current.velocity, 0.0)),
        )

    @property
    def _masks(self) -> list[Mask]:
        return [mask for mask in (self._sea.mask, self._layer.mask) if mask is not None]

    def _weights(self, x: Array, y: Array, time: float | Fraction) -> Weights | None:
        """What masks leave at places; None without any."""
        if not self._masks:
            return None
        when = SeaTime(time, self._sea.loop_duration)
        return weights(self._masks, self._sea.domain_size, x, y, when)

    def field(self, time: float | Fraction) -> Field:
        """The surface of these waves at a time."""
        return as_field(lambda x, y, keys: self.at(x, y, time, keys))


def as_field(at: Callable[[Array, Array, Iterable[Key]], Mapping[Key, RealArray]]) -> Field:
    """A surface from what gives components of the displacement at rest positions in m."""

    def surface(x: Array, y: Array, with_velocity: bool) -> tuple[Values, Array | None]:
        wanted = ("", "x", "y", "t") if with_velocity else ("", "x", "y")
        found = at(x, y, [(component, by) for by in wanted for component in (X, Y, Z)])
        columns: list[Array] = [
            np.stack([np.asarray(found[component, by], np.float64) for component in (X, Y, Z)], axis=-1)
            for by in wanted
        ]
        return Values(*columns[:3]), columns[3] if with_velocity else None

    return surface


def placed_waves(sea: OceanParameters) -> tuple[PlacedWaves, ...]:
    """The waves of all layers that provide fields."""
    return tuple(PlacedWaves(layer, sea) for layer in sea.active() if Gives.FIELDS in layer.gives)


def has_tile(sea: OceanParameters) -> bool:
    """Whether all waves of a sea repeat with its domain."""
    return not (sea.is_cascade or sea.has_coast or placed_waves(sea))


def is_seen_around(sea: OceanParameters) -> bool:
    """Whether foam and spray of a sea are made around a camera: of patches, or of what does not repeat."""
    return bool(sea.patches or placed_waves(sea))


def makes_foam(sea: OceanParameters) -> bool:
    """Whether layers make foam of their own, and throw up spray, where no wave breaks."""
    return any(layer.makes_foam for layer in sea.active())


def repeating(sea: OceanParameters) -> OceanParameters:
    """The sea without these layers, and the open sea of one with a coast; the same one where it has none."""
    return without_placed(open_sea(sea))


def without_placed(sea: OceanParameters) -> OceanParameters:
    """The sea without these layers; the same one where it has none."""
    if not placed_waves(sea):
        return sea
    layers = (layer.changed(muted=True) if Gives.FIELDS in layer.gives else layer for layer in sea.layers)
    return sea.replace(layers=tuple(layers))


def placed_fields(
    sea: OceanParameters,
    area: Area,
    time: float | Fraction,
    afloat: Afloat | None = None,
) -> SurfaceFields:
    """ADDING of these layers only, in an area, (n, n, …) float32, fading to 0 at its outermost samples.

    afloat : what is left of them at places in m, if they may run aground

    There must be such layers.
    """
    x, y = (places.ravel() for places in area.rest_positions())
    under = _rim(area) if afloat is None else _rim(area).times(afloat(x, y))
    sums = Summed(weighted(waves.at(x, y, time, unweighted(ADDED)), under) for waves in placed_waves(sea))
    shape = area.resolution, area.resolution
    return SurfaceFields(float(time), adding_fields(sums, shape))


def adding_fields(sums: Summed, shape: tuple[int, ...]) -> dict[str, RealArray]:
    """ADDING of sums at flat places, as float32 fields of a shape."""
    fields: dict[str, RealArray] = {}
    for name in ADDING:
        components = CHANNELS[name].components
        made: RealArray = np.empty((math.prod(shape), components), np.float32)
        CHANNELS[name].write(sums, made)
        fields[name] = made.reshape(*shape, components)
    return fields


def placed_foam(sea: OceanParameters, area: Area, time: float | Fraction) -> Whitecaps:
    """The foam of these layers only, in an area, (n, n) float32, fading to 0 at its outermost samples."""
    x, y = (places.ravel() for places in area.rest_positions())
    none = np.zeros(x.size, np.float32)
    foam, breaking, age = with_own_foam(sea, Whitecaps(none, none, none), x, y, time)
    share, shape = _rim(area).value.astype(np.float32), (area.resolution, area.resolution)
    return Whitecaps(*(field.reshape(shape) for field in (foam * share, breaking * share, age)))


def _rim(area: Area) -> Weights:
    """1 inside, 0 at the outermost samples, and smooth between."""
    along = np.arange(area.resolution) / max(area.resolution - 1, 1)
    part = np.minimum(along, 1.0 - along) / _RIM
    share = smoothstep(part)
    reach = _RIM * area.size * (area.resolution - 1) / area.resolution
    slope = np.sign(0.5 - along) * smoothstep_slope(part) / reach
    return Weights(*(np.outer(v, u).ravel() for v, u in ((share, share), (share, slope), (slope, share))))


def with_own_foam(
    sea: OceanParameters,
    whitecaps: Whitecaps,
    x: Array,
    y: Array,
    time: float | Fraction,
    afloat: Afloat | None = None,
) -> Whitecaps:
    """The foam of a sea's waves with that which layers make of their own, at flat rest positions in m.

    afloat : as of `placed_fields`
    """
    share = None
    for foam, breaking, age in _own_foams(sea, x, y, time):
        if afloat is not None:
            share = afloat(x, y).value.astype(np.float32) if share is None else share
            foam, breaking = foam * share, breaking * share
        whitecaps = whitecaps.over(foam, breaking, age)
    return whitecaps


def throws(sea: OceanParameters, x: Array, y: Array, time: float | Fraction) -> NDArray[np.bool_]:
    """Whether layers throw up water at flat rest positions in m."""
    found = np.zeros(x.size, bool)
    for own in _own_foams(sea, x, y, time):
        found |= own.breaking > 0.0
    return found


def _own_foams(sea: OceanParameters, x: Array, y: Array, time: float | Fraction) -> Iterator[OwnFoam]:
    """The foam of each layer that makes some of its own, at flat rest positions in m."""
    found = (waves.foam(x, y, time) for waves in placed_waves(sea))
    return (own for own in found if own is not None)


def own_spray(
    sea: OceanParameters,
    x: Array,
    y: Array,
    time: float | Fraction,
    height: Array,
    velocity: Array,
    lifts: Lifts | None = None,
) -> OwnSpray:
    """What layers throw up at flat rest positions in m: of several, that of which there is most.

    height, velocity : of the water there, (places,) m and (places, 3) m/s
    lifts : how hulls ride the other waves, as of `hull_motion.HullMotion.at`; by default they do not
    """
    strongest = OwnSpray(np.zeros(x.size), velocity)
    for waves in placed_waves(sea):
        own = waves.spray(x, y, time, height, velocity, lifts)
        if own is not None:
            strongest = stronger(strongest, own)
    return strongest


def stronger(one: OwnSpray, other: OwnSpray) -> OwnSpray:
    """Of two that are thrown up at the same places, that of which there is more."""
    more = other.strength > one.strength
    return OwnSpray(
        np.where(more, other.strength, one.strength),
        np.where(more[:, np.newaxis], other.velocity, one.velocity),
    )


def check_repeats(sea: OceanParameters) -> None:
    """Raise ParameterError, with a remedy, for a sea with waves that do not repeat, which has no tile."""
    if sea.has_coast:
        raise ParameterError(
            "coast", "given",
            "the waves over its bed do not repeat with the domain, as a tile's do: ask for an Area or Places "
            "(--area or --maps disp,coast on the command line), or set coast.muted",
        )  # fmt: skip
    for index, layer in enumerate(sea.layers):
        if Gives.FIELDS in layer.gives and not layer.muted:
            raise ParameterError(
                f"layers.{index}", layer.kind,
                "its waves do not repeat with the domain, as a tile's do: ask for an Area or "
                "Places (--area on the command line, a Camera Surface in Blender), or mute the "
                "layer",
            )  # fmt: skip


def strain_covariances(sea: OceanParameters, drift: tuple[float, float]) -> list[tuple[Array, Array]]:
    """Of each of these layers that tells them, as `core.foam.threshold.strain_covariances` has them."""
    ux, uy = (0.0, 0.0) if sea.current is None else sea.current.velocity
    through_water = drift[0] - ux, drift[1] - uy
    told = (
        layer.strain_covariances(sea, through_water) for layer in sea.active() if Gives.FIELDS in layer.gives
    )
    return [found for found in told if found is not None]
