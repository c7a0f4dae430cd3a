# SPDX-License-Identifier: GPL-3.0-or-later
"""How spray is seen and carried. Waves know nothing of it: seas that differ in it alone are the same sea."""

from __future__ import annotations

from dataclasses import dataclass

from ..data.validation import Validated, number


@dataclass(frozen=True)
class Spray(Validated):
    """What breaking crests throw into the air: spume, drops and mist.

    Examples
    --------
    >>> Spray(amount=0.1).life
    4.0
    """

    amount: float = number(
        1.0, 0.0, 100.0, "", "Multiplies how many particles breaking crests throw up; 1 looks as at sea",
        "from none to what no machine holds",
    )  # fmt: skip
    size: float = number(
        0.002, 1e-4, 1.0, "m", "Radius with which a drop of half a millimetre is drawn: each stands for many."
        " Sheets of spume, mist and larger drops grow with it", "from true drops to handfuls of water",
    )  # fmt: skip
    wind: float = number(
        1.0, 0.0, 4.0, "", "Multiplies the wind that carries spray. How much spray there is follows from the"
        " sea's own wind", "beyond a storm's gusts", useful=(0.0, 2.0),
    )  # fmt: skip
    life: float = number(
        4.0, 0.1, 30.0, "s", "Age at which mist has vanished. Drops fall back within two seconds",
        "mist hangs over crests for seconds",
    )  # fmt: skip
