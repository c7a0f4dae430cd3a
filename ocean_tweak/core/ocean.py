# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea that can be asked for its surface at any time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from .channels import CHANNELS, memory_groups
from .exact_field import exact
from .foam import FoamModel
from .foam_field import foam_model
from .grid_sea import PRECISIONS, GridSea
from .initial_state import InitialState, initial_state
from .memory import check_memory, memory_need
from .parameters import Foam, OceanParameters, Timing
from .sea_spectrum import SeaSpectrum
from .statistics import Statistics, sea_statistics
from .surface_query import Field
from .synthesis import Rows, Synthesis
from .trough_damping import trough_damping
from .waves.wind_field.wind_waves import WindWaves

RealArray = NDArray[np.floating]


@lru_cache(maxsize=4)
def _cached_initial_state(parameters: OceanParameters, dtype: type) -> InitialState:
    return initial_state(parameters, dtype)


class Ocean(GridSea):
    """The sea of some parameters as one sum of waves. Making one is cheap; its waves are made when needed.

    parameters : OceanParameters
    precision : "single" for float32 fields, "double" for reference work in float64
    workers : threads that make a surface, by default one a core for 1024² samples or more, else one; the
        result does not depend on it

    Raises ValueError for an unknown precision, a number of workers below 1, or a sea of several patches or
    with masks: `seas.grid_sea` makes either where it is on one grid.
    """

    def __init__(
        self, parameters: OceanParameters, precision: str = "single", workers: int | None = None
    ) -> None:
        super().__init__(parameters, precision, workers)
        if parameters.is_cascade:
            raise ValueError(
                f"Ocean makes one patch and this sea has {len(parameters.patches)}, each with its own axes: "
                "use Cascade, whose `patches` are an Ocean each and whose fields are their sum"
            )
        if parameters.is_sum:
            raise ValueError(
                "Ocean makes waves that are everywhere on one grid, and this sea's are joined from patches "
                "or lie under masks: use grid_sea for its fields on one grid, or Cascade"
            )
        self._workspace: list[NDArray[np.complexfloating]] = []

    @cached_property
    def initial_state(self) -> InitialState:
        """Shared by all oceans whose parameters differ only in what acts after it.

        Raises MemoryError, before anything is made, where the machine is too small.
        """
        need = memory_need(self.parameters, precision=self.precision).peak()
        check_memory(need, f"A sea of {self.parameters.resolution}² samples")
        # a loop's frames were checked against the shot's timing: keep that, but not its start
        timing = Timing(fps=self.parameters.timing.fps) if self.parameters.loop_duration else Timing()
        shared = self.parameters.replace(
            choppiness=0.0, trough_damping=0.0, foam=Foam(), timing=timing, wind_fields=()
        )
        return _cached_initial_state(shared, PRECISIONS[self.precision])

    def prepare(self) -> None:
        """Make the initial state."""
        self.initial_state  # noqa: B018

    @cached_property
    def _synthesis(self) -> Synthesis:
        damping = None
        if self.parameters.trough_damping > 0.0:
            peak = SeaSpectrum(self.parameters).peak_wave_number
            damping = trough_damping(self.parameters.trough_damping, self.initial_state, peak)
        return Synthesis(
            self.initial_state,
            self.parameters,
            damping,
            PRECISIONS[self.precision],
            self.workers,
            WindWaves(self.parameters) if self.parameters.active_wind_fields else None,
        )

    def _fill(self, time: float | Fraction, wanted: frozenset[str], fields: Mapping[str, RealArray]) -> None:
        for group in memory_groups(wanted):
            needs = frozenset().union(*(CHANNELS[name].needs for name in group))

            def write(block: slice, rows: Rows, group: Sequence[str] = group) -> None:
                for name in group:
                    CHANNELS[name].write(rows, fields[name][block])

            self._synthesis.fill(time, needs, write, self._workspace)

    def components(
        self, time: float | Fraction, wanted: Iterable[tuple[int, str]]
    ) -> dict[tuple[int, str], RealArray]:
        """(N, N) components of the displacement, (0…2, ""), or their derivatives by "x", "y" or "t"."""
        keys = frozenset(wanted)
        n = self.parameters.resolution
        made: dict[tuple[int, str], RealArray] = {key: np.empty((n, n), self.dtype) for key in keys}

        def write(block: slice, rows: Rows) -> None:
            for component, derivative in keys:
                rows.position(component, derivative, out=made[component, derivative][block])

        with self._busy:
            self._synthesis.fill(time, keys, write, self._workspace)
        return made

    def exact_field(self, time: float | Fraction) -> Field:
        """The band-limited surface at a time, whose cost grows with points times wave vectors.

        Raises ValueError for a sea with trough damping, which is no sum of waves.
        """
        if self.parameters.trough_damping > 0.0:
            raise ValueError("surface = 'exact': there is none with trough damping; use mesh")
        return exact(replace(self._synthesis, dtype=np.complex128), time)

    @cached_property
    def foam_model(self) -> FoamModel:
        """How foam is born and lives: its threshold follows from the strains that these samples hold."""
        return foam_model(self.parameters, self.initial_state)

    def statistics(self) -> Statistics:
        """Wave height, period and wavelength: of the spectrum, as resolved, and of this seed."""
        return sea_statistics(self.parameters, self.initial_state)
