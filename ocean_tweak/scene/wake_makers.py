# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that make waves: their paths without waves, by their keys, and what their hulls are.

A floating object must not be read by the evaluation of its ocean. So a wake follows the place on land of its
object, a floating one's carrier before the water moves it, and this is worked out from keys, frame by frame,
without going there. Where constraints or drivers move an object, its path is recorded once instead, see
`wake_recording`.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Set
from dataclasses import replace
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix, Vector
from numpy.typing import NDArray

from ..core import PathSample, Raster
from ..core.sea.underwater_hull import shares_of_draught
from ..core.waves.wake.parameters import MOST_SAMPLES
from . import float_path
from .animated import curves_of, has_own_time, shown_settings
from .float_carrier import carrier_of
from .floating import level_at, own_hull, ride_of
from .hull import Hull
from .refinement import show
from .refresh import Wanted
from .settings import OceanObjectError, oceans_in, settings_of
from .units import frame_rate, metres_per_unit, time_stretch

Array = NDArray[np.float64]

# by the session uid of an ocean: what its wakes' paths follow from besides the objects
_followed: dict[int, object] = {}

#: of a path, by which a sample may be left out: m a metre of hull, and rad
_ASIDE, _TURNED = 0.002, 0.01

#: custom property of an object that moves with the end ahead that its -x or -y points to
_REVERSED = "ocean_tweak_bow_reversed"


class WakeError(OceanObjectError):
    """Why an object cannot make waves."""


class InWater(NamedTuple):
    """What of a hull is in the water; Blender units, in its upright axes.

    level : of calm water, z
    low, high : corners of the part below it, x and y
    draught : how deep it is
    ahead : direction of its bow, rad from +x: along its length
    """

    hull: Hull
    level: float
    low: tuple[float, float]
    high: tuple[float, float]
    draught: float
    ahead: float

    @property
    def length(self) -> float:
        """Its larger horizontal size."""
        return max(self._sizes)

    @property
    def beam(self) -> float:
        """Its smaller horizontal size."""
        return min(self._sizes)

    @property
    def middle(self) -> tuple[float, float]:
        """Of its horizontal bounds."""
        return 0.5 * (self.low[0] + self.high[0]), 0.5 * (self.low[1] + self.high[1])

    @property
    def _sizes(self) -> tuple[float, float]:
        return self.high[0] - self.low[0], self.high[1] - self.low[1]

    def turned(self) -> InWater:
        """With its bow at the other end."""
        return self._replace(ahead=self.ahead + math.pi)


def in_water(
    item: bpy.types.Object,
    ocean: bpy.types.Object,
    metres: float,
    depsgraph: bpy.types.Depsgraph | None = None,
) -> InWater:
    """The part of an object that presses the water aside.

    metres : in a Blender unit, for what is said
    depsgraph : that of a handler

    Raises WakeError for what is above the water, or has no width.
    """
    hull, carrier = own_hull(item, depsgraph), carrier_of(item)
    if hull is None:
        raise WakeError(f"{item.name} has no mesh that is rendered, so no hull: choose one that has")
    level = level_at(item, ocean, None if carrier is None else ride_of(carrier)[1])
    draught = level + hull.keel
    if draught <= 0.0:
        raise WakeError(
            f"{item.name} is {-draught * metres:.3g} m above the water: lower it, or press Float on Ocean "
            "first"
        )
    (west, south), (east, north) = (end.tolist() for end in hull.below(level))
    along_y = north - south > east - west
    ahead = (0.5 * math.pi if along_y else 0.0) + (math.pi if item.get(_REVERSED) else 0.0)
    found = InWater(hull, level, (west, south), (east, north), draught, ahead)
    if not found.beam > 0.0:
        raise WakeError(
            f"{item.name} is flat, {found.length * metres:.3g} by {found.beam * metres:.3g} m: choose what "
            "has a width"
        )
    return found


def bow_first(
    item: bpy.types.Object, wetted: InWater, path: tuple[PathSample, ...]
) -> tuple[InWater, tuple[PathSample, ...]]:
    """With the bow at the end that is ahead along the path; kept with the object, whose keys may change."""
    if not _goes_astern(path):
        return wetted, path
    if item.library is None:
        item[_REVERSED] = not item.get(_REVERSED)
    return wetted.turned(), tuple(replace(each, heading=each.heading + math.pi) for each in path)


