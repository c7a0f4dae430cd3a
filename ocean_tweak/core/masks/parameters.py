# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mask is."""

from __future__ import annotations

from dataclasses import dataclass

from ..data.errors import ParameterError
from ..data.raster import Raster
from ..data.validation import Validated, choice, number, raster, switch

MASK_SOURCES = ("IMAGE", "DISTANCE")


@dataclass(frozen=True)
class Mask(Validated):
    """Where a layer's or a patch's waves are: fully at weight 1, not at all at 0."""

    source: str = choice("DISTANCE", MASK_SOURCES, "What gives the weight: an image, or a distance")
    image: Raster | None = raster("Weights from 0 to 1, stretched over the domain", channels=1)
    x: float = number(
        0.0, -1e6, 1e6, "m", "Distance: the place from which it is measured", "far outside of any domain"
    )
    y: float = number(
        0.0, -1e6, 1e6, "m", "Distance: the place from which it is measured", "far outside of any domain"
    )
    near: float = number(50.0, 0.0, 1e6, "m", "Distance up to which the weight is 0", "any domain")
    far: float = number(150.0, 1e-3, 1e6, "m", "Distance from which on the weight is 1", "any domain")
    inverted: bool = switch(False, "Exchange 0 and 1: waves near the place, or where the image is dark")

    def __post_init__(self) -> None:
        if isinstance(self.image, Raster):
            object.__setattr__(self, "image", self.image.grey())
        super().__post_init__()
        if self.source == "IMAGE" and self.image is None:
            raise ParameterError("image", None, "give an image, whose brightness is the weight")
        if self.source == "DISTANCE" and self.near >= self.far:
            raise ParameterError("near", self.near, f"must be below far = {self.far:g} m")
