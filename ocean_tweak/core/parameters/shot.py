# SPDX-License-Identifier: GPL-3.0-or-later
"""A shot: a sea and its animation.

Each frame is the sea with that frame's parameters at that frame's ocean time, and depends on the frame number
alone. Animated values are sampled once per frame and interpolated linearly in between. The lines of a mask
are a raster with one row per frame.
"""

from __future__ import annotations

import itertools
import json
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from ..data import formats
from ..data.errors import ParameterError
from ..data.frames import LARGEST_FRAME, Frame
from ..data.plain_data import to_plain
from ..data.raster import Raster, check_numbers, numbers_in
from ..data.validation import changing_fields
from ..masks.parameters import MOVING
from ..spectral.equaliser import GAINS
from ..waves.kinds import KINDS
from .current import Current
from .ocean_parameters import OceanParameters, parse_json
from .surroundings import KEY as _AROUND
from .surroundings import Surroundings

#: path of the ocean time in seconds, if it does not simply follow the frames
OCEAN_TIME = "ocean_time"

#: what can change of what belongs to a sea, a layer or a patch: by the field that holds it
_OF_BELONGINGS = {"mask": MOVING, "equaliser": GAINS, "current": changing_fields(Current)}

#: what can change during a shot, by its path in the parameters' JSON; * is the number of a layer or patch
ANIMATED = (
    *dict.fromkeys(f"layers.*.{name}" for kind in KINDS for name in changing_fields(kind)),
    *changing_fields(OceanParameters),
    *(f"{owner}mask.{name}" for owner in ("", "layers.*.", "patches.*.") for name in MOVING),
    *(f"{owner}equaliser.{name}" for owner in ("", "layers.*.") for name in GAINS),
    *(f"current.{name}" for name in changing_fields(Current)),
    OCEAN_TIME,
)

#: paths of what changes of a current
_CURRENT = {f"current.{name}" for name in changing_fields(Current)}

#: samples of a value, one a frame; a raster has a row for each
Samples = tuple[float, ...] | Raster

_ONE_SEA = "later frames would show other waves"
#: why other values cannot be animated: first part of the path → reason
_CONSTANT = {
    "water": "depth, gravity and the liquid set the speed of every wave: " + _ONE_SEA,
    "dispersion": "it sets the speed of every wave: " + _ONE_SEA,
    "loop_duration": "it sets the speed of every wave: " + _ONE_SEA,
    "domain_size": "it sets which waves there are: " + _ONE_SEA,
    "resolution": "a sequence of images has one size",
    "seed": "another seed is another sea",
    "amplitudes": "other amplitudes are another sea",
    "patches": "they set which waves there are: " + _ONE_SEA,
    **{kind.former_list: kind.constant for kind in KINDS if kind.former_list},
    "timing": "a shot has one frame rate; animate ocean_time instead",
}
_NUMBERED = re.compile(r"(layers|patches)\.[0-9]{1,6}\.")
_MOST_SAMPLES = 1_000_000
#: numbers that describe one line of a mask
_ENDS = 4
_KEY = "animation"


class Moment(NamedTuple):
    """Everything that determines one frame.

    parameters : the sea of this frame
    time : ocean time, s, exact
    rate : seconds of ocean time per second of the shot
    """

    parameters: OceanParameters
    time: Fraction
    rate: float


