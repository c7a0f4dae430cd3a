# SPDX-License-Identifier: GPL-3.0-or-later
"""The parameters of a sea: frozen, validated and hashable, in SI units and radians, with conversion to and
from JSON.

Each field's metadata holds its unit, range and description, which validation, tooltips, the command line and
the documentation all use.
"""

from __future__ import annotations

import dataclasses
import json
from dataclasses import dataclass
from fractions import Fraction
from itertools import count
from typing import Any, TypeVar, overload

from ..data import formats
from ..data.errors import ParameterError
from ..data.plain_data import from_plain, parse_json, to_plain
from ..data.raster import check_numbers, numbers_in
from ..data.validation import (
    LARGEST_INTEGER,
    OPEN,
    Validated,
    choice,
    default_of,
    integer,
    nested,
    number,
    rational,
    switch,
)
from ..masks.parameters import Mask, check_mask
from ..spectral.equaliser import Equaliser
from ..spectral.measured import MeasuredSpectra
from ..spectral.water import Water
from ..waves.coast.parameters import Coast, repeats_after
from ..waves.contribution import Contribution, Gives
from ..waves.hero.parameters import HeroWave
from ..waves.image.parameters import ImageLayer
from ..waves.kinds import KINDS
from ..waves.spectral import WaveLayer
from ..waves.wake.parameters import PathSample, WakeLayer
from ..waves.wind_field.parameters import WindFieldLayer, WindKey
from .current import Current
from .foam import Foam
from .former_json import modern
from .patch import MOST_PATCHES, Patch, check_patches, domain_side, grid_samples, resampled
from .spray import Spray
from .timing import Timing, check_loop

__all__ = [
    "Coast",
    "Current",
    "Equaliser",
    "Foam",
    "HeroWave",
    "ImageLayer",
    "Mask",
    "MeasuredSpectra",
    "OceanParameters",
    "ParameterError",
    "Patch",
    "PathSample",
    "Spray",
    "Timing",
    "WakeLayer",
    "Water",
    "WaveLayer",
    "WindFieldLayer",
    "WindKey",
    "parse_json",
]

DISPERSIONS = ("CAPILLARY", "FINITE_DEPTH", "DEEP")
AMPLITUDES = ("RANDOM", "DETERMINISTIC")
ORBITS = ("DEEP", "FINITE_DEPTH")
#: fields derived from the patches, if there are any
_TILE = ("resolution", "domain_size")

_Layer = TypeVar("_Layer", bound=Contribution)


