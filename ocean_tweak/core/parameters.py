# SPDX-License-Identifier: GPL-3.0-or-later
"""What a sea is: frozen, validated, hashable parameters in SI units and radians, JSON both ways.

Every field carries its unit, its range and its description in the field's metadata, which is the one
table that validation, tooltips, the command line and the documentation read.
"""

from __future__ import annotations

import dataclasses
import difflib
import json
import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from . import constants

SPECTRA = ("TMA",)
SPREADINGS = ("DONELAN_BANNER",)
DISPERSIONS = ("CAPILLARY", "FINITE_DEPTH", "DEEP")


class ParameterError(ValueError):
    """A parameter that cannot be used: names the field, its value and what is allowed."""

    def __init__(self, field: str, value: object, reason: str) -> None:
        self.field = field
        self.value = value
        self.reason = reason
        super().__init__(f"{field} = {_shown(value)}: {reason}")

    def inside(self, container: str) -> ParameterError:
        """The same error with the field's path lengthened at the front."""
        return ParameterError(f"{container}.{self.field}", self.value, self.reason)


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."


def number(
    default: float, minimum: float, maximum: float, unit: str, description: str, why: str = ""
) -> Any:
    """A real-valued dataclass field with its range, unit, description and the reason for the range."""
    return dataclasses.field(
        default=default,
        metadata={
            "kind": float, "minimum": minimum, "maximum": maximum,
            "unit": unit, "description": description, "why": why,
        },
    )  # fmt: skip


def integer(default: int, minimum: int, maximum: int, description: str, why: str = "") -> Any:
    """A whole-number dataclass field with its range."""
    return dataclasses.field(
        default=default,
        metadata={
            "kind": int, "minimum": minimum, "maximum": maximum,
            "unit": "", "description": description, "why": why,
        },
    )  # fmt: skip


def choice(default: str, choices: tuple[str, ...], description: str) -> Any:
    """A dataclass field that is one of the given names."""
    return dataclasses.field(
        default=default, metadata={"kind": str, "choices": choices, "description": description}
    )


def switch(default: bool, description: str) -> Any:
    """A dataclass field that is on or off."""
    return dataclasses.field(default=default, metadata={"kind": bool, "description": description})


def _range_text(minimum: float, maximum: float, unit: str) -> str:
    span = f"from {minimum:g} to {maximum:g}" if math.isfinite(maximum) else "of any size"
    return f"{span} {unit}".rstrip()


def _checked_number(name: str, value: object, meta: Any) -> float:
    allowed = _range_text(meta["minimum"], meta["maximum"], meta["unit"])
    if isinstance(value, bool) or not hasattr(value, "__float__"):
        raise ParameterError(name, value, f"must be a number {allowed}")
    result = float(value)
    if not math.isfinite(result):
        raise ParameterError(name, value, f"must be a finite number {allowed}")
    if not meta["minimum"] <= result <= meta["maximum"]:
        raise ParameterError(name, value, f"must be {allowed}")
    return result + 0.0  # -0.0 and 0.0 are the same sea and must hash alike in JSON


def _checked_integer(name: str, value: object, meta: Any) -> int:
    allowed = _range_text(meta["minimum"], meta["maximum"], meta["unit"])
    whole = hasattr(value, "__index__") or (isinstance(value, float) and value.is_integer())
    if isinstance(value, bool) or not whole:
        raise ParameterError(name, value, f"must be a whole number {allowed}")
    result = int(value)  # type: ignore[call-overload]
    if not meta["minimum"] <= result <= meta["maximum"]:
        raise ParameterError(name, value, f"must be {allowed}")
    return int(result)


def _checked(field: dataclasses.Field[Any], value: object) -> object:
    meta = field.metadata
    kind = meta.get("kind")
    if kind is float:
        return _checked_number(field.name, value, meta)
    if kind is int:
        return _checked_integer(field.name, value, meta)
    if kind is str and value not in meta["choices"]:
        raise ParameterError(field.name, value, "must be one of " + ", ".join(meta["choices"]))
    if kind is bool and not isinstance(value, bool):
        raise ParameterError(field.name, value, "must be true or false")
    return value


class _Validated:
    """Checks each field against its metadata when an instance is made."""

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):  # type: ignore[arg-type]
            object.__setattr__(self, field.name, _checked(field, getattr(self, field.name)))


