# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea that can be asked for its surface at any time."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .exact_field import exact
from .fields import FOAM, OUTPUTS, SurfaceFields, checked_outputs, memory_groups
from .foam_field import FoamField
from .initial_state import InitialState, initial_state
from .memory import check_memory, memory_need
from .parameters import Foam, OceanParameters, Timing
from .sea_spectrum import SeaSpectrum
from .statistics import Statistics, sea_statistics
from .surface_query import Field, SurfacePoints, find_points, refine_points
from .synthesis import Rows, Synthesis
from .trough_damping import trough_damping
from .wave_particles.wind_waves import WindWaves

#: minimum eigenvalue below which several sheets of the surface are looked for
_NEARLY_FOLDED = 0.1

PRECISIONS = {"single": np.complex64, "double": np.complex128}

RealArray = NDArray[np.floating]


@lru_cache(maxsize=4)
def _cached_initial_state(parameters: OceanParameters, dtype: type) -> InitialState:
    return initial_state(parameters, dtype)


class Ocean:
    """The sea of some parameters. Making one is cheap; the first surface makes the initial state.

    parameters : OceanParameters
    precision : "single" for float32 fields, "double" for reference work in float64
    workers : threads that make a surface, by default one a core for 1024² samples or more, else one; the
        result does not depend on it

    Raises ValueError for an unknown precision, a number of workers below 1 or a sea of several patches, which
    is a `Cascade`.
    """

    def __init__(
        self, parameters: OceanParameters, precision: str = "single", workers: int | None = None
    ) -> None:
        if not isinstance(parameters, OceanParameters):
            raise TypeError(f"Ocean wants OceanParameters, not {type(parameters).__name__}")
        if precision not in PRECISIONS:
            raise ValueError(f"precision = {precision!r}: must be one of {', '.join(PRECISIONS)}")
        if workers is not None and workers < 1:
            raise ValueError(f"workers = {workers!r}: must be 1 or more")
        if parameters.is_cascade:
            raise ValueError(
                f"Ocean makes one patch and this sea has {len(parameters.patches)}, each with its own axes: "
                "use Cascade, whose `patches` are an Ocean each and whose fields are their sum"
            )
        self.parameters = parameters
        self.precision = precision
        self.workers = workers or default_workers(parameters.resolution)
        self._workspace: list[NDArray[np.complexfloating]] = []
        self._busy = threading.Lock()

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

    def surface(
        self,
        time: float | Fraction,
        outputs: Iterable[str] = ("displacement",),
        out: Mapping[str, RealArray] | None = None,
    ) -> SurfaceFields:
        """Fields at a time in s; only the outputs asked for are computed.

        out : arrays to fill, by output; their shape and dtype must be those of the field, and their last
            axis contiguous. Other outputs get new arrays.

        Raises ValueError for an unknown output, a time that is not finite or an array that does not fit.
        """
        wanted = checked_outputs(outputs)
        if not np.isfinite(float(time)):
            raise ValueError(f"time = {time!r}: must be a finite number of seconds")
        fields = self._arrays(wanted, out or {})
        with self._busy:  # the workspace and the foam's history serve one surface at a time
            self._fill(time, wanted - {FOAM}, fields)
            if FOAM in wanted:
                fields[FOAM][...] = self.foam.at(time)
        return SurfaceFields(float(time), fields)

    def _fill(self, time: float | Fraction, wanted: frozenset[str], fields: Mapping[str, RealArray]) -> None:
        for group in memory_groups(wanted):
            needs = frozenset().union(*(OUTPUTS[name].needs for name in group))

            def write(block: slice, rows: Rows, group: Sequence[str] = group) -> None:
                for name in group:
                    OUTPUTS[name].write(rows, fields[name][block])

            self._synthesis.fill(time, needs, write, self._workspace)

    def components(
        self, time: float | Fraction, wanted: Iterable[tuple[int, str]]
    ) -> dict[tuple[int, str], RealArray]:
        """(N, N) components of the displacement, (0…2, ""), or their derivatives by "x", "y" or "t"."""
        keys = frozenset(wanted)
        n = self.parameters.resolution
        dtype = np.float32 if self.precision == "single" else np.float64
        made = {key: np.empty((n, n), dtype) for key in keys}

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
    def foam(self) -> FoamField:
        """The sea's foam. Its history serves ascending times; any other time is made from the sea alone."""
        resolution = self.parameters.foam.resolution or self.parameters.resolution
        sea = self
        if resolution != self.parameters.resolution:
            sea = Ocean(self.parameters.at_resolution(resolution), self.precision, self.workers)

        def cusp_at(time: Fraction) -> RealArray:
            fields = sea._arrays(frozenset({"cusp"}), {})
            sea._fill(time, frozenset(fields), fields)
            return fields["cusp"]

        return FoamField(self.parameters, sea.initial_state, cusp_at)

    def _arrays(self, wanted: frozenset[str], out: Mapping[str, RealArray]) -> dict[str, RealArray]:
        dtype = np.float32 if self.precision == "single" else np.float64
        fields: dict[str, RealArray] = {}
        for name in sorted(wanted):
            n = self.parameters.resolution
            shape = (n, n) if name == FOAM else OUTPUTS[name].shape(n)
            array = out[name] if name in out else np.empty(shape, dtype)
            if array.shape != shape or array.dtype != dtype:
                raise ValueError(
                    f"out[{name!r}]: must be an array {shape} of {np.dtype(dtype)}, "
                    f"not {array.shape} of {array.dtype}"
                )
            fields[name] = array
        return fields

    def points_at(
        self,
        x: ArrayLike,
        y: ArrayLike,
        time: float | Fraction,
        surface: str = "mesh",
        velocity: bool = False,
    ) -> SurfacePoints:
        """The surface above places x and y in m, of any one shape, at a time in s.

        surface : "mesh" for the bilinear surface between the samples, which a mesh with a vertex a sample
            shows; "exact" for the band-limited one, whose cost grows with points times wave vectors
        velocity : whether it is wanted too

        Raises ValueError for an unknown surface, or an exact one with trough damping: no sum of waves.
        """
        if surface not in ("mesh", "exact"):
            raise ValueError(f"surface = {surface!r}: must be mesh or exact")
        waves = self.exact_field(time) if surface == "exact" else None
        outputs = {"displacement", "min_eigenvalue"} | ({"velocity"} if velocity else set())
        fields = self.surface(time, outputs)
        spacing = self.parameters.domain_size / self.parameters.resolution
        folded = fields.min_eigenvalue < _NEARLY_FOLDED
        moving = fields.velocity if velocity else None
        points = find_points(x, y, fields.displacement, moving, spacing, folded)
        if waves is None:
            return points
        return refine_points(x, y, waves, points, spacing, velocity)

    def height_at(
        self, x: ArrayLike, y: ArrayLike, time: float | Fraction, surface: str = "mesh"
    ) -> NDArray[np.float64]:
        """Height of the surface in m above places x and y in m, at a time in s; see `points_at`."""
        return self.points_at(x, y, time, surface).height

    def frame(self, frame: float | Fraction, outputs: Iterable[str] = ("displacement",)) -> SurfaceFields:
        """Fields at a frame of the shot, which may hold a sub-frame."""
        return self.surface(self.parameters.timing.time(frame), outputs)

    def statistics(self) -> Statistics:
        """Wave height, period and wavelength: of the spectrum, as resolved, and of this seed."""
        return sea_statistics(self.parameters, self.initial_state)


def default_workers(resolution: int) -> int:
    """Threads that help: one a core, but only one where a surface is too small to share."""
    return (os.cpu_count() or 1) if resolution >= 1024 else 1
