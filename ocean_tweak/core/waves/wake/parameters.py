# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of a wake: an object's path, its footprint in the water, and the square of its waves."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from ...data.errors import ParameterError
from ...data.raster import Raster
from ...data.validation import (
    Validated,
    angle,
    choice,
    integer,
    moment,
    nested,
    number,
    place,
    raster,
    switch,
)
from ...masks.parameters import Mask
from ...numerics.memo import MEMO, remembered
from ..contribution import (
    Contribution,
    Gives,
    HullPlace,
    Key,
    MemoryNeed,
    Names,
    OwnFoam,
    OwnSpray,
    amplitude_scale,
    muted,
)
from .bow_spray import bow_spray
from .elevation import Basin
from .fields import WakeWaves, Where
from .foam import HullFoam
from .footprint import hull_footprint
from .outlook import WakeOutlooks, transverse_wavelength, wake_outlooks
from .track import Track

if TYPE_CHECKING:
    from ...parameters.current import Current
    from ...parameters.ocean_parameters import OceanParameters

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

HEADINGS = ("ALONG_PATH", "OF_SAMPLES")

#: samples of a path
MOST_SAMPLES = 8192

#: an area is at least so many hulls long, and so many transverse waves: more do not find room before it fades
_HULLS, _WAVES = 3.0, 2.0
#: samples of an area across a beam
_FEWEST = 1.0
#: lengths of the hull, and transverse waves, in an area to begin with
_BEGIN_HULLS, _BEGIN_WAVES = 12.0, 16.0
#: 1/s, if no area asks for more
_USUAL_DECAY = 0.015
#: samples across a beam to begin with, and along the area's sides at least and at most
_BEGIN_ACROSS, _BEGIN_SAMPLES = 2.0, (256, 1024)
#: decays in which an object crosses an area to begin with: e^-3.6 of its waves come around
_BEGIN_DECAYS = 3.6
_WAKES = "wakes' paths"


@dataclass(frozen=True)
class PathSample(Validated):
    """Position of an object at one time.

    Examples
    --------
    >>> PathSample(2.0, x=16.0).x
    16.0
    """

    time: float = moment(
        0.0,
        "Ocean time at which the object is here; it moves straight to the next sample, and keeps its "
        "velocity before the first and after the last",
    )
    x: float = place(0.0, "Position of its origin along x")
    y: float = place(0.0, "Position of its origin along y")
    heading: float = angle("Direction of its bow, counter-clockwise from +x, if the samples set it")
    immersion: float = number(
        1.0, 0.0, 100.0, "", "Multiplies the draught: 0 is out of the water; falling in, bobbing and "
            "slamming change it",
        "an artist's scale",
    )  # fmt: skip