@dataclass(frozen=True)
class Animation:
    """Animated values, one sample per frame.

    first_frame : frame of the first sample
    samples : path (see ANIMATED) and values, all of one length, in SI units and radians; for the lines of a
        mask, a raster with one row per frame

    Raises ParameterError for a path that cannot be animated and for values that are not finite numbers.
    """

    first_frame: int
    samples: tuple[tuple[str, Samples], ...]

    def __post_init__(self) -> None:
        if isinstance(self.first_frame, bool) or not isinstance(self.first_frame, int):
            raise ParameterError("first_frame", self.first_frame, "must be a whole number")
        if abs(self.first_frame) > LARGEST_FRAME:
            raise ParameterError("first_frame", self.first_frame, f"must be at most {LARGEST_FRAME} from 0")
        if not self.samples:
            raise ParameterError("samples", {}, f"must hold at least one of {', '.join(ANIMATED)}")
        for path, values in self.samples:
            _check_path(path)
            _check_values(path, values)
        lengths = {path: _length(values) for path, values in self.samples}
        if len(set(lengths.values())) > 1:
            raise ParameterError("samples", lengths, "must all have as many samples")
        settled = sorted(self.samples, key=lambda sample: sample[0])
        object.__setattr__(self, "samples", tuple((path, _settled(values)) for path, values in settled))

    @property
    def last_frame(self) -> int:
        """Frame of the last sample."""
        return self.first_frame + _length(self.samples[0][1]) - 1

    def at(self, frame: Frame) -> dict[str, float | Raster]:
        """Values by path at a frame, linear between samples. Raises ParameterError outside the samples."""
        if not self.first_frame <= frame <= self.last_frame:
            raise ParameterError(
                "frame", float(frame),
                f"lies outside the animation's samples, frames {self.first_frame} to {self.last_frame}: "
                "export the animation with the whole range of the shot",
            )  # fmt: skip
        index = math.floor(frame) - self.first_frame
        share = float(frame - math.floor(frame))
        return {path: _between(values, index, share) for path, values in self.samples}

    def rate(self, path: str, frame: Frame) -> float | None:
        """Rate of change of a value per frame: the slope between samples; at a sample, the mean of both
        sides."""
        values = dict(self.samples).get(path)
        if values is None or isinstance(values, Raster):
            return None
        position = Fraction(frame) - self.first_frame
        last = len(values) - 1
        sides = {math.ceil(position) - 1, math.floor(position)}
        slopes = [values[side + 1] - values[side] for side in sides if 0 <= side < last]
        return sum(slopes) / len(slopes) if slopes else 0.0

    def to_dict(self) -> dict[str, Any]:
        """Plain data, as in a JSON file."""
        return {
            "first_frame": self.first_frame,
            "samples": {
                path: values.to_plain() if isinstance(values, Raster) else list(values)
                for path, values in self.samples
            },
        }

    @classmethod
    def from_dict(cls, data: object) -> Animation:
        """An animation from plain data. Raises ParameterError naming what is wrong."""
        if not isinstance(data, dict) or set(data) != {"first_frame", "samples"}:
            raise ParameterError(_KEY, data, "must be an object with first_frame and samples")
        samples = data["samples"]
        if not isinstance(samples, dict):
            raise ParameterError(f"{_KEY}.samples", samples, "must be an object of lists")
        check_numbers(numbers_in(samples))
        try:
            known = tuple((path, _from_plain(path, values)) for path, values in samples.items())
            return cls(data["first_frame"], known)
        except ParameterError as error:
            raise error.inside(_KEY) from None


