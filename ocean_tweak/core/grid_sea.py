# SPDX-License-Identifier: GPL-3.0-or-later
"""What every sea on the samples of one grid can be asked, however its waves are made."""

from __future__ import annotations

import os
import threading
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .channels import CHANNELS, FOAM, SurfaceFields, checked_outputs
from .foam import FoamModel
from .foam_field import FoamField
from .parameters import OceanParameters
from .statistics import Statistics
from .surface_query import Field, SurfacePoints, find_points, refine_points

#: minimum eigenvalue below which several sheets of the surface are looked for
_NEARLY_FOLDED = 0.1

PRECISIONS = {"single": np.complex64, "double": np.complex128}

RealArray = NDArray[np.floating]


class GridSea(ABC):
    """A sea whose fields are on the (N, N) samples [y, x] of one square that repeats.

    parameters : OceanParameters
    precision : "single" for float32 fields, "double" for reference work in float64
    workers : threads that make a surface, by default one a core for 1024² samples or more, else one; the
        result does not depend on it

    Raises ValueError for an unknown precision or a number of workers below 1.
    """

    def __init__(
        self, parameters: OceanParameters, precision: str = "single", workers: int | None = None
    ) -> None:
        if not isinstance(parameters, OceanParameters):
            raise TypeError(f"{type(self).__name__} wants OceanParameters, not {type(parameters).__name__}")
        if precision not in PRECISIONS:
            raise ValueError(f"precision = {precision!r}: must be one of {', '.join(PRECISIONS)}")
        if workers is not None and workers < 1:
            raise ValueError(f"workers = {workers!r}: must be 1 or more")
        self.parameters = parameters
        self.precision = precision
        self.workers = workers or default_workers(parameters.resolution)
        self._busy = threading.Lock()

    @abstractmethod
    def prepare(self) -> None:
        """Make the waves, which all surfaces share; the first surface does so otherwise.

        Raises MemoryError, before anything is made, where the machine is too small.
        """

    @abstractmethod
    def exact_field(self, time: float | Fraction) -> Field:
        """The band-limited surface at a time, whose cost grows with points times wave vectors.

        Raises ValueError for a sea with trough damping, which is no sum of waves.
        """

    @abstractmethod
    def statistics(self) -> Statistics:
        """Wave height, period and wavelength: of the spectrum, as resolved, and of this seed."""

    @cached_property
    @abstractmethod
    def foam_model(self) -> FoamModel:
        """How foam is born and lives that is made on these samples."""

    @abstractmethod
    def _fill(self, time: float | Fraction, wanted: frozenset[str], fields: Mapping[str, RealArray]) -> None:
        """Fill the arrays of all outputs but foam."""

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

    def frame(self, frame: float | Fraction, outputs: Iterable[str] = ("displacement",)) -> SurfaceFields:
        """Fields at a frame of the shot, which may hold a sub-frame."""
        return self.surface(self.parameters.timing.time(frame), outputs)

    @cached_property
    def foam(self) -> FoamField:
        """The sea's foam. Its history serves ascending times; any other time is made from the sea alone."""
        resolution = self.parameters.foam.resolution or self.parameters.resolution
        sea = self if resolution == self.parameters.resolution else self._at_resolution(resolution)

        def cusp_at(time: Fraction) -> RealArray:
            fields = sea._arrays(frozenset({"cusp"}), {})
            sea._fill(time, frozenset(fields), fields)
            return fields["cusp"]

        return FoamField(sea.foam_model, self.parameters.resolution, cusp_at)

    def _at_resolution(self, resolution: int) -> Self:
        return type(self)(self.parameters.at_resolution(resolution), self.precision, self.workers)

    @property
    def dtype(self) -> type:
        """Of the fields' numbers."""
        return np.float32 if self.precision == "single" else np.float64

    def _arrays(self, wanted: frozenset[str], out: Mapping[str, RealArray]) -> dict[str, RealArray]:
        fields: dict[str, RealArray] = {}
        for name in sorted(wanted):
            n = self.parameters.resolution
            shape = CHANNELS[name].shape(n)
            array = out[name] if name in out else np.empty(shape, self.dtype)
            if array.shape != shape or array.dtype != self.dtype:
                raise ValueError(
                    f"out[{name!r}]: must be an array {shape} of {np.dtype(self.dtype)}, "
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


def default_workers(resolution: int) -> int:
    """Threads that help: one a core, but only one where a surface is too small to share."""
    return (os.cpu_count() or 1) if resolution >= 1024 else 1
