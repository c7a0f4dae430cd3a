# SPDX-License-Identifier: GPL-3.0-or-later
"""What a kind of waves can tell and give: one class a kind, whose instances are the layers of a sea.

Whatever needs to know of a sea's waves asks these methods, in the order of `kinds.KINDS`, and each of them
says nothing by default. A method of a layer is asked for those that are not muted; one of the class is asked
once a sea that has such layers, which act together.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, replace
from enum import Flag, auto
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from ..data.validation import Off, Validated, integer, number, switch

if TYPE_CHECKING:
    from ..masks.parameters import Mask
    from ..numerics.grid import WaveVectorGrid
    from ..parameters.ocean_parameters import OceanParameters
    from ..spectral.directional_spectrum import DirectionalSpectrum
    from ..spectral.sea_state import SeaState
    from ..synthesis.coefficients import Coefficients

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]

#: a component of the displacement, 0…2, and what it is differentiated by: "", "x", "y" or "t"
Key = tuple[int, str]

_LARGEST = 2**31 - 1
_WHOLE = "Blender's whole numbers"


class Gives(Flag):
    """What the waves of a kind are, and what is told of them."""

    #: a spectrum, from which the sea draws its waves: `directional_spectrum`
    SPECTRUM = auto()
    #: coefficients on the sea's own grid: `add`
    COEFFICIENTS = auto()
    #: coefficients of displacements that are no gradient of a potential: `shares`
    SHARES = auto()
    #: displacements at any places, which need not repeat with the domain: `fields`
    FIELDS = auto()
    #: their heights and periods: `state`
    STATE = auto()
    #: waves that repeat in time where the sea does
    LOOPS = auto()


#: how waves come into a sea
WAVES = Gives.SPECTRUM | Gives.COEFFICIENTS | Gives.SHARES | Gives.FIELDS


class Names(NamedTuple):
    """How a kind looks in the window.

    number : what .blend files hold for it, and its place in menus and lists: never that of another kind
    settings : of the property of a layer in .blend files that holds the settings; "" for the layer itself
    noun : in the middle of a sentence
    label, description, icon : of the kind, in lists
    entry : of the menu that adds a layer; "" for the label
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
    """Bytes that a sea takes.

    state : kept as long as the sea: coefficients, frequencies, random numbers
    building : on top of it, while the state is made
    surface : of each surface that is made at the same time: its fields and the arrays between the passes
    """

    state: int
    building: int
    surface: int

    def peak(self, surfaces: int = 1) -> int:
        """The most that is taken at once, with a number of surfaces at the same time."""
        return self.state + max(self.building, surfaces * self.surface)


class BlockShares(Protocol):
    """Coefficients of a block of columns, at one time."""

    def add(self, component: int, rate: bool, target: ComplexArray, factor: float = 1.0) -> None:
        """Add the share in P[component], or in its rate, times `factor` to coefficients (columns, N)."""


class Shares(Protocol):
    """Coefficients at one time."""

    def of_block(self, block: slice, scale: float = 1.0) -> BlockShares:
        """Those of a block of columns kx, times `scale`."""


class Sharing(Protocol):
    """What adds coefficients of the displacement's components at a time."""

    def shares(self, time: float, still: bool, moving: bool, dtype: type, workers: int = 1) -> Shares:
        """What is added at a time in s: to positions, where `still`, and to rates, where `moving`."""


class Outlook(Protocol):
    """What to expect of a kind's layers, told without making any waves."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each, with the remedy."""

    def lines(self) -> list[str]:
        """What `info` says."""

    def to_plain(self) -> Any:
        """What `info --json` says."""


