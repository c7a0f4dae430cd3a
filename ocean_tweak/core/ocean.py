# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea that can be asked for its surface at any time."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property, lru_cache

import numpy as np

from .fields import SurfaceFields, checked_outputs, displacement
from .initial_state import InitialState, initial_state
from .parameters import OceanParameters, Timing
from .propagation import propagate
from .statistics import Statistics, sea_statistics


@lru_cache(maxsize=4)
def _cached_initial_state(parameters: OceanParameters) -> InitialState:
    return initial_state(parameters)


class Ocean:
    """The sea of some parameters. Making one is cheap; the first surface makes the initial state.

    parameters : OceanParameters
    """

    def __init__(self, parameters: OceanParameters) -> None:
        if not isinstance(parameters, OceanParameters):
            raise TypeError(f"Ocean wants OceanParameters, not {type(parameters).__name__}")
        self.parameters = parameters

    @cached_property
    def initial_state(self) -> InitialState:
        """Shared by all oceans whose parameters differ in time and choppiness only."""
        return _cached_initial_state(self.parameters.replace(choppiness=0.0, timing=Timing()))

    def surface(self, time: float, outputs: Iterable[str] = ("displacement",)) -> SurfaceFields:
        """Fields at a time in s; only the outputs asked for are computed.

        Raises ValueError for an unknown output or a time that is not finite.
        """
        wanted = checked_outputs(outputs)
        if not np.isfinite(time):
            raise ValueError(f"time = {time!r}: must be a finite number of seconds")
        state = self.initial_state
        fields = {}
        if "displacement" in wanted:
            coefficients = propagate(state, float(time))
            fields["displacement"] = displacement(coefficients, state.grid, self.parameters.choppiness)
        return SurfaceFields(float(time), fields)

    def frame(self, frame: float, outputs: Iterable[str] = ("displacement",)) -> SurfaceFields:
        """Fields at a frame of the shot, which may hold a sub-frame."""
        return self.surface(self.parameters.timing.time(frame), outputs)

    def statistics(self) -> Statistics:
        """Wave height, period and wavelength: of the spectrum, as resolved, and of this seed."""
        return sea_statistics(self.parameters, self.initial_state)