@dataclass(frozen=True)
class WakeLayer(Contribution):
    """The waves of one object: the wake of a hull, or rings around something that falls in.

    They depend on the object's whole past, so any frame can be computed alone, with the same bytes.

    Examples
    --------
    >>> from ocean_tweak.core import Area, Ocean, OceanParameters, PathSample, WakeLayer, WaveLayer
    >>> path = (PathSample(0.0), PathSample(30.0, x=240.0))
    >>> ship = WakeLayer(path=path, area_size=512.0, area_resolution=256, length=40.0, beam=8.0)
    >>> sea = Ocean(OceanParameters(resolution=64, layers=(WaveLayer(wind_speed=0.0), ship)))
    >>> heights = sea.surface(30.0, on=Area(256.0, 64, (0.0, -128.0))).displacement[..., 2]
    >>> bool(heights.max() > 0.1)
    True
    """

    kind = "WAKE"
    gives = Gives.FIELDS
    names = Names(
        4, "wake", "wake", "Wake", "Waves that a hull makes, or anything that moves in the water",
        "MOD_DYNAMICPAINT",
    )  # fmt: skip
    constant = "waves keep what the object did when it made them; change the samples of its path"

    path: tuple[PathSample, ...] = nested(PathSample, many=True, empty=True, most=MOST_SAMPLES)
    headings: str = choice(
        "ALONG_PATH", HEADINGS, "Direction of the bow: along the path, or the heading of each sample"
    )
    length: float = number(60.0, 0.01, 1000.0, "m", "Length of the hull in the water", "beyond any ship")
    beam: float = number(12.0, 0.01, 500.0, "m", "Width of the hull in the water", "beyond any ship")
    draught: float = number(
        3.0, 1e-4, 50.0, "m", "Depth of the hull below calm water, at its deepest", "beyond any ship",
        useful=(0.0, 10.0),
    )  # fmt: skip
    footprint: Raster | None = raster(
        "Fraction of the draught at each place over length and beam, in rows from starboard to "
        "port and from the stern to the bow; none for an ellipse, deepest in its middle",
        channels=1, left_out=True,
    )  # fmt: skip
    amplitude_scale: float = amplitude_scale()
    decay: float = number(
        _USUAL_DECAY, 1e-4, 10.0, "1/s", "Rate at which waves fade, e^(-rate × age); sets how long a "
            "wake lasts",
        "from hours to a moment",
    )  # fmt: skip
    foam: float = number(
        1.0, 0.0, 1.0, "", "Whiteness of the water stirred by the hull, at its stern and its bow; slow "
            "hulls make less",
        "a share",
    )  # fmt: skip
    foam_half_life: float = number(
        15.0, 0.1, 600.0, "s", "Time in which the band of foam astern fades to half",
        "from whitecaps to the slicks of ships",
    )  # fmt: skip
    area_size: float = number(
        2048.0, 0.1, 1e5, "m", "Side of the square in which the waves are computed; they fade out from a "
            "quarter of it outwards",
        "from a basin to the largest patch",
    )  # fmt: skip
    area_resolution: int = integer(
        512, 16, 4096, "Samples along each side of that square, an even number; waves shorter than two "
            "samples are left out",
        "more need too much memory", even_from=16,
    )  # fmt: skip
    area_follows: bool = switch(True, "Let the square move with the object; otherwise it stays in place")
    area_x: float = place(0.0, "Centre of the square along x, if it stays in place")
    area_y: float = place(0.0, "Centre of the square along y, if it stays in place")
    muted: bool = muted()
    mask: Mask | None = nested(Mask, optional=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        for index in range(1, len(self.path)):
            time, before = self.path[index].time, self.path[index - 1].time
            if time <= before:
                raise ParameterError(
                    f"path.{index}.time", time, f"must be later than the sample before it, {before:g} s"
                )
        if self.footprint is not None:
            least, most = (float(end(self.footprint.values)) for end in (np.min, np.max))
            if not (least >= 0.0 and most > 0.0):
                raise ParameterError(
                    "footprint", f"{least:g} to {most:g}",
                    "must be shares of the draught from 0, and above 0 somewhere: a hull above the water "
                    "makes no waves",
                )  # fmt: skip

    @cached_property
    def track(self) -> Track:
        """The validated path."""
        rows = [(each.time, each.x, each.y, each.heading, each.immersion) for each in self.path]
        times, x, y, headings, immersions = np.array(rows).T
        told = headings if self.headings == "OF_SAMPLES" else None
        return Track.of(times, np.stack((x, y), axis=-1), told, immersions)

    def check(self, sea: OceanParameters, path: str) -> None:
        """Check that the area can hold the hull and its waves, and that samples resolve the hull."""
        if not self.path:
            raise ParameterError(
                f"{path}.path",
                "",
                "has no samples: give one at least, where the object is, or mute the layer",
            )
        self._check_speed(sea, path)
        self._check_area(path)
        if sea.moves and not self.area_follows:
            raise ParameterError(
                f"{path}.area_follows", False,
                "must be true in a current, which would carry the waves out of a square that rests",
            )  # fmt: skip

    def _check_speed(self, sea: OceanParameters, path: str) -> None:
        speed, index = self.track.fastest
        longest = min(transverse_wavelength(speed, sea), 2.0 * math.pi * speed * speed / sea.water.gravity)
        most = self.area_size / _WAVES
        if longest > most:
            fitting = math.sqrt(most * sea.water.gravity / (2.0 * math.pi))
            raise ParameterError(
                f"{path}.path.{index}", f"{speed:.4g} m/s",
                f"is too fast for an area of {self.area_size:g} m: transverse waves are {longest:.4g} m "
                f"long. Make the area larger, or the object slower than {fitting:.3g} m/s; where it jumps, "
                "as at a cut, begin the path after the jump",
            )  # fmt: skip

    def _check_area(self, path: str) -> None:
        least = _HULLS * max(self.length, self.beam)
        if self.area_size < least:
            raise ParameterError(
                f"{path}.area_size", self.area_size,
                f"must be at least {least:g} m, {_HULLS:g} times the hull: make the area larger",
            )  # fmt: skip
        narrow = min(self.length, self.beam)
        needed = 2 * math.ceil(0.5 * _FEWEST * self.area_size / narrow)
        if self.area_resolution < needed:
            raise ParameterError(
                f"{path}.area_resolution", self.area_resolution,
                f"must be at least {needed} for a hull {narrow:g} m wide: raise it, or make the area smaller",
            )  # fmt: skip

    def fields(
        self, sea: OceanParameters, x: Array, y: Array, time: float | Fraction, keys: Iterable[Key]
    ) -> Mapping[Key, RealArray]:
        """What the object has made by then, of its whole past."""
        key = (self._of_waves, sea.water, sea.dispersion, sea.orbital_motion)
        waves = MEMO.get(_WAKES, key, lambda: self._waves(sea))
        found = waves.at(x, y, float(time), keys, sea.choppiness)
        MEMO.put(_WAKES, key, waves)  # which may have grown
        return found

    @property
    def makes_foam(self) -> bool:
        """Whether it stirs the water white."""
        return self.foam > 0.0

    def hull_at(self, time: float | Fraction) -> HullPlace:
        """On its path, as deep as it is there."""
        (x, y), _ = self.track.place(float(time))
        heading = self.track.heading(float(time))
        return HullPlace(x, y, heading, self.length, self.beam, self.draught)

    def own_foam(self, sea: OceanParameters, x: Array, y: Array, time: float | Fraction) -> OwnFoam | None:
        """The band astern, and what the bow throws aside."""
        return self._hull_foam(sea).at(x, y, float(time)) if self.makes_foam else None

    def own_spray(
        self, sea: OceanParameters, x: Array, y: Array, time: float | Fraction, height: Array, velocity: Array
    ) -> OwnSpray | None:
        """What the bow throws up."""
        if not self.makes_foam:
            return None
        return bow_spray(self._hull_foam(sea), self.draught, x, y, float(time), height, velocity)

    def in_current(self, current: Current) -> Self:
        """With the path through the water, which is another than that over the ground."""
        return _through_water(self, current)

    @cached_property
    def _of_waves(self) -> Self:
        """The layer without what the waves are made without."""
        return self.changed(mask=None, foam=0.0)

    def _hull_foam(self, sea: OceanParameters) -> HullFoam:
        gravity = sea.water.gravity
        return HullFoam(self.track, self.length, self.beam, self.foam, self.foam_half_life, gravity)

    def _basin(self, sea: OceanParameters) -> Basin:
        water, is_deep = sea.water, sea.dispersion == "DEEP"
        return Basin(
            self.area_size, self.area_resolution, math.inf if is_deep else water.depth, water.gravity,
            water.surface_tension if sea.dispersion == "CAPILLARY" else 0.0, self.decay, water.density,
        )  # fmt: skip

    def _waves(self, sea: OceanParameters) -> WakeWaves:
        shape = None if self.footprint is None else self.footprint.values[..., 0].astype(np.float64)
        footprint = hull_footprint(self.length, self.beam, self.amplitude_scale * self.draught, shape)
        where = Where(self.area_x, self.area_y, self.area_follows)
        orbit_depth = math.inf if sea.orbital_motion == "DEEP" else sea.water.depth
        return WakeWaves(self._basin(sea), self.track, footprint, where, orbit_depth)

    @classmethod
    def to_begin_with(cls, sea: OceanParameters, time: float) -> Self:
        """A ship that crosses the middle of the patch at a time."""
        size, speed = sea.domain_size, 0.4 * math.sqrt(sea.water.gravity * 0.1 * sea.domain_size)
        middle, length = 0.5 * size, 0.1 * size
        path = (PathSample(time, middle, middle), PathSample(time + 1.0, middle + speed, middle))
        return cls(
            path=path, length=length, beam=0.2 * length, draught=0.05 * length,
        ).in_an_area(speed, sea.water.gravity)  # fmt: skip

    def in_an_area(self, speed: float, gravity: float) -> Self:
        """In a square that holds the waves at a speed in m/s, with the decay that this takes."""
        wanted = max(_BEGIN_HULLS * self.length, _BEGIN_WAVES * 2.0 * math.pi * speed**2 / gravity)
        size = float(2.0 ** math.ceil(math.log2(wanted)))
        samples = 2 ** math.ceil(math.log2(_BEGIN_ACROSS * size / min(self.beam, self.length)))
        decay = max(_USUAL_DECAY, round(_BEGIN_DECAYS * speed / size, 3))
        few, many = _BEGIN_SAMPLES
        return self.changed(area_size=size, area_resolution=min(max(samples, few), many), decay=decay)

    @classmethod
    def memory(cls, sea: OceanParameters, real: int, moving: bool) -> MemoryNeed:
        """Two complex numbers a wave vector of each past, and a field for each component."""
        numbers = sum(layer.area_resolution**2 for layer in sea.active(cls))
        return MemoryNeed(8 * numbers * 9, 0, 4 * numbers * 12)

    @property
    def _deepest(self) -> float:
        """Of its draught over its path, m."""
        return self.amplitude_scale * self.draught * max(each.immersion for each in self.path)

    @classmethod
    def outlook(cls, sea: OceanParameters) -> WakeOutlooks | None:
        """How fast each object is, and how long its waves are."""
        found = [
            (number, layer.track, (layer.length, layer.beam, layer._deepest), layer._basin(sea))
            for number, layer in enumerate(sea.of(cls))
            if not layer.muted
        ]
        return wake_outlooks(sea, found)


@remembered("wakes' paths through the water")
def _through_water(layer: WakeLayer, current: Current) -> Any:
    """A wake with the path of its object through water that moves."""
    path = []
    for sample in layer.path:
        come_x, come_y = current.carried(sample.time)
        path.append(replace(sample, x=sample.x - come_x, y=sample.y - come_y))
    return layer.changed(path=tuple(path))