class Contribution(Validated):
    """The waves of one layer.

    kind : its name in JSON
    gives, names : see there
    former_list : the list in which JSON had such layers before there was one list for all; "" for none
    constant : why nothing of it, but for fields that say so, can change during a shot
    """

    kind: ClassVar[str]
    gives: ClassVar[Gives]
    names: ClassVar[Names]
    former_list: ClassVar[str] = ""
    constant: ClassVar[str] = "it sets which waves there are: the next frame would show other waves"

    muted: bool
    mask: Mask | None = None  # of a kind without such a field
    id: int = -1

    @classmethod
    def has(cls, field: str) -> bool:
        """Whether layers of the kind have a field."""
        return field in {own.name for own in fields(cls)}  # type: ignore[arg-type]  # each is a dataclass

    @classmethod
    def to_begin_with(cls, sea: OceanParameters, time: float) -> Self:
        """A new layer that fits a sea at a time in s."""
        return cls()

    def changed(self, **changes: Any) -> Self:
        """A copy with other values of some fields."""
        return replace(self, **changes)  # type: ignore[type-var]  # each kind is a dataclass

    def check(self, sea: OceanParameters, path: str) -> None:
        """Raise ParameterError, with the remedy, where a sea cannot have such a layer at a path in it."""

    @classmethod
    def check_together(cls, sea: OceanParameters) -> None:
        """Raise ParameterError where it cannot have all of its layers."""

    def is_held(self, sea: OceanParameters, resolution: int) -> bool:
        """Whether so many samples hold its waves; a sea on fewer of them mutes the layer."""
        return True

    def in_patch(self, sea: OceanParameters, patch: int, rotation: float) -> Self | None:
        """What a patch that is turned by `rotation` rad holds of it, in its axes: the first all."""
        return self if patch == 0 else None

    def directional_spectrum(self, sea: OceanParameters) -> DirectionalSpectrum | None:
        """Of waves that the sea draws; None in a calm."""
        return None

    def add(self, sea: OceanParameters, to: Coefficients) -> None:
        """Add its waves to coefficients, and what of their energy is expected over all seeds."""

    def frequencies(self, sea: OceanParameters, grid: WaveVectorGrid) -> Array | None:
        """ω ≥ 0 in rad/s without a loop, (N, N//2+1), of waves that it added with ones of their own."""
        return None

    @classmethod
    def shares(cls, sea: OceanParameters) -> Sharing | None:
        """What makes the coefficients that are no gradient of a potential."""
        return None

    def fields(
        self, sea: OceanParameters, x: Array, y: Array, time: float | Fraction, keys: Iterable[Key]
    ) -> Mapping[Key, RealArray]:
        """Components of the displacement at rest positions in m, of one flat shape, choppiness applied."""
        return {}

    def strain_covariances(
        self, sea: OceanParameters, drift: tuple[float, float]
    ) -> tuple[Array, Array] | None:
        """Of waves given as fields: (3, 3) of xx, yy and xy of the displacement's gradient, and of rates."""
        return None

    def state(self, sea: OceanParameters) -> SeaState | None:
        """Heights and periods of all of its waves, whether a grid resolves them or not."""
        return None

    def longest_random_wave(self, sea: OceanParameters) -> float:
        """Wavelength in m at the peak of what differs in height from seed to seed; NaN for nothing."""
        return float("nan")

    def slope_variance(self, sea: OceanParameters, resolution: int | None) -> float:
        """Mean square slope of the waves that are no spectrum's: of all, or of those on so many samples."""
        return 0.0

    def wind(self, sea: OceanParameters) -> Wind | None:
        """The wind that makes whitecaps on these waves; None without one: swell does not break."""
        return None

    @classmethod
    def memory(cls, sea: OceanParameters, real: int, moving: bool) -> MemoryNeed:
        """Bytes that its layers take beside the sea's own coefficients.

        real : bytes of a real number
        moving : whether rates are wanted
        """
        return MemoryNeed(0, 0, 0)

    def warnings(self, sea: OceanParameters) -> Iterable[str]:
        """What the sea's statistics warn of, one sentence each, with the remedy."""
        return ()

    @classmethod
    def outlook(cls, sea: OceanParameters) -> Outlook | None:
        """What to expect of its layers, of waves that the sea's heights are without."""
        return None


def direction(
    description: str = "Direction towards which the waves run, counter-clockwise from +x",
    changes: bool = False,
) -> Any:
    """A field: where a layer's waves or its wind go."""
    why = "any number of turns, to the precision of a float"
    return number(0.0, -1e6, 1e6, "rad", description, why, changes=changes)


def muted() -> Any:
    """A field: whether a layer takes part."""
    return switch(False, "Leave the layer out; no other layer changes")


def identity() -> Any:
    """A field: what tells a layer from others of its kind."""
    description = "Identity of the layer, from which its seed follows; -1 is the first free one"
    return integer(-1, -1, _LARGEST, description, _WHOLE)


def own_seed(what: str = "Seed of this layer alone") -> Any:
    """A field: the seed of a layer's random numbers."""
    derived = Off(-1, 0, "follows from the ocean's seed and the layer's id")
    return integer(-1, -1, _LARGEST, what, _WHOLE, off=derived)
