# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea that can be asked for its surface at any time."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from functools import cached_property, lru_cache

import numpy as np

from .fields import OUTPUTS, SurfaceFields, checked_outputs
from .initial_state import InitialState, initial_state
from .parameters import OceanParameters, Timing
from .propagation import propagate
from .sea_spectrum import SeaSpectrum
from .statistics import Statistics, sea_statistics
from .synthesis import Synthesis
from .trough_damping import TroughDamping, trough_damping

PRECISIONS = {"single": np.complex64, "double": np.complex128}


@lru_cache(maxsize=4)
def _cached_initial_state(parameters: OceanParameters) -> InitialState:
    return initial_state(parameters)


class Ocean:
    """The sea of some parameters. Making one is cheap; the first surface makes the initial state.

    parameters : OceanParameters
    precision : "single" for float32 fields, "double" for reference work in float64

    Raises ValueError for an unknown precision.
    """

    def __init__(self, parameters: OceanParameters, precision: str = "single") -> None:
        if not isinstance(parameters, OceanParameters):
            raise TypeError(f"Ocean wants OceanParameters, not {type(parameters).__name__}")
        if precision not in PRECISIONS:
            raise ValueError(f"precision = {precision!r}: must be one of {', '.join(PRECISIONS)}")
        self.parameters = parameters
        self.precision = precision

    @cached_property
    def initial_state(self) -> InitialState:
        """Shared by all oceans whose parameters differ only in what acts after it."""
        # a loop's frames were checked against the shot's timing: keep that, but not its start
        timing = Timing(fps=self.parameters.timing.fps) if self.parameters.loop_duration else Timing()
        return _cached_initial_state(
            self.parameters.replace(choppiness=0.0, trough_damping=0.0, orbits="DEEP", timing=timing)
        )

    @cached_property
    def _trough_damping(self) -> TroughDamping | None:
        if self.parameters.trough_damping == 0.0:
            return None
        peak = SeaSpectrum(self.parameters).peak_wave_number
        return trough_damping(self.parameters.trough_damping, self.initial_state, peak)

    def surface(self, time: float | Fraction, outputs: Iterable[str] = ("displacement",)) -> SurfaceFields:
        """Fields at a time in s; only the outputs asked for are computed.

        Raises ValueError for an unknown output or a time that is not finite.
        """
        wanted = checked_outputs(outputs)
        if not np.isfinite(float(time)):
            raise ValueError(f"time = {time!r}: must be a finite number of seconds")
        state = self.initial_state
        moved = propagate(state, time, PRECISIONS[self.precision], with_rate="velocity" in wanted)
        synthesis = Synthesis(moved, state.grid, self.parameters, self._trough_damping)
        return SurfaceFields(float(time), {name: OUTPUTS[name](synthesis) for name in sorted(wanted)})

    def frame(self, frame: float | Fraction, outputs: Iterable[str] = ("displacement",)) -> SurfaceFields:
        """Fields at a frame of the shot, which may hold a sub-frame."""
        return self.surface(self.parameters.timing.time(frame), outputs)

    def statistics(self) -> Statistics:
        """Wave height, period and wavelength: of the spectrum, as resolved, and of this seed."""
        return sea_statistics(self.parameters, self.initial_state)