def footprint_of(wetted: InWater) -> Raster:
    """How deep a hull is at each place, as shares of its draught, the bow ahead.

    Raises ValueError, with the reason, for one that encloses nothing below the water.
    """
    cosine, sine = round(math.cos(wetted.ahead)), round(math.sin(wetted.ahead))
    to_bow = np.array([[cosine, -sine], [sine, cosine]])  # of rows: x ahead, y to port
    vertices = wetted.hull.vertices.copy()
    vertices[:, :2] = vertices[:, :2] @ to_bow
    corners = np.array([wetted.low, wetted.high]) @ to_bow
    low, high = (tuple(end.tolist()) for end in (corners.min(axis=0), corners.max(axis=0)))
    return Raster(shares_of_draught(vertices, wetted.hull.triangles, wetted.level, low, high))


def path_of(
    item: bpy.types.Object, ocean: bpy.types.Object, scene: bpy.types.Scene, wetted: InWater
) -> tuple[PathSample, ...]:
    """Where keys say that an object was and will be; () where they do not say all."""
    place = carrier_of(item) or item
    if not (float_path.is_known(place) and float_path.is_known(ocean)):
        return ()
    to_ocean = ocean.matrix_world.inverted_safe()
    stretch = float(time_stretch(scene))
    frames = frames_of(place, scene) if _moves(place) else range(scene.frame_start, scene.frame_start + 1)
    places = (to_ocean @ float_path.matrix_at(place, frame / stretch) for frame in frames)
    return path_through(frames, places, ocean, scene, wetted)


def frames_of(place: bpy.types.Object, scene: bpy.types.Scene) -> range:
    """The scene's frames, and those before and after at which the object or its parents have keys."""
    stretch = float(time_stretch(scene))
    first, last = float(scene.frame_start), float(scene.frame_end)
    each: bpy.types.Object | None = place
    while each is not None:
        for curve in curves_of(each):
            begin, end = curve.range()
            first, last = min(first, begin * stretch), max(last, end * stretch)
        each = each.parent
    frames = range(math.floor(first), math.ceil(last) + 1)
    return frames if len(frames) <= MOST_SAMPLES else frames[:MOST_SAMPLES]


def follow(scene: bpy.types.Scene, moved: Set[str], depsgraph: bpy.types.Depsgraph | None) -> None:
    """Let the wakes of a scene's oceans follow objects that were moved or keyed otherwise, and another frame
    rate, unit or place of the ocean.

    moved : names of objects and actions that an evaluation has anew
    depsgraph : that of the handler which this is called from
    """
    for ocean in oceans_in(scene):
        makers = [] if ocean.library is not None else list(settings_of(ocean).wake_makers())
        if not makers:
            continue
        now, before = _clock_and_place(ocean, scene), _followed.get(ocean.session_uid)
        _followed[ocean.session_uid] = now
        is_other = before not in (None, now)
        changed = False
        for number, item in makers:
            if is_other or moved & set(_names(item)):
                changed |= _follow(ocean, number, item, scene, depsgraph)
        if changed:
            show(ocean, scene, Wanted.CHANGE)


def _clock_and_place(ocean: bpy.types.Object, scene: bpy.types.Scene) -> object:
    """What tells a frame's time, and of an ocean that is not keyed, how fast it runs and where it lies."""
    settings = settings_of(ocean)
    own = None if _moves(ocean) else (settings.time_scale, tuple(map(tuple, ocean.matrix_world)))
    clock = frame_rate(scene), time_stretch(scene), settings.timing.start_frame
    return scene.session_uid, clock, metres_per_unit(scene), own


def forget_all() -> None:
    """Another file is opened, or the extension is disabled."""
    _followed.clear()