@dataclass(frozen=True)
class Shot:
    """A sea and its animation.

    around : where waves are baked that do not repeat; None where they are not

    Raises ParameterError for an animation that does not fit the sea.
    """

    parameters: OceanParameters
    animation: Animation | None = None
    around: Surroundings | None = None

    def __post_init__(self) -> None:
        if self.animation is not None and self.parameters.loop_duration is not None:
            for path in sorted(_CURRENT & set(dict(self.animation.samples))):
                reason = "is constant over a loop: remove its keys, or the loop"
                raise ParameterError(f"{_KEY}.samples.{path}", "animated", reason)
        for values in self._extremes():
            try:
                self._with(values)
            except ParameterError as error:
                raise error.inside(_KEY) from None
        if self.animation is not None:
            _check_times(self.animation, self.parameters)
            if self.parameters.has_coast:
                _check_beside_a_coast(self.animation)

    def _extremes(self) -> Iterator[dict[str, float | Raster]]:
        """The minimum and maximum of each value, and the longest lines; it suffices to check these, as
        allowed ranges have no gaps."""
        if self.animation is not None:
            for choose in (min, max):
                yield {
                    path: _longest(values) if isinstance(values, Raster) else choose(values)
                    for path, values in self.animation.samples
                }

    def _with(self, values: Mapping[str, float | Raster]) -> OceanParameters:
        entries: dict[str, list[Any]] = {
            "layers": list(self.parameters.layers), "patches": list(self.parameters.patches),
        }  # fmt: skip
        changes: dict[str, Any] = {}
        for path, value in values.items():
            owner, _, name = path.rpartition(".")
            known, _, rest = owner.partition(".")
            if path == OCEAN_TIME:
                continue
            if not owner:
                changes[name] = value
            elif owner in _OF_BELONGINGS:
                before = changes.get(owner, getattr(self.parameters, owner))
                changes[owner] = _belonging(before, owner, path, value)
            else:
                number, _, belonging = rest.partition(".")
                own, index = entries[known], int(number)
                if index >= len(own):
                    raise ParameterError(path, value, f"the sea has only {len(own)} {known}")
                own[index] = _changed(own[index], path, value, belonging)
        # without patches there are no entries to say anew
        patches = {"patches": tuple(entries["patches"])} if self.parameters.patches else {}
        return self.parameters.replace(layers=tuple(entries["layers"]), **patches, **changes)

    def at(self, frame: Frame) -> Moment:
        """The moment of a frame or subframe.

        Raises ParameterError for a frame outside the animation's samples.
        """
        timing = self.parameters.timing
        if self.animation is None:
            return Moment(self.parameters, timing.time(frame), float(1 / timing.stretch))
        values = self.animation.at(frame)
        time, rate = timing.time(frame), float(1 / timing.stretch)
        change = self.animation.rate(OCEAN_TIME, frame)
        if change is not None:
            time, rate = Fraction(repr(values[OCEAN_TIME])), change * float(timing.fps)
        return Moment(self._carried(self._with(values), frame, time), time, rate)

    def _carried(self, parameters: OceanParameters, frame: Frame, time: Fraction) -> OceanParameters:
        """A frame's sea with how far a current that changes has carried it: each frame's waves are those of
        the frame before, moved on."""
        animation, current = self.animation, parameters.current
        if animation is None or current is None or _CURRENT.isdisjoint(dict(animation.samples)):
            return parameters
        frames = (*range(animation.first_frame, math.ceil(frame)), frame)
        moments = [self._water(each) for each in frames]
        (x, y), then = moments[0]
        base = self.parameters.current or current
        come = base.carried_x + x * then, base.carried_y + y * then
        for (velocity, then), (next_velocity, later) in itertools.pairwise(moments):
            mean = (0.5 * (a + b) for a, b in zip(velocity, next_velocity, strict=True))
            come_x, come_y = (here + each * (later - then) for here, each in zip(come, mean, strict=True))
            come = come_x, come_y
        x, y = current.velocity
        now = float(time)
        current = replace(current, carried_x=come[0] - x * now, carried_y=come[1] - y * now)
        return parameters.replace(current=current)

    def _water(self, frame: Frame) -> tuple[tuple[float, float], float]:
        """The current in m/s at a frame, and the ocean's time in s."""
        assert self.animation is not None
        values, current = self.animation.at(frame), self.parameters.current
        for path in sorted(_CURRENT & values.keys()):
            current = _belonging(current, "current", path, values[path])
        assert current is not None
        time = values.get(OCEAN_TIME, float(self.parameters.timing.time(frame)))
        assert isinstance(time, float)
        return current.velocity, time

    def check(self, frames: tuple[Frame, ...]) -> None:
        """Raise ParameterError if a frame is outside the animation or its parameters are invalid."""
        for frame in (frames[0], frames[-1]):
            self.at(frame)

    @property
    def without_spray(self) -> Shot:
        """The same shot without spray."""
        if self.parameters.spray is None:
            return self
        return replace(self, parameters=self.parameters.replace(spray=None))

    def to_dict(self) -> dict[str, Any]:
        """The parameters' plain data, with the animation and the square around a camera if there are any."""
        belongings = {_KEY: self.animation, _AROUND: self.around}
        told = {key: each.to_dict() for key, each in belongings.items() if each is not None}
        return {**self.parameters.to_dict(), **told}

    def to_json(self, indent: int | None = 2) -> str:
        """JSON text from which `from_json` restores an equal shot."""
        return json.dumps({"format": formats.SEA, **self.to_dict()}, indent=indent, ensure_ascii=False)

    @classmethod
    def from_dict(cls, data: object) -> Shot:
        """A shot from plain data. Raises ParameterError naming what is wrong."""
        if not isinstance(data, dict):
            return cls(OceanParameters.from_dict(data))
        sea = {key: value for key, value in data.items() if key not in (_KEY, _AROUND)}
        around = Surroundings.from_dict(data[_AROUND]) if _AROUND in data else None
        animation = Animation.from_dict(data[_KEY]) if _KEY in data else None
        return cls(OceanParameters.from_dict(sea), animation, around)

    @classmethod
    def from_json(cls, text: str) -> Shot:
        """A shot from JSON text. Raises ParameterError for invalid JSON or an invalid shot."""
        return cls.from_dict(parse_json(text))


def time_text(time: Fraction) -> Any:
    """An exact time as text for JSON."""
    return to_plain(time)


