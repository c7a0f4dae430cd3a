# SPDX-License-Identifier: GPL-3.0-or-later
"""What a hero wave is: when and where its group is together, and how large it is there."""

from __future__ import annotations

from dataclasses import dataclass

from ...errors import ParameterError
from ...validation import Validated, number, switch

#: wavelengths that a crest must be wide: a narrower hump is no wave, it runs apart in all directions
NARROWEST = 0.5


@dataclass(frozen=True)
class HeroWave(Validated):
    """A group of waves under a bell-shaped (Gaussian) envelope, which adds to the sea.

    Its waves obey the sea's dispersion relation: at its focus the group is what these numbers say; before
    and after it runs along its direction, and is longer, wider and lower.
    """

    x: float = number(
        200.0, -1e6, 1e6, "m", "Place of the focus along x; the patch repeats, and the wave with it",
        "far beyond any patch",
    )  # fmt: skip
    y: float = number(200.0, -1e6, 1e6, "m", "Place of the focus along y", "far beyond any patch")
    time: float = number(
        0.0, -1e6, 1e6, "s", "Ocean time at which the group is together at its focus",
        "more than a week either way",
    )  # fmt: skip
    direction: float = number(
        0.0, -1e6, 1e6, "rad", "Direction towards which the wave runs, counter-clockwise from +x",
        "any number of turns that a float tells apart",
    )  # fmt: skip
    wavelength: float = number(
        60.0, 1e-3, 1e5, "m", "Distance from crest to crest; sets the speed, with depth and gravity",
        "from ripples to the largest patch",
    )  # fmt: skip
    crest_height: float = number(
        3.0, 0.0, 100.0, "m", "Height of the crest above calm water at the focus; elsewhere it is lower",
        "thrice the largest measured",
    )  # fmt: skip
    group_length: float = number(
        2.0, 1.0, 1000.0, "wavelengths",
        "Length of the group along its direction, between the places where its waves are half as high; "
        "1 is a single crest",
        "shorter, it is no wave any more",
    )  # fmt: skip
    group_width: float = number(
        150.0, 1e-3, 1e5, "m",
        "Width of the crests across the direction, between the places where they are half as high",
        "from ripples to the largest patch",
    )  # fmt: skip
    phase: float = number(
        0.0, -1e6, 1e6, "rad", "Of the wave at the focus: 0 for a crest, π for a trough",
        "any number of turns that a float tells apart",
    )  # fmt: skip
    muted: bool = switch(False, "Leave the wave out; nothing else changes")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.group_width < NARROWEST * self.wavelength:
            raise ParameterError(
                "group_width", self.group_width,
                f"must be at least {NARROWEST * self.wavelength:.4g} m, {NARROWEST:g} of its wavelength: "
                "a narrower hump runs apart in all directions",
            )  # fmt: skip
