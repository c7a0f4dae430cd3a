# SPDX-License-Identifier: GPL-3.0-or-later
"""The sets of fields that are measured, and the arrays that they are written into."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ocean_tweak.core import Ocean
from ocean_tweak.core.synthesis.channels import OF_WAVES
from ocean_tweak.core.synthesis.transforms import term

from .plan import sea

#: an instant far from 0, where phases are large
TIME = 1234.5


@dataclass(frozen=True)
class FieldSet:
    """Outputs, and how many real fields a transform must make for them."""

    name: str
    outputs: tuple[str, ...]
    transforms: int


THREE = FieldSet("3 fields", ("displacement",), 3)
SIX = FieldSet("6 fields + eigenvalue", ("displacement", "min_eigenvalue"), 6)
# elevation, Dx, Dy, their rates, two slopes and Jxx, Jxy, Jyy, each counted once
_TERMS = {term(*need) for output in OF_WAVES.values() for need in output.needs}
ALL = FieldSet("all outputs", tuple(sorted(OF_WAVES)), len(_TERMS))


def arrays(fields: FieldSet, resolution: int) -> dict[str, NDArray[np.float32]]:
    """Arrays for the outputs, each of its pages touched."""
    return {name: np.full(OF_WAVES[name].shape(resolution), 1.0, np.float32) for name in fields.outputs}


def surface_maker(fields: FieldSet, resolution: int, workers: int) -> Callable[[], object]:
    """Makes the fields at one instant, in arrays that are there already."""
    ocean = Ocean(sea(resolution), workers=workers)
    out = arrays(fields, resolution)
    return lambda: ocean.surface(TIME, fields.outputs, out=out)
