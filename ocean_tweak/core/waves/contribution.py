# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface of a kind of waves: one class per kind, whose instances are the layers of a sea.

All code that needs information about a sea's waves calls these methods, in the order of `kinds.KINDS`; the
defaults contribute nothing. Instance methods are called for each layer that is not muted; class methods once
per sea, for kinds whose layers act together.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, replace
from enum import Flag, auto
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from ..data.errors import ParameterError
from ..data.validation import LARGEST_INTEGER, Off, Validated, angle, integer, number, switch

if TYPE_CHECKING:
    from ..masks.parameters import Mask
    from ..numerics.grid import WaveVectorGrid
    from ..parameters.current import Current
    from ..parameters.ocean_parameters import OceanParameters
    from ..spectral.directional_spectrum import DirectionalSpectrum
    from ..spectral.sea_state import SeaState
    from ..synthesis.coefficients import Coefficients

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]

#: a component of the displacement, 0…2, and the variable of its derivative: "", "x", "y" or "t"
Key = tuple[int, str]

#: ends of an unlimited band of wavelengths, m
NO_SHORTEST, NO_LONGEST = 0.0, 1e6

_WHOLE = "Blender's whole numbers"


class Gives(Flag):
    """What the waves of a kind provide."""

    #: a spectrum from which the sea draws random waves: `directional_spectrum`
    SPECTRUM = auto()
    #: coefficients on the sea's own grid: `add`
    COEFFICIENTS = auto()
    #: coefficients of displacements that are not the gradient of a potential: `shares`
    SHARES = auto()
    #: displacements at any places, not necessarily periodic: `fields`
    FIELDS = auto()
    #: their heights and periods: `state`
    STATE = auto()
    #: waves that loop with the sea
    LOOPS = auto()


#: the ways in which waves enter a sea
WAVES = Gives.SPECTRUM | Gives.COEFFICIENTS | Gives.SHARES | Gives.FIELDS


class Names(NamedTuple):
    """How a kind is presented in the user interface.

    number : its value in .blend files and its position in menus and lists; never reused for another kind
    settings : name of the layer's property group in .blend files that holds its settings; "" for the layer
        itself
    noun : its name within a sentence
    label, description, icon : of the kind, in lists
    entry : label in the menu that adds a layer; "" for `label`
    """

    number: int
    settings: str
    noun: str
    label: str
    description: str
    icon: str
    entry: str = ""


class Wind(NamedTuple):
    """A wind at 10 m that makes whitecaps, m/s and rad."""

    speed: float
    direction: float


@dataclass(frozen=True)
class MemoryNeed:
    """Memory use of a sea, in bytes.

    state : kept for the lifetime of the sea: coefficients, frequencies, random numbers
    building : additional, while the state is computed
    surface : for each surface computed at the same time: its fields and the arrays between the passes
    """

    state: int
    building: int
    surface: int

    def peak(self, surfaces: int = 1) -> int:
        """Peak memory with a number of surfaces at the same time."""
        return self.state + max(self.building, surfaces * self.surface)


class BlockShares(Protocol):
    """Contributions to a block of columns, at one time."""

    def add(self, component: int, rate: bool, target: ComplexArray, factor: float = 1.0) -> None:
        """Add the share in P[component], or in its rate, times `factor` to coefficients (columns, N)."""


class Shares(Protocol):
    """Contributions at one time."""

    def of_block(self, block: slice, scale: float = 1.0) -> BlockShares:
        """The contributions to a block of columns kx, times `scale`."""


class OwnFoam(NamedTuple):
    """Foam that a layer makes beside that of breaking waves, (places,) float32.

    foam, breaking : how much there is, and of it what is thrown up now, 0…1
    age : s
    """

    foam: RealArray
    breaking: RealArray
    age: RealArray


class OwnSpray(NamedTuple):
    """Water that a layer throws up beside that of breaking waves.

    strength : (places,) 1 where it is as much as a wind of 17 m/s tears off a crest that breaks
    velocity : (places, 3) of this water, m/s
    """

    strength: Array
    velocity: Array


class HullPlace(NamedTuple):
    """Where a hull is on the water, m and rad: its middle, and the direction of its bow from +x."""

    x: float
    y: float
    heading: float
    length: float
    beam: float
    draught: float