@dataclass(frozen=True)
class OceanParameters(Validated):
    """Everything that determines a sea. Equal parameters give equal fields.

    Raises ParameterError (a ValueError) naming the field, its value and what is allowed.

    Examples
    --------
    >>> sea = OceanParameters(layers=(WaveLayer(wind_speed=25.0, fetch=800e3),))
    >>> OceanParameters.from_json(sea.to_json()) == sea
    True
    >>> OceanParameters(domain_size=0.0)
    Traceback (most recent call last):
        ...
    ocean_tweak.core.data.errors.ParameterError: domain_size = 0.0: must be from 0.1 to 100000 m
    """

    resolution: int = grid_samples(
        512, "Samples along each side of the domain, an even number",
        "fewer than 16 hold no sea, more than 8192 need too much memory", may_be_told=True,
    )  # fmt: skip
    domain_size: float = domain_side(
        "beyond 100 km, neighbouring wave vectors cannot be told apart", may_be_told=True
    )
    seed: int = integer(
        0, 0, LARGEST_INTEGER, "Random seed: another number gives another sea with the same statistics",
        "Blender's whole numbers",
    )  # fmt: skip
    choppiness: float = number(
        1.0, 0.0, 4.0, "", "Horizontal displacement, which sharpens crests; 1 is linear wave theory",
        "far beyond 1 the surface folds", useful=(0.0, 1.5), changes=True,
    )  # fmt: skip
    dispersion: str = choice("CAPILLARY", DISPERSIONS, "How fast a wave of a given length travels")
    loop_duration: Fraction | None = rational(
        None, 0.01, 1e6, "s", "Time after which the sea repeats exactly; none if it does not loop",
        "from a frame to days", optional=True,
    )  # fmt: skip
    amplitudes: str = choice(
        "RANDOM",
        AMPLITUDES,
        "Random wave heights, as at sea, or the spectrum's own amplitudes with random phases",
    )
    match_height: bool = switch(False, "Scale this seed to the wave height of the spectrum")
    trough_damping: float = number(
        0.0, 0.0, 1.0, "", "Removes short waves from the troughs of long ones", "a share"
    )
    orbital_motion: str = choice(
        "DEEP", ORBITS, "Horizontal motion as in deep water, or wider as linear theory has it in finite depth"
    )
    water: Water = nested(Water)
    layers: tuple[Contribution, ...] = nested(Contribution, many=True, kinds=KINDS)
    patches: tuple[Patch, ...] = nested(Patch, many=True, empty=True, most=MOST_PATCHES)
    merged_resolution: int = grid_samples(
        0,
        "Samples along each side of one grid that holds the sum of the patches; 0 keeps them separate",
        left_out=True,
    )
    mask: Mask | None = nested(Mask, optional=True)
    coast: Coast | None = nested(Coast, optional=True)
    current: Current | None = nested(Current, optional=True)
    equaliser: Equaliser | None = nested(Equaliser, optional=True)
    foam: Foam = nested(Foam)
    spray: Spray | None = nested(Spray, optional=True, compared=False)
    timing: Timing = nested(Timing)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.merged_resolution and not self.patches:
            reason = "must be 0 in a sea without patches, which is on one grid"
            raise ParameterError("merged_resolution", self.merged_resolution, reason)
        self._settle_tile()
        object.__setattr__(self, "layers", _identified(self.layers))
        check_loop(self.loop_duration, self.timing)
        self._check_layers()
        on_the_first = [
            kind.former_list or kind.names.noun
            for kind in KINDS
            if Gives.SPECTRUM not in kind.gives and self.of(kind)
        ]
        check_patches(self.patches, self.trough_damping, on_the_first)
        own = (*(layer.mask for layer in self.layers), *(patch.mask for patch in self.patches))
        for mask in (self.mask, *own):
            if mask is not None:
                check_mask(mask, self.domain_size)
        if self.is_masked and self.trough_damping > 0.0:
            raise ParameterError(
                "trough_damping", self.trough_damping,
                "must be 0 in a sea with masks: waves under a mask cannot be damped by the "
                "troughs of the others",
            )  # fmt: skip
        if self.coast is not None and not self.coast.muted:
            self.coast.check(self)

    def _settle_tile(self) -> None:
        """Fill in the domain size and resolution if they were not given: with patches they are those of the
        first one, which holds images and wind fields. Raises ParameterError for conflicting values.
        """
        told: dict[str, float] = {}
        if self.patches:
            first = self.patches[0]
            told = {
                "resolution": self.merged_resolution or first.resolution,
                "domain_size": first.domain_size,
            }
        for field in dataclasses.fields(self):
            if field.name not in _TILE:
                continue
            given = getattr(self, field.name)
            if given is OPEN:
                object.__setattr__(self, field.name, told.get(field.name, default_of(field)))
            elif given != told.get(field.name, given):
                reason = (
                    f"must be {told[field.name]:g}, as the patches have it: leave it out, or change "
                    "the patches"
                )
                raise ParameterError(field.name, given, reason)

    @property
    def is_cascade(self) -> bool:
        """Whether it has separate grids: several patches, or one that is rotated, and not merged."""
        return not self.merged_resolution and (
            len(self.patches) > 1 or any(patch.rotation for patch in self.patches)
        )

    @property
    def is_masked(self) -> bool:
        """Whether any of its waves are masked."""
        own: tuple[Contribution | Patch, ...] = (*self.active(), *self.patches)
        return self.mask is not None or any(layer.mask is not None for layer in own)

    @property
    def has_coast(self) -> bool:
        """Whether its waves run over a bed somewhere."""
        return self.coast is not None and not self.coast.muted

    @property
    def repeats_after(self) -> Fraction | None:
        """Time in s of which the periods of all waves are whole parts; None where they are any."""
        return self.loop_duration if self.coast is None else repeats_after(self.loop_duration)

    @property
    def needs_summation(self) -> bool:
        """Whether its waves are summed in space instead of as Fourier coefficients: with patches or masks."""
        return bool(self.merged_resolution) or self.is_cascade or self.is_masked

    @property
    def band(self) -> tuple[float, float] | None:
        """Shortest and longest wavelength in m if this sea is one patch of several; None for all waves."""
        return self.patches[0].band if len(self.patches) == 1 else None

    def of(self, kind: type[_Layer]) -> tuple[_Layer, ...]:
        """The layers of one kind, including muted ones."""
        return tuple(layer for layer in self.layers if isinstance(layer, kind))

    @overload
    def active(self) -> tuple[Contribution, ...]: ...
    @overload
    def active(self, kind: type[_Layer]) -> tuple[_Layer, ...]: ...
    def active(self, kind: type[Contribution] | None = None) -> tuple[Contribution, ...]:
        """The layers that are not muted, optionally of one kind, in the order in which their waves are
        added."""
        kinds = KINDS if kind is None else (kind,)
        return tuple(layer for known in kinds for layer in self.of(known) if not layer.muted)

    @property
    def has_states(self) -> bool:
        """Whether layers other than spectral ones report the height of their waves."""
        return any(Gives.STATE in layer.gives for layer in self.active())

    @property
    def moves(self) -> bool:
        """Whether a current carries its waves."""
        return self.current is not None and self.current != Current(direction=self.current.direction)

    def alone(self, layer: Contribution) -> OceanParameters:
        """A copy reduced to one layer and to the settings that affect its sea state."""
        return OceanParameters(
            resolution=16, domain_size=self.domain_size, seed=self.seed, water=self.water,
            dispersion=self.dispersion, layers=(WaveLayer(muted=True), layer),
        )  # fmt: skip

    def _check_layers(self) -> None:
        """Check the layers against the sea; layers that cannot loop are refused in a looping sea."""
        for index, layer in enumerate(self.layers):
            if layer.muted:
                continue
            if self.loop_duration is not None and Gives.LOOPS not in layer.gives:
                raise ParameterError(
                    "loop_duration", to_plain(self.loop_duration),
                    f"layers.{index} raises waves that do not repeat: mute it, or remove the loop",
                )  # fmt: skip
            layer.check(self, f"layers.{index}")
        for kind in dict.fromkeys(type(layer) for layer in self.active()):
            kind.check_together(self)

    def replace(self, **changes: Any) -> OceanParameters:
        """A copy with some fields changed, validated again.

        For a sea of patches, a new resolution applies to the first patch and the others are scaled in
        proportion; for merged patches it applies to their one grid.

        Examples
        --------
        >>> OceanParameters(seed=1).replace(seed=2, domain_size=250.0).domain_size
        250.0
        """
        if self.patches and "patches" not in changes:
            if "resolution" in changes and self.merged_resolution:
                changes["merged_resolution"] = changes["resolution"]
            elif "resolution" in changes:
                changes["patches"] = resampled(self.patches, changes["resolution"])
            if changes.get("domain_size", self.domain_size) != self.domain_size:
                raise ParameterError(
                    "domain_size",
                    changes["domain_size"],
                    "is set by the first patch: change it there",
                )
        if changes.get("patches", self.patches):  # derived again from the patches
            changes = {**dict.fromkeys(_TILE, OPEN), **changes}
        return dataclasses.replace(self, **changes)

    def at_resolution(self, resolution: int) -> OceanParameters:
        """The same sea at another resolution; layers too short for it, such as short hero waves, are muted.

        Examples
        --------
        >>> OceanParameters(resolution=512).at_resolution(128).resolution
        128
        """
        return self.replace(resolution=resolution, layers=self._held_by(resolution))

    def on_one_grid(self, resolution: int) -> OceanParameters:
        """The same sea on one grid over the domain; several patches are merged."""
        if not self.is_cascade:
            return self.at_resolution(resolution)
        return self.replace(
            merged_resolution=resolution, patches=self.patches, layers=self._held_by(resolution)
        )

    def _held_by(self, resolution: int) -> tuple[Contribution, ...]:
        return tuple(
            layer if layer.is_held(self, resolution) else layer.changed(muted=True) for layer in self.layers
        )

    @property
    def separate(self) -> OceanParameters:
        """The same sea with merged patches separated again."""
        return self.replace(merged_resolution=0, patches=self.patches) if self.merged_resolution else self

    @property
    def without_patches(self) -> OceanParameters:
        """The sea with the same spectrum, domain size and resolution on a single patch."""
        return self.replace(patches=(), merged_resolution=0)

    def to_dict(self, brief: bool = False) -> dict[str, Any]:
        """Plain dictionaries, lists and numbers, as in a JSON file.

        brief : reduce images to name, shape and hash, for headers; such data cannot be read back

        Examples
        --------
        >>> OceanParameters().to_dict()["water"]["gravity"]
        9.81
        """
        return to_plain(self, brief)

    def to_json(self, indent: int | None = 2) -> str:
        """JSON text from which `from_json` restores equal parameters.

        Examples
        --------
        >>> OceanParameters.from_json(OceanParameters(seed=7).to_json()).seed
        7
        """
        return json.dumps({"format": formats.SEA, **self.to_dict()}, indent=indent, ensure_ascii=False)

    @classmethod
    def from_dict(cls, data: object) -> OceanParameters:
        """Parameters from plain dictionaries. Missing keys keep their defaults, unknown keys are refused.

        Examples
        --------
        >>> OceanParameters.from_dict({"layers": [{"wind_speed": 8.0}]}).layers[0].wind_speed
        8.0
        >>> OceanParameters.from_dict({"water": {"depth": -5.0}})
        Traceback (most recent call last):
            ...
        ocean_tweak.core.data.errors.ParameterError: water.depth = -5.0: must be from 0.1 to 11000 m
        """
        check_numbers(numbers_in(data))
        data = modern(data)
        if isinstance(data, dict) and data.get("patches"):  # the size of the first patch is stored only once
            data = {key: value for key, value in data.items() if key not in _TILE}
        return from_plain(cls, data)

    @classmethod
    def from_json(cls, text: str) -> OceanParameters:
        """Parameters from JSON text. Raises ParameterError for invalid JSON or invalid parameters.

        Examples
        --------
        >>> OceanParameters.from_json('{"water": {"depth": 12.5}}').water.depth
        12.5
        """
        return cls.from_dict(parse_json(text))


def _identified(layers: tuple[Contribution, ...]) -> tuple[Contribution, ...]:
    """Layers with ids that are unique within each kind; layers without an id get the first free ones.

    Raises ParameterError for an id that two layers of a kind have.
    """
    taken: dict[str, set[int]] = {kind.kind: set() for kind in KINDS}
    for index, layer in enumerate(layers):
        if layer.id >= 0 and layer.id in taken[layer.kind]:
            raise ParameterError(f"layers.{index}.id", layer.id, "is already the id of another layer")
        taken[layer.kind].add(layer.id)
    result = list(layers)
    for index, layer in enumerate(layers):
        if layer.id < 0 and layer.has("id"):
            ids = taken[layer.kind]
            result[index] = layer.changed(id=next(number for number in count() if number not in ids))
            ids.add(result[index].id)
    return tuple(result)
