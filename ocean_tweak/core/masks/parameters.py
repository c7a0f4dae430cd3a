# SPDX-License-Identifier: GPL-3.0-or-later
"""The parameters of a mask."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..data.errors import ParameterError
from ..data.raster import Raster
from ..data.validation import (
    LARGEST_INTEGER,
    Off,
    Validated,
    angle,
    choice,
    integer,
    number,
    place,
    raster,
    switch,
)

MASK_SOURCES = ("IMAGE", "DISTANCE", "NOISE")
#: fields that change for a mask whose object moves
MOVING = ("x", "y", "lines")
#: largest number of gusts along a side of the domain
MOST_GUSTS = 40
#: largest number of lines of a mask, each of which costs as much as a place, and their largest length in
# domains
MOST_LINES, MOST_DOMAINS = 500, 4.0


@dataclass(frozen=True)
class Mask(Validated):
    """Where the waves of a layer, a patch or a whole sea are: fully at weight 1, not at all at 0.

    Examples
    --------
    >>> Mask(x=200.0, y=200.0, inner_radius=30.0, outer_radius=80.0).source
    'DISTANCE'
    """

    source: str = choice(
        "DISTANCE", MASK_SOURCES, "What gives the weight: an image, a distance, or a noise that moves"
    )
    image: Raster | None = raster("Weights from 0 to 1, stretched over the domain", channels=1)
    x: float = place(0.0, "Distance: x of the place from which it is measured")
    y: float = place(0.0, "Distance: y of the place from which it is measured")
    lines: Raster | None = raster(
        "Distance: straight lines from which it is measured instead of a place: x and y of one end, x and y "
        "of the other, m", channels=4, left_out=True,
    )  # fmt: skip
    inner_radius: float = number(50.0, 0.0, 1e6, "m", "Distance up to which the weight is 0", "any domain")
    outer_radius: float = number(150.0, 1e-3, 1e6, "m", "Distance from which the weight is 1", "any domain")
    inverted: bool = switch(False, "Swap 0 and 1: waves near the place, or where the image is dark")
    strength: float = number(
        1.0, 0.0, 1.0, "", "Fraction of the waves that the mask removes where the weight is 0", "a share",
        left_out=True,
    )  # fmt: skip
    noise_size: float = number(
        100.0, 0.1, 100e3, "m", "Noise: distance from one gust to the next", "as the domain", left_out=True
    )
    noise_coverage: float = number(
        0.5, 0.01, 0.99, "", "Noise: mean weight, the fraction of the sea with waves", "never all or none",
        left_out=True,
    )  # fmt: skip
    noise_contrast: float = number(
        0.8, 0.0, 0.99, "", "Noise: 0 is the same weight everywhere; towards 1, gusts get sharp edges",
        "at 1 an edge would be a step", left_out=True,
    )  # fmt: skip
    noise_speed: float = number(
        10.0, 0.0, 1000.0, "m/s", "Noise: speed at which it moves; gusts move about as fast as the wind",
        "any wind", useful=(0.0, 50.0), left_out=True,
    )  # fmt: skip
    noise_direction: float = angle(
        "Noise: direction towards which it moves, counter-clockwise from +x", left_out=True
    )
    noise_evolution: float = number(
        30.0, 0.0, 1e6, "s", "Noise: time in which it changes shape, besides moving",
        "from a flicker to days", useful=(0.0, 300.0), left_out=True,
        off=Off(0.0, 30.0, "keeps its shape while it moves"),
    )  # fmt: skip
    noise_seed: int = integer(
        0, 0, LARGEST_INTEGER, "Noise: random seed", "Blender's whole numbers",
        left_out=True,
    )  # fmt: skip

    def __post_init__(self) -> None:
        if isinstance(self.image, Raster):
            object.__setattr__(self, "image", self.image.grey())
        super().__post_init__()
        if self.lines is not None and self.lines.shape[0] * self.lines.shape[1] > MOST_LINES:
            count = self.lines.shape[0] * self.lines.shape[1]
            raise ParameterError("lines", f"{count} lines", f"must be at most {MOST_LINES}")
        if self.source == "IMAGE" and self.image is None:
            raise ParameterError("image", None, "give an image, whose brightness is the weight")
        if self.source == "DISTANCE" and self.inner_radius >= self.outer_radius:
            raise ParameterError(
                "inner_radius", self.inner_radius, f"must be below outer_radius = {self.outer_radius:g} m"
            )


def check_mask(mask: Mask, domain_size: float) -> None:
    """Raise ParameterError for a mask that does not fit a domain: a noise too coarse or too fine for it, or
    lines that would repeat in it too often.
    """
    if mask.source == "NOISE":
        _check_noise(mask, domain_size)
    if mask.lines is not None:
        check_lines(mask.lines, domain_size)


def _check_noise(mask: Mask, domain_size: float) -> None:
    least = domain_size / MOST_GUSTS
    if not least <= mask.noise_size <= domain_size:
        raise ParameterError(
            "mask.noise_size", f"{mask.noise_size:g} m",
            f"must be from {least:g} to {domain_size:g} m, for the noise repeats with the domain",
        )  # fmt: skip


def check_lines(lines: Raster, domain_size: float) -> None:
    """Raise ParameterError for lines that would repeat too often within a domain."""
    x0, y0, x1, y1 = np.moveaxis(lines.values, -1, 0)
    longest = float(max(np.abs(x1 - x0).max(), np.abs(y1 - y0).max()))
    if longest > MOST_DOMAINS * domain_size:
        raise ParameterError(
            "mask.lines", f"{longest:g} m",
            f"must be at most {MOST_DOMAINS * domain_size:g} m long along x and y, {MOST_DOMAINS:g} domains",
        )  # fmt: skip