@dataclass(frozen=True)
class Water(_Validated):
    """The body of water: the same for every wave layer."""

    depth: float = number(
        200.0, 0.1, 11e3, "m", "Depth of the water. Long waves lose height where it is shallow",
        "from a puddle to the deepest trench",
    )  # fmt: skip
    gravity: float = number(
        constants.GRAVITY, 0.1, 100.0, "m/s²", "Gravitational acceleration", "from a small moon to a gas giant"
    )
    density: float = number(
        constants.WATER_DENSITY, 100.0, 20e3, "kg/m³", "Density of the liquid", "liquids up to mercury"
    )
    surface_tension: float = number(
        constants.SURFACE_TENSION, 0.0, 1.0, "N/m", "Surface tension, felt by waves of a few centimetres",
        "liquids up to mercury",
    )  # fmt: skip


@dataclass(frozen=True)
class WaveLayer(_Validated):
    """One wave system: a wind over a fetch, with its spectrum and its spreading."""

    spectrum: str = choice("TMA", SPECTRA, "How the energy is shared among wavelengths")
    wind_speed: float = number(
        12.0, 0.1, 100.0, "m/s", "Mean wind speed 10 m above the water. Sets wave height and length",
        "from calm to beyond the strongest hurricane",
    )  # fmt: skip
    wind_direction: float = number(
        0.0, -1e6, 1e6, "rad", "Direction towards which the wind blows, counter-clockwise from +x"
    )
    fetch: float = number(
        150e3, 1.0, 20e6, "m", "Distance of open water over which the wind has blown",
        "from a pond to half the Earth's circumference",
    )  # fmt: skip
    limit_fetch: bool = switch(True, "End the growth of the sea where it is fully developed for its wind")
    spreading: str = choice("DONELAN_BANNER", SPREADINGS, "How the energy is shared among directions")
    swell: float = number(
        0.3, 0.0, 4.0, "", "Draws waves out into long parallel trains; 0 to 1 is the useful range",
        "beyond 4 a wave train is a single direction",
    )  # fmt: skip
    gain: float = number(
        1.0, 0.0, 100.0, "", "Multiplies the layer's wave height; 1 is the physical one", "an artist's gain"
    )


@dataclass(frozen=True)
class Timing:
    """How frames of the shot become seconds: ocean time 0 is at ``start_frame``.

    ``fps`` is kept as an exact fraction, so that 24000/1001 is what it says.
    """

    fps: Fraction = Fraction(24)
    start_frame: int = integer(1, -1_000_000, 10_000_000, "Frame at which the ocean's time is zero")

    def __post_init__(self) -> None:
        object.__setattr__(self, "fps", _checked_fps(self.fps))
        field = next(f for f in dataclasses.fields(self) if f.name == "start_frame")
        object.__setattr__(self, "start_frame", _checked(field, self.start_frame))

    def time(self, frame: float | Fraction) -> float:
        """Ocean time in seconds at a frame, which may hold a sub-frame."""
        return float((Fraction(frame) - self.start_frame) / self.fps)


def _checked_fps(value: object) -> Fraction:
    allowed = "must be a number of frames per second from 0.01 to 1000, or a fraction such as \"24000/1001\""
    try:
        if isinstance(value, bool) or not isinstance(value, (int, float, str, Fraction)):
            raise TypeError
        fps = Fraction(str(value).strip())
    except (TypeError, ValueError, ZeroDivisionError):
        raise ParameterError("fps", value, allowed) from None
    if not Fraction(1, 100) <= fps <= 1000 or fps.denominator > 10**9:
        raise ParameterError("fps", value, allowed)
    return fps