class Sharing(Protocol):
    """Computes contributions to the coefficients of the displacement's components."""

    def shares(self, time: float, still: bool, moving: bool, dtype: type, workers: int = 1) -> Shares:
        """The contributions at a time in s: to positions if `still`, and to rates if `moving`."""


class Outlook(Protocol):
    """A summary of a kind's layers, without computing any waves."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each, with the remedy."""

    def lines(self) -> list[str]:
        """The lines that `info` prints."""

    def to_plain(self) -> Any:
        """The data that `info --json` prints."""


class Contribution(Validated):
    """The waves of one layer.

    kind : its name in JSON
    gives, names : see `Gives` and `Names`
    former_list : name of this kind's own list in format version 1; "" for none
    constant : why its fields, unless marked otherwise, cannot be animated
    """

    kind: ClassVar[str]
    gives: ClassVar[Gives]
    names: ClassVar[Names]
    former_list: ClassVar[str] = ""
    constant: ClassVar[str] = "it sets which waves there are: the next frame would show other waves"

    muted: bool
    mask: Mask | None = None  # for a kind without such a field
    id: int = -1

    @classmethod
    def has(cls, field: str) -> bool:
        """Whether layers of this kind have a field."""
        return field in {own.name for own in fields(cls)}  # type: ignore[arg-type]  # each is a dataclass

    @classmethod
    def to_begin_with(cls, sea: OceanParameters, time: float) -> Self:
        """A new layer with defaults that suit a sea at a time in s."""
        return cls()

    def changed(self, **changes: Any) -> Self:
        """A copy with other values of some fields."""
        return replace(self, **changes)  # type: ignore[type-var]  # each kind is a dataclass

    def check(self, sea: OceanParameters, path: str) -> None:
        """Raise ParameterError, with a remedy, if a sea cannot have this layer. `path` is the layer's path in
        the sea."""

    @classmethod
    def check_together(cls, sea: OceanParameters) -> None:
        """Raise ParameterError if a sea cannot have all of its layers of this kind."""

    def is_held(self, sea: OceanParameters, resolution: int) -> bool:
        """Whether a grid with this many samples can hold its waves; if not, the layer is muted."""
        return True

    def in_patch(self, sea: OceanParameters, patch: int, rotation: float) -> Self | None:
        """The part of the layer that a patch holds, in the patch's axes, which are rotated by `rotation` rad;
        by default the first patch holds all."""
        return self if patch == 0 else None

    def directional_spectrum(self, sea: OceanParameters) -> DirectionalSpectrum | None:
        """The spectrum of waves that the sea draws; None in a calm."""
        return None

    def add(self, sea: OceanParameters, to: Coefficients) -> None:
        """Add its waves to the coefficients, and their expected energy over all seeds."""

    def frequencies(self, sea: OceanParameters, grid: WaveVectorGrid) -> Array | None:
        """ω ≥ 0 in rad/s without a loop, (N, N//2+1), of waves that it added with frequencies of their
        own."""
        return None

    @classmethod
    def shares(cls, sea: OceanParameters) -> Sharing | None:
        """Computes its coefficients that are not the gradient of a potential."""
        return None

    def fields(
        self, sea: OceanParameters, x: Array, y: Array, time: float | Fraction, keys: Iterable[Key]
    ) -> Mapping[Key, RealArray]:
        """Components of the displacement at rest positions in m, of one flat shape, choppiness applied."""
        return {}

    @property
    def makes_foam(self) -> bool:
        """Whether it has any `own_foam` or `own_spray`."""
        return False

    def hull_at(self, time: float | Fraction) -> HullPlace | None:
        """The hull that makes its waves, at a time in s; None without any."""
        return None

    def own_foam(self, sea: OceanParameters, x: Array, y: Array, time: float | Fraction) -> OwnFoam | None:
        """Foam beside that of breaking waves, at rest positions in m, of one flat shape; None without any."""
        return None

    def own_spray(
        self, sea: OceanParameters, x: Array, y: Array, time: float | Fraction, height: Array, velocity: Array
    ) -> OwnSpray | None:
        """Spray beside that of breaking waves, at rest positions in m, of one flat shape; None without any.

        height, velocity : of the water there, above calm water or beside the hull that rides it, in m,
            (places,), and (places, 3) in m/s
        """
        return None

    def in_current(self, current: Current) -> Self:
        """The layer as the water has it that a current moves: what is fixed to the ground goes against it."""
        return self

    def strain_covariances(
        self, sea: OceanParameters, drift: tuple[float, float]
    ) -> tuple[Array, Array] | None:
        """For waves given as fields: covariances (3, 3) of xx, yy and xy of the displacement's gradient, and
        of their rates."""
        return None

    def state(self, sea: OceanParameters) -> SeaState | None:
        """State of all of its waves, whether a grid resolves them or not."""
        return None

    def longest_random_wave(self, sea: OceanParameters) -> float:
        """Peak wavelength in m of waves whose height varies with the seed; NaN for none."""
        return float("nan")

    def slope_variance(self, sea: OceanParameters, resolution: int | None) -> float:
        """Mean square slope of waves without a spectrum: of all, or of those on a grid with this many
        samples."""
        return 0.0

    def wind(self, sea: OceanParameters) -> Wind | None:
        """The wind that makes these waves break into whitecaps; None for swell."""
        return None

    @classmethod
    def memory(cls, sea: OceanParameters, real: int, moving: bool) -> MemoryNeed:
        """Memory that its layers use besides the sea's own coefficients.

        real : bytes per real number
        moving : whether rates are computed
        """
        return MemoryNeed(0, 0, 0)

    def warnings(self, sea: OceanParameters) -> Iterable[str]:
        """Warnings for the sea's statistics, one sentence each, with a remedy."""
        return ()

    @classmethod
    def outlook(cls, sea: OceanParameters) -> Outlook | None:
        """Summary of its layers, for waves that the sea's statistics do not include."""
        return None