def _follow(
    ocean: bpy.types.Object,
    number: int,
    item: bpy.types.Object,
    scene: bpy.types.Scene,
    depsgraph: bpy.types.Depsgraph | None,
) -> bool:
    """Give a layer the path of its object; whether that is another one."""
    if item.name not in scene.objects:
        return False
    try:
        wetted = in_water(item, ocean, float(metres_per_unit(scene)), depsgraph)
        path = path_of(item, ocean, scene, wetted)
    except WakeError:  # out of the water for now: its layer stays as it was
        return False
    return bool(path) and settings_of(ocean).set_wake_path(number, path)


def _names(item: bpy.types.Object) -> Iterator[str]:
    """Of what an object's path follows from."""
    each: bpy.types.Object | None = item
    while each is not None:
        for part in (each, carrier_of(each)):
            if part is None:
                continue
            yield part.name
            if part.animation_data is not None and part.animation_data.action is not None:
                yield part.animation_data.action.name
        each = each.parent


def _moves(place: bpy.types.Object) -> bool:
    each: bpy.types.Object | None = place
    while each is not None:
        if any(True for _ in curves_of(each)):
            return True
        each = each.parent
    return False


def path_through(
    frames: Iterable[int],
    places: Iterable[Matrix],
    ocean: bpy.types.Object,
    scene: bpy.types.Scene,
    wetted: InWater,
) -> tuple[PathSample, ...]:
    """The path of a hull's middle with a place a frame, as few samples as tell it.

    places : in the ocean's space

    Raises WakeError for an ocean with a time of its own.
    """
    settings = shown_settings(ocean, None)
    if settings.use_ocean_time:
        raise WakeError(f"{ocean.name} has Keyed Time, which no path follows: switch it off")
    metres = float(metres_per_unit(scene))
    scale = settings.time_scale if has_own_time(settings) else 1.0
    start, fps, stretch = settings.timing.start_frame, float(frame_rate(scene)), float(time_stretch(scene))
    middle = Vector((*wetted.middle, 0.0))
    found = []
    for frame, place in zip(frames, places, strict=True):
        origin, turn, _ = place.decompose()
        yaw = 2.0 * math.atan2(turn.z, turn.w)
        x, y, _ = (origin + Matrix.Rotation(yaw, 3, "Z") @ middle) * metres
        time = (frame / stretch - start) / fps * scale
        found.append(PathSample(time, x, y, yaw + wetted.ahead))
    return _thinned(_unwound(found), _ASIDE * wetted.length * metres)


def _unwound(samples: list[PathSample]) -> list[PathSample]:
    """With headings that turn without a jump."""
    headings = np.unwrap([each.heading for each in samples]).tolist()
    return [replace(each, heading=heading) for each, heading in zip(samples, headings, strict=True)]


def _goes_astern(path: tuple[PathSample, ...]) -> bool:
    """Whether the bow is behind on most of the way."""
    ahead = 0.0
    for before, each in itertools.pairwise(path):
        ahead += (each.x - before.x) * math.cos(each.heading) + (each.y - before.y) * math.sin(each.heading)
    return ahead < 0.0


def _thinned(samples: list[PathSample], aside: float) -> tuple[PathSample, ...]:
    """Those between which all others lie, up to some m, on straight lines at one speed."""
    rows = np.array([(each.time, each.x, each.y, each.heading) for each in samples])
    kept = [0]
    while kept[-1] < len(rows) - 1:
        left = rows[kept[-1] :]
        kept.append(kept[-1] + _farthest(left, aside))
    return tuple(samples[index] for index in kept)


def _farthest(rows: Array, aside: float) -> int:
    """The last row up to which all lie straight on from the first: looked for in steps that double, then
    halve."""
    step, good = 1, 1
    while good + step < len(rows) and _is_straight(rows[: good + step + 1], aside):
        good += step
        step *= 2
    while step:
        if good + step < len(rows) and _is_straight(rows[: good + step + 1], aside):
            good += step
        step //= 2
    return good


def _is_straight(rows: Array, aside: float) -> bool:
    share = ((rows[:, 0] - rows[0, 0]) / (rows[-1, 0] - rows[0, 0]))[:, np.newaxis]
    off = np.abs(rows[:, 1:] - rows[0, 1:] - share * (rows[-1, 1:] - rows[0, 1:]))
    return bool(np.all(off[:, :2] <= aside) and np.all(off[:, 2] <= _TURNED))
