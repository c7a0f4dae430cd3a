# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of the sea foam covers, and how long it lasts."""

from __future__ import annotations

from dataclasses import dataclass

from ..data.validation import Off, Validated, choice, number
from .patch import grid_samples

#: laws for the whitecap coverage
FOAM_LAWS = ("CALLAGHAN_2008", "MONAHAN_1980")


@dataclass(frozen=True)
class Foam(Validated):
    """How much of the sea is covered by foam, and how long it lasts.

    Examples
    --------
    >>> Foam(half_life=4.0).coverage
    1.0
    """

    coverage: float = number(
        1.0, 0.0, 100.0, "", "Multiplies the whitecap coverage; 1 is the coverage measured at sea for "
        "this wind",
        "from no foam to a light breeze's sea all white",
    )  # fmt: skip
    law: str = choice(
        FOAM_LAWS[0], FOAM_LAWS, "Which measurements set the whitecap coverage: Callaghan and others "
        "(2008), from 3.7 to 23 m/s, or Monahan and O'Muircheartaigh (1980), measured below 20 "
        "m/s, with twice as much foam in a storm", left_out=True,
    )  # fmt: skip
    half_life: float = number(
        2.5, 0.0, 60.0, "s", "Time in which foam fades to half; 0 shows foam only where it forms",
        "whitecaps fade in seconds, patches in a minute",
    )  # fmt: skip
    drift: float = number(
        0.02, 0.0, 0.2, "", "Speed of the foam along the wind, as a fraction of the wind speed",
        "the surface drifts with 2 to 3 % of the wind",
    )  # fmt: skip
    resolution: int = grid_samples(
        0,
        "Samples along each side at which foam is made, an even number",
        off=Off(0, 512, "uses the sea's own"),
    )
