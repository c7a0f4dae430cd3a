# SPDX-License-Identifier: GPL-3.0-or-later
"""One of several patches of a sea: its size, rotation and band of wavelengths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from ..data.errors import ParameterError
from ..data.validation import Off, Validated, angle, integer, nested, number
from ..masks.parameters import Mask

#: largest number of patches of a sea
MOST_PATCHES = 4

#: ends of an unlimited band, m
NO_SHORTEST, NO_LONGEST = 0.0, 1e6

#: least number of samples along a patch's shortest wave, and of its longest waves along a side
LEAST_SAMPLES, LEAST_CELLS = 4.0, 6.0

#: largest fraction of the variance in patches that repeat within the wanted area: the sea's autocorrelation
# at one domain's distance
REPEATING_SHARE = 0.1


@dataclass(frozen=True)
class Patch(Validated):
    """One of a sea's patches, periodic along its own axes. Its band has sharp ends.

    Examples
    --------
    >>> Patch(domain_size=50.0, resolution=256, longest_wavelength=8.0).spacing
    0.1953125
    """

    domain_size: float = number(
        400.0, 0.1, 100e3, "m", "Side of the square patch, which repeats without a seam",
        "as the domain of a sea of one patch",
    )  # fmt: skip
    rotation: float = angle(
        "Rotation of the patch's sides, counter-clockwise from +x; its waves keep their directions"
    )
    shortest_wavelength: float = number(
        NO_SHORTEST, 0.0, 1e6, "m", "Shortest wavelength of the patch; the next patch holds shorter ones",
        "any domain", off=Off(NO_SHORTEST, 1.0, "keeps all short waves"),
    )  # fmt: skip
    longest_wavelength: float = number(
        NO_LONGEST, 1e-3, 1e6, "m", "Longest wavelength of the patch; the patch before holds longer ones",
        "any domain", off=Off(NO_LONGEST, 100.0, "keeps all long waves"),
    )  # fmt: skip
    resolution: int = integer(
        512, 16, 8192, "Samples along each side of the patch, an even number", "as the resolution of a sea"
    )
    mask: Mask | None = nested(Mask, optional=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.resolution % 2:
            raise ParameterError("resolution", self.resolution, "must be an even number from 16 to 8192")
        if self.shortest_wavelength >= self.longest_wavelength:
            raise ParameterError(
                "shortest_wavelength", self.shortest_wavelength,
                f"must be below longest_wavelength = {self.longest_wavelength:g} m",
            )  # fmt: skip

    @property
    def band(self) -> tuple[float, float]:
        """Shortest and longest wavelength, m."""
        return self.shortest_wavelength, self.longest_wavelength

    @property
    def spacing(self) -> float:
        """Distance between samples, m."""
        return self.domain_size / self.resolution

    @property
    def samples_a_wave(self) -> float:
        """Samples along the shortest wave of the band; 0 for a band without a short end."""
        return self.shortest_wavelength / self.spacing

    @property
    def longest_waves_a_side(self) -> float:
        """Number of the band's longest waves along a side."""
        return self.domain_size / self.longest_wavelength


def check_bands(patches: Sequence[Patch]) -> None:
    """Raise ParameterError unless each band begins where that of the previous patch ends."""
    for index, (longer, shorter) in enumerate(pairwise(patches)):
        end, begin = longer.shortest_wavelength, shorter.longest_wavelength
        if end == begin:
            continue
        if shorter.shortest_wavelength >= longer.longest_wavelength:
            fault = "holds longer waves than the patch before it: order the patches from long waves to short"
        elif begin > end:
            fault = "the waves in between would be counted twice"
        else:
            fault = "waves in between would be lost"
        raise ParameterError(
            f"patches.{index + 1}.longest_wavelength", begin,
            f"patches.{index} ends at {end:g} m and patches.{index + 1} begins at {begin:g} m: {fault}. "
            f"Give patches.{index}.shortest_wavelength and patches.{index + 1}.longest_wavelength one value",
        )  # fmt: skip


def check_merged_resolution(merged_resolution: int, patches: Sequence[Patch]) -> None:
    """Raise ParameterError if `merged_resolution` does not fit the patches."""
    if merged_resolution % 2 or 0 < merged_resolution < 16:
        raise ParameterError(
            "merged_resolution", merged_resolution, "must be 0 or an even number from 16 to 8192"
        )
    if merged_resolution and not patches:
        what = "must be 0 in a sea without patches, which is on one grid"
        raise ParameterError("merged_resolution", merged_resolution, what)


def check_patches(patches: Sequence[Patch], trough_damping: float, on_the_first: Sequence[str]) -> None:
    """Raise ParameterError for bands that do not join, and for settings that patches do not support.

    on_the_first : names of the sea's other layers, which are on the first patch
    """
    if not patches:
        return
    check_bands(patches)
    if trough_damping > 0.0:
        raise ParameterError(
            "trough_damping", trough_damping,
            "must be 0 in a sea of several patches: a patch cannot be damped by the troughs of "
            "another. Use a single patch",
        )  # fmt: skip
    if on_the_first and patches[0].rotation:
        raise ParameterError(
            "patches.0.rotation", patches[0].rotation,
            f"must be 0 in a sea with {' and '.join(on_the_first)}, held by the first patch: turn the others",
        )  # fmt: skip


def resampled(patches: Sequence[Patch], resolution: int) -> tuple[Patch, ...]:
    """The patches with this many samples in the first, and in proportion in the others, at least 16."""
    ratio = resolution / patches[0].resolution
    others = (
        replace(patch, resolution=max(16, 2 * round(0.5 * patch.resolution * ratio))) for patch in patches[1:]
    )
    return replace(patches[0], resolution=resolution), *others
