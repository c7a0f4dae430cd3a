# SPDX-License-Identifier: GPL-3.0-or-later
"""One of several patches of a sea: its size, rotation and band of wavelengths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from ..data.errors import ParameterError
from ..data.validation import Validated, angle, integer, nested, number
from ..masks.parameters import Mask
from ..waves.contribution import check_band, longest_wavelength, shortest_wavelength

#: largest number of patches of a sea
MOST_PATCHES = 4

#: least number of samples along a patch's shortest wave, and of its longest waves along a side
LEAST_SAMPLES, LEAST_CELLS = 4.0, 6.0

#: largest fraction of the variance in patches that repeat within the wanted area: the sea's autocorrelation
# at one domain's distance
REPEATING_SHARE = 0.1


def domain_side(why: str, **how: Any) -> Any:
    """Marks a field: the side of a domain."""
    return number(
        400.0, 0.1, 100e3, "m", "Side of the square patch, which repeats without a seam", why, **how
    )


def grid_samples(default: int, description: str, why: str = "as the resolution of a sea", **how: Any) -> Any:
    """Marks a field: samples along each side of a grid, an even number, or 0 where that is the default."""
    least, most = 16, 8192
    return integer(default, least if default else 0, most, description, why, even_from=least, **how)


@dataclass(frozen=True)
class Patch(Validated):
    """One of a sea's patches, periodic along its own axes. Its band has sharp ends.

    Examples
    --------
    >>> Patch(domain_size=50.0, resolution=256, longest_wavelength=8.0).spacing
    0.1953125
    """

    domain_size: float = domain_side("as the domain of a sea of one patch")
    rotation: float = angle(
        "Rotation of the patch's sides, counter-clockwise from +x; its waves keep their directions"
    )
    shortest_wavelength: float = shortest_wavelength(
        "Shortest wavelength of the patch; the next patch holds shorter ones"
    )
    longest_wavelength: float = longest_wavelength(
        "Longest wavelength of the patch; the patch before holds longer ones"
    )
    resolution: int = grid_samples(512, "Samples along each side of the patch, an even number")
    mask: Mask | None = nested(Mask, optional=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        check_band(self.shortest_wavelength, self.longest_wavelength)

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
