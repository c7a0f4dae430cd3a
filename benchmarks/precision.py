# SPDX-License-Identifier: GPL-3.0-or-later
"""Single precision against the same sea in double precision, after nearly three hours."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ocean_tweak.core import Ocean
from ocean_tweak.core.synthesis.channels import OF_WAVES

from .plan import Plan, sea
from .rows import Row

GROUP = "precision"
TIME = 1e4

_CHANNELS = {2: "xy", 3: "xyz"}


def rows(plan: Plan) -> Iterator[Row]:
    """Every channel of every output."""
    for resolution in plan.precision:
        single, double = (
            Ocean(sea(resolution), precision).surface(TIME, OF_WAVES) for precision in ("single", "double")
        )
        for name in OF_WAVES:
            for channel, ours, exact in _channels(getattr(single, name), getattr(double, name)):
                yield Row(
                    GROUP, f"{name}{channel}, {resolution}²", relative_error(ours, exact), "rms",
                    target="precision",
                )  # fmt: skip


def relative_error(ours: NDArray[np.floating], exact: NDArray[np.floating]) -> float:
    """The error's rms in units of the field's rms."""
    return float(np.sqrt(np.mean((ours - exact) ** 2) / np.mean(exact**2)))


def _channels(
    ours: NDArray[np.floating], exact: NDArray[np.floating]
) -> Iterator[tuple[str, NDArray[np.floating], NDArray[np.floating]]]:
    if exact.ndim == 2:
        yield "", ours, exact
        return
    for index, letter in enumerate(_CHANNELS[exact.shape[-1]]):
        yield f".{letter}", ours[..., index], exact[..., index]
