# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of a coast: the bed, its position, and the waves that reach it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import TYPE_CHECKING

from ...data.errors import ParameterError
from ...data.plain_data import to_plain
from ...data.raster import Raster
from ...data.validation import Off, Validated, choice, number, place, raster, switch

if TYPE_CHECKING:
    from ...parameters.ocean_parameters import OceanParameters

#: sides of the bed, and their direction in quarter turns from +x
SHORES = ("+X", "+Y", "-X", "-Y")

#: time in s of which all periods are integer fractions: as few frequencies as look like all of them
REPEATS_AFTER = Fraction(512)


@dataclass(frozen=True)
class Coast(Validated):
    """A bed over which the long waves of a sea's first patch run ashore, aligned with that patch's sides.

    Examples
    --------
    >>> from ocean_tweak.core import Raster
    >>> Coast(depth=Raster([[8.0, 4.0, 0.0], [8.0, 4.0, 0.0]]), spacing=50.0).shore
    '+X'
    """

    depth: Raster | None = raster(
        "Depth of the bed below still water, 0 and less on land; the first row has the smallest y", channels=1
    )
    spacing: float = number(
        2.0, 0.01, 1e4, "m", "Distance between two samples of the depth", "from a tank to a continent's shelf"
    )
    x: float = place(0.0, "Place of the first sample of the depth")
    y: float = place(0.0, "Place of the first sample of the depth")
    shore: str = choice(
        SHORES[0], SHORES, "Side of the bed with the shore, towards which the waves run. Short waves, "
            "and waves that run away from it, do not follow the bed, but are limited by the depth",
    )  # fmt: skip
    rim: float = number(
        60.0, 1.0, 1e5, "m", "Width over which the open sea blends into the coast, and the same again "
            "over which the bed sinks to the sea's own depth",
        "from a tank to a continent's shelf",
    )  # fmt: skip
    shortest_wavelength: float = number(
        20.0, 0.1, 1e4, "m", "Shortest waves offshore that follow the bed; shorter ones are many, and "
            "hardly feel it", "from ripples to swell",
    )  # fmt: skip
    step: float = number(
        0.0, 0.0, 1e3, "m", "Distance between samples of the waves over the bed",
        "from a tank to swell", off=Off(0.0, 1.0, "uses that of the first patch"),
    )  # fmt: skip
    mirror: float = number(
        0.0, 0.0, 1.0, "", "Fraction of their height that waves keep when walls throw them back; a wall is "
            "land that rises steeper than 1:1 out of the water",
        "from rubble, which takes all, to smooth concrete",
    )  # fmt: skip
    breaking: bool = switch(True, "Let waves break where they are too high for the depth")
    muted: bool = switch(False, "Show the open sea instead, with the same waves that reach the coast")

    def __post_init__(self) -> None:
        if isinstance(self.depth, Raster):
            object.__setattr__(self, "depth", self.depth.grey())
        super().__post_init__()
        if self.depth is None:
            raise ParameterError("depth", None, 'give the bed: a raster of depths, or {"file": "bed.exr"}')
        if min(self.depth.shape[:2]) < 2:
            raise ParameterError("depth", f"shape {self.depth.shape[:2]}", "must be 2 samples a side or more")

    def check(self, sea: OceanParameters) -> None:
        """Raise ParameterError for what cannot be in a sea whose waves run over this bed."""
        if sea.trough_damping > 0.0:
            reason = "must be 0 with a coast: its waves are damped by no others"
            raise ParameterError("trough_damping", sea.trough_damping, reason)
        if sea.is_masked:
            reason = "cannot be in a sea with masks: remove them; the bed itself gives shelter"
            raise ParameterError("coast", "given", reason)
        if sea.moves:
            raise ParameterError(
                "current", to_plain(sea.current),
                "must be still over a coast, whose waves are followed in water that rests: remove it, or set "
                "coast.muted",
            )  # fmt: skip
        if sea.dispersion == "DEEP":
            reason = "must be FINITE_DEPTH or CAPILLARY with a coast: in DEEP water no wave feels a bed"
            raise ParameterError("dispersion", sea.dispersion, reason)


def repeats_after(loop_duration: Fraction | None) -> Fraction:
    """Time in s of which the periods of waves that reach a coast are integer fractions."""
    if loop_duration is None:
        return REPEATS_AFTER
    return loop_duration / ceil(loop_duration / REPEATS_AFTER)