@dataclass(frozen=True)
class OceanParameters(_Validated):
    """Everything that determines a sea. Equal parameters give equal fields.

    Raises ParameterError (a ValueError) naming the field, its value and what is allowed.
    """

    resolution: int = integer(
        512, 16, 8192, "Samples along each side of the domain, an even number",
        "below 16 there is no sea, above 8192 no memory",
    )  # fmt: skip
    domain_size: float = number(
        400.0, 0.1, 100e3, "m", "Side of the square patch, which repeats without a seam",
        "a wave vector is told apart from its neighbours up to 100 km",
    )  # fmt: skip
    seed: int = integer(0, 0, 2**31 - 1, "Number of this particular sea among all with these parameters")
    choppiness: float = number(
        1.0, 0.0, 4.0, "", "Horizontal displacement that sharpens crests; 1 is linear wave theory",
        "far beyond 1 the surface folds",
    )  # fmt: skip
    dispersion: str = choice("CAPILLARY", DISPERSIONS, "How fast a wave of a given length travels")
    water: Water = Water()
    layers: tuple[WaveLayer, ...] = (WaveLayer(),)
    timing: Timing = Timing()

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.resolution % 2:
            raise ParameterError("resolution", self.resolution, "must be an even number from 16 to 8192")
        object.__setattr__(self, "layers", _instances("layers", self.layers, WaveLayer))
        for name, kind in (("water", Water), ("timing", Timing)):
            if not isinstance(getattr(self, name), kind):
                raise ParameterError(name, getattr(self, name), f"must be a {kind.__name__}")

    def replace(self, **changes: Any) -> OceanParameters:
        """A copy with some fields changed, validated anew."""
        return dataclasses.replace(self, **changes)

    def to_dict(self) -> dict[str, Any]:
        """Plain dictionaries, lists and numbers, as they stand in a JSON file."""
        return _to_plain(self)  # type: ignore[no-any-return]

    def to_json(self, indent: int | None = 2) -> str:
        """JSON text that `from_json` reads back to equal parameters."""
        return json.dumps(self.to_dict(), indent=indent, ensure_ascii=False)

    @classmethod
    def from_dict(cls, data: object) -> OceanParameters:
        """Parameters from plain dictionaries; what is missing keeps its default, unknown keys are refused."""
        return _from_plain(cls, data)  # type: ignore[no-any-return]

    @classmethod
    def from_json(cls, text: str) -> OceanParameters:
        """Parameters from JSON text. Raises ParameterError for what is not valid JSON or not valid."""
        return cls.from_dict(parse_json(text))


def parse_json(text: str) -> Any:
    """JSON text as plain data, with duplicate keys refused. Raises ParameterError."""
    try:
        return json.loads(text, object_pairs_hook=_unique_keys)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise ParameterError("JSON", text[:40], f"is not valid JSON at {place}: {error.msg}") from None
    except RecursionError:
        raise ParameterError("JSON", text[:40], "is nested too deeply") from None


def _unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for key, value in pairs:
        if key in result:
            raise ParameterError(key, value, "stands twice in the same JSON object")
        result[key] = value
    return result


def _instances(name: str, values: object, kind: type) -> tuple[Any, ...]:
    if not isinstance(values, (tuple, list)) or not all(isinstance(v, kind) for v in values):
        raise ParameterError(name, values, f"must be a sequence of {kind.__name__}")
    if not 1 <= len(values) <= 64:
        raise ParameterError(name, f"{len(values)} entries", "must have from 1 to 64 entries")
    return tuple(values)


_NESTED = {"water": Water, "timing": Timing}
_NESTED_LISTS = {"layers": WaveLayer}


def _to_plain(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        return {f.name: _to_plain(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, tuple):
        return [_to_plain(item) for item in value]
    if isinstance(value, Fraction):
        return value.numerator if value.denominator == 1 else str(value)
    return value


def _from_plain(cls: type, data: object) -> Any:
    if not isinstance(data, dict):
        raise ParameterError(cls.__name__, data, "must be a JSON object")
    known = [f.name for f in dataclasses.fields(cls)]
    arguments = {}
    for key, value in data.items():
        if key not in known:
            raise ParameterError(str(key), value, _unknown_key(str(key), known))
        try:
            arguments[key] = _nested_value(key, value)
        except ParameterError as error:
            raise error.inside(key) from None
    return cls(**arguments)


def _nested_value(key: str, value: object) -> object:
    if key in _NESTED:
        return _from_plain(_NESTED[key], value)
    if key in _NESTED_LISTS and isinstance(value, list):
        items = []
        for index, item in enumerate(value):
            try:
                items.append(_from_plain(_NESTED_LISTS[key], item))
            except ParameterError as error:
                raise error.inside(str(index)) from None
        return tuple(items)
    return value


def _unknown_key(key: str, known: list[str]) -> str:
    near = difflib.get_close_matches(key, known, n=1)
    hint = f"did you mean {near[0]}? " if near else ""
    return f"unknown key; {hint}Known keys: {', '.join(known)}"