def _check_path(path: str) -> None:
    if _NUMBERED.sub(r"\1.*.", path) in ANIMATED:
        return
    reason = _CONSTANT.get(path.partition(".")[0], f"only {', '.join(ANIMATED)} can change during a shot")
    raise ParameterError(f"samples.{path}", "animated", f"is constant over a shot: {reason}")


def _changed(entry: Any, path: str, value: float | Raster, belonging: str) -> Any:
    """A layer or a patch with another value, of its own or of its mask or equaliser."""
    if belonging:
        before = getattr(entry, belonging, None)
        return replace(entry, **{belonging: _belonging(before, belonging, path, value)})
    owner, _, name = path.rpartition(".")
    if name not in changing_fields(type(entry)):
        reason = f"is constant over a shot: {entry.constant}"
        raise ParameterError(f"samples.{path}", "animated", reason)
    try:
        return entry.changed(**{name: value})
    except ParameterError as error:
        raise error.inside(owner) from None


def _belonging(before: Any, name: str, path: str, value: float | Raster) -> Any:
    """A mask, an equaliser or a current with another value."""
    owner, _, field = path.rpartition(".")
    if before is None:
        raise ParameterError(
            f"samples.{path}", "animated", f"there is no {name}: give it one, or leave this out"
        )
    try:
        return replace(before, **{field: value})
    except ParameterError as error:
        raise error.inside(owner) from None


def _check_times(animation: Animation, parameters: OceanParameters) -> None:
    """Raise ParameterError where the time of measured spectra changes and nothing with it."""
    for path, _ in animation.samples:
        if path.endswith(".measured_time"):
            layer = parameters.layers[int(path.split(".")[1])]
            if getattr(layer, "definition", None) != "MEASURED":
                raise ParameterError(
                    f"{_KEY}.samples.{path}", "animated",
                    "changes nothing, as this layer's waves are not those measured: set its definition to "
                    "MEASURED, or leave this out",
                )  # fmt: skip


def _check_beside_a_coast(animation: Animation) -> None:
    """Raise ParameterError where waves change whose way over a bed is made once for a whole shot."""
    for path, _ in animation.samples:
        if path.startswith("layers."):
            raise ParameterError(
                f"{_KEY}.samples.{path}", "animated",
                "must stay the same in a sea with a coast, over whose bed each frame's waves would have to "
                "be followed anew: remove it, or set coast.muted",
            )  # fmt: skip


def _length(values: Samples) -> int:
    return values.shape[0] if isinstance(values, Raster) else len(values)


def _settled(values: Samples) -> Samples:
    return values if isinstance(values, Raster) else tuple(float(value) for value in values)


def _between(values: Samples, index: int, share: float) -> float | Raster:
    """Linear interpolation between a sample and the next one."""
    if isinstance(values, Raster):
        rows = values.values[index : index + 2].astype(np.float64)
        return Raster(rows[:1] + share * (rows[1:] - rows[:1]) if share else rows[:1], values.name)
    return values[index] + share * (values[index + 1] - values[index]) if share else values[index]


def _longest(lines: Raster) -> Raster:
    """The row that contains the longest line along an axis."""
    x0, y0, x1, y1 = np.moveaxis(lines.values, -1, 0)
    longest = np.maximum(np.abs(x1 - x0), np.abs(y1 - y0)).max(axis=1)
    return Raster(lines.values[int(np.argmax(longest))][np.newaxis], lines.name)


def _from_plain(path: str, values: object) -> Samples:
    if isinstance(values, dict) and path.endswith(".lines"):
        return Raster.from_plain(values)
    if not isinstance(values, list):
        raise ParameterError(f"samples.{path}", values, "must be a list with a number per frame")
    return tuple(values)


def _check_values(path: str, values: Samples) -> None:
    if isinstance(values, Raster) or path.endswith(".lines"):
        if not (isinstance(values, Raster) and path.endswith(".lines") and values.shape[2] == _ENDS):
            reason = f"must be numbers; lines of a mask a raster with a row per frame and {_ENDS} channels"
            raise ParameterError(f"samples.{path}", type(values).__name__, reason)
        return
    if not 1 <= len(values) <= _MOST_SAMPLES:
        raise ParameterError(f"samples.{path}", f"{len(values)} values", f"must be from 1 to {_MOST_SAMPLES}")
    for index, value in enumerate(values):
        if not _is_finite(value):
            raise ParameterError(f"samples.{path}.{index}", value, "must be a finite number")


def _is_finite(value: object) -> bool:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer beyond the range of floats
        return False