def direction(
    description: str = "Direction towards which the waves run, counter-clockwise from +x",
    changes: bool = False,
) -> Any:
    """Marks a field: the direction towards which the layer's waves or wind go."""
    return angle(description, changes=changes)


def wind_speed(description: str, changes: bool = False) -> Any:
    """Marks a field: the speed of the wind that raises the layer's waves."""
    why = "from calm to beyond the strongest hurricane"
    return number(12.0, 0.0, 100.0, "m/s", description, why, useful=(0.0, 50.0), changes=changes)


def wave_height(default: float, description: str) -> Any:
    """Marks a field: a height of waves."""
    return number(default, 0.0, 100.0, "m", description, "three times the largest ever measured")


def shortest_wavelength(description: str) -> Any:
    """Marks a field: the short end of a band of wavelengths."""
    off = Off(NO_SHORTEST, 1.0, "keeps all short waves")
    return number(NO_SHORTEST, 0.0, 1e6, "m", description, "any domain", off=off)


def longest_wavelength(description: str) -> Any:
    """Marks a field: the long end of a band of wavelengths."""
    off = Off(NO_LONGEST, 100.0, "keeps all long waves")
    return number(NO_LONGEST, 1e-3, 1e6, "m", description, "any domain", off=off)


def check_band(shortest: float, longest: float) -> None:
    """Raise ParameterError for a band, in m, that holds no wavelength."""
    if shortest >= longest:
        reason = f"must be below longest_wavelength = {longest:g} m"
        raise ParameterError("shortest_wavelength", shortest, reason)


def amplitude_scale(description: str = "Multiplies the wave height", changes: bool = False) -> Any:
    """Marks a field: what the height of the layer's waves is multiplied by."""
    why = "an artist's scale"
    return number(1.0, 0.0, 100.0, "", description, why, useful=(0.0, 2.0), changes=changes)


def muted() -> Any:
    """Marks a field: whether the layer is muted."""
    return switch(False, "Leave the layer out; no other layer changes")


def identity() -> Any:
    """Marks a field: the id of the layer among those of its kind."""
    description = "Identity of the layer, from which its seed follows; -1 is the first free one"
    return integer(-1, -1, LARGEST_INTEGER, description, _WHOLE)


def own_seed(what: str = "Seed of this layer alone") -> Any:
    """Marks a field: the seed of the layer's random numbers."""
    derived = Off(-1, 0, "follows from the ocean's seed and the layer's id")
    return integer(-1, -1, LARGEST_INTEGER, what, _WHOLE, off=derived)
