# SPDX-License-Identifier: GPL-3.0-or-later
"""`Ocean`: computes the surface of any sea at any time.

A sea is a sum of parts: waves on grids of their own, which may be rotated and masked. The tile of a single
part without rotation or mask is computed directly; all others are summed on the tile's samples or at places.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..foam.drifting import DriftingFoam, whitecaps_at
from ..foam.model import FoamHistory, FoamModel, Whitecaps
from ..foam.threshold import Strains, foam_model, gaussian_strains
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import merged_bands, parts, patch_parameters
from ..statistics.sea_statistics import Statistics, sea_statistics
from ..synthesis.channels import (
    CHANNELS,
    OF_MEMORY,
    OF_STATE,
    OF_WAVES,
    SurfaceFields,
    checked_outputs,
)
from ..synthesis.coefficients import InitialState
from ..waves.contribution import MemoryNeed
from .coast_state import StateFields, open_state
from .coast_waves import CoastWaves
from .memory import check_memory, memory_need
from .part_waves import PRECISIONS, PartWaves, real_type, strain_covariances
from .placed_waves import PlacedWaves, check_repeats, has_tile, placed_waves, with_own_foam
from .placed_waves import strain_covariances as placed_strain_covariances
from .query import SurfacePoints, find_points, refine_points
from .regions import TILE, Area, Places, Tile
from .statistics import statistics_of_patches
from .sums import AnywhereSum, TileSum

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: minimum eigenvalue below which the surface is searched for several sheets
_NEARLY_FOLDED = 0.1


class Ocean:
    """The sea described by some parameters. Creating one is cheap; its waves are computed when needed.

    The sea may have one patch or several, merged or separate, with or without masks.

    parameters : OceanParameters
    precision : "single" for float32 fields, "double" for reference work in float64
    workers : threads per surface; by default one per core if that helps (from 1024² samples, or for many
        fields of 512²), else one. The result does not depend on it

    Raises ValueError for an unknown precision or fewer than 1 worker. Methods that need the waves raise
    MemoryError, before computing any, if the machine has too little memory.

    Examples
    --------
    >>> from ocean_tweak.core import Ocean, OceanParameters, WaveLayer
    >>> parameters = OceanParameters(resolution=64, layers=(WaveLayer(wind_speed=12.0, fetch=150e3),))
    >>> sea = Ocean(parameters)
    >>> sea.surface(time=2.5).displacement.shape
    (64, 64, 3)
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
        self.parameters = parameters
        self.precision = precision
        self._workers = workers

    @property
    def patches(self) -> tuple[Ocean, ...]:
        """The seas with a tile each: separate patches, in axes along their sides and without masks.

        Displacement, velocity, slope and strain of the sea are the sums of theirs, each rotated by the
        patch's rotation; other fields do not add up. Any other sea is its own only patch.

        Examples
        --------
        >>> from ocean_tweak.core import Ocean, OceanParameters, Patch
        >>> large = Patch(domain_size=400.0, resolution=64, shortest_wavelength=25.0)
        >>> small = Patch(domain_size=50.0, resolution=64, longest_wavelength=25.0)
        >>> [patch.parameters.domain_size for patch in Ocean(OceanParameters(patches=(large, small))).patches]
        [400.0, 50.0]
        """
        return self._separate if self.parameters.is_cascade else (self,)

    @cached_property
    def _separate(self) -> tuple[Ocean, ...]:
        return tuple(
            Ocean(patch, self.precision, self._workers) for patch in patch_parameters(self.parameters)
        )

    @cached_property
    def parts(self) -> tuple[Ocean, ...]:
        """The waves of each patch under each mask as seas of their own, without the mask and in axes along
        the patch's sides: rotated and weighted, they add up to the sea. Merged patches are separate here.
        """
        return tuple(Ocean(part.parameters, self.precision, self._workers) for part in parts(self.parameters))

    def memory(self, outputs: Iterable[str] = ("displacement",), on: Tile | Area = TILE) -> MemoryNeed:
        """Memory that the sea uses, and that each surface with these outputs uses.

        Examples
        --------
        >>> from ocean_tweak.core import Ocean, OceanParameters
        >>> sea = Ocean(OceanParameters(resolution=64, domain_size=200.0, seed=3))
        >>> sea.memory({"displacement"}).surface >= 64 * 64 * 3 * 4
        True
        """
        return memory_need(self.parameters, outputs, self.precision, on)

    def prepare(self, tell: Callable[[float], None] = lambda done: None) -> None:
        """Compute the waves that all surfaces share; otherwise the first surface does so.

        tell : is told again and again which share is done of what takes long: a coast's waves

        Examples
        --------
        >>> from ocean_tweak.core import Ocean, OceanParameters
        >>> sea = Ocean(OceanParameters(resolution=64, domain_size=200.0, seed=3))
        >>> sea.prepare()
        """
        for waves in self._parts:
            waves.initial_state  # noqa: B018
        if self.coast is not None:
            self.coast.make(tell)

    @property
    def initial_state(self) -> InitialState:
        """The Fourier coefficients of a sea on a single grid. Raises ValueError for any other sea."""
        if self.parameters.needs_summation:
            raise ValueError(
                "initial_state: this sea is several sums of waves, or has masks: ask each of its "
                "`patches`, or a sea without masks"
            )
        return self._parts[0].initial_state

    def surface(
        self,
        time: float | Fraction,
        outputs: Iterable[str] = ("displacement",),
        on: Tile | Area | Places = TILE,
        out: Mapping[str, RealArray] | None = None,
    ) -> SurfaceFields:
        """Fields at a time in s; only the requested outputs are computed.

        on : where to compute them. Arrays are (N, N) [y, x] on a tile, (resolution, resolution) in an area,
            and have the shape of the places otherwise, followed by the field's channels. In areas and at
            places, parts are interpolated bilinearly and summed before normals and eigenvalues are computed;
            the foam of a sea with a tile is that of the tile.
        out : arrays to fill, by output; their shape and dtype must be those of the field, and their last
            axis contiguous. Other outputs get new arrays.

        Raises ValueError for an unknown output, a time that is not finite, an array that does not fit, or a
        tile of a sea without one: with separate patches, which have one each, or with waves that do not
        repeat.

        Examples
        --------
        >>> from ocean_tweak.core import Area, Ocean, OceanParameters
        >>> sea = Ocean(OceanParameters(resolution=64, domain_size=200.0, seed=3))
        >>> fields = sea.surface(2.5, {"displacement", "normal"})
        >>> fields.normal.shape, fields.normal.dtype
        ((64, 64, 3), dtype('float32'))
        >>> sea.surface(2.5, on=Area(size=50.0, resolution=16)).displacement.shape
        (16, 16, 3)
        """
        wanted = checked_outputs(outputs)
        _check_time(time)
        if isinstance(on, Tile):
            tile, n = self._tile, self.parameters.resolution
            fields = self._arrays(wanted, (n, n), out or {})
            tile.fill(time, wanted & OF_WAVES.keys(), fields)
            if wanted & OF_STATE:
                _fill(fields, self._state_at(np.zeros(n * n), np.zeros(n * n)))
            if wanted & OF_MEMORY:
                known = fields.get("cusp") if self.foam_is_of_its_samples else None
                _fill(fields, self.foam_history.whitecaps(time, known))
        else:
            x, y = on.rest_positions()
            fields = self._arrays(wanted, x.shape, out or {})
            self._anywhere.fill(x.ravel(), y.ravel(), time, wanted & OF_WAVES.keys(), fields)
            if wanted & OF_STATE:
                _fill(fields, self._state_at(x.ravel(), y.ravel()))
            if wanted & OF_MEMORY:
                _fill(fields, self._whitecaps_at(x.ravel(), y.ravel(), time))
        return SurfaceFields(float(time), fields)

    def frame(
        self,
        frame: float | Fraction,
        outputs: Iterable[str] = ("displacement",),
        on: Tile | Area | Places = TILE,
    ) -> SurfaceFields:
        """Fields at a frame or subframe of the shot.

        Examples
        --------
        >>> from ocean_tweak.core import Ocean, OceanParameters
        >>> sea = Ocean(OceanParameters(resolution=64, domain_size=200.0, seed=3))
        >>> sea.frame(25).time  # frame 1 is 0 s, and 24 frames are a second
        1.0
        """
        return self.surface(self.parameters.timing.time(frame), outputs, on)

    def points_at(
        self,
        x: ArrayLike,
        y: ArrayLike,
        time: float | Fraction,
        surface: str = "mesh",
        velocity: bool = False,
    ) -> SurfacePoints:
        """The surface above places x and y in m, of any shape, at a time in s.

        surface : "mesh" for the surface bilinear between samples, as on a mesh with one vertex per sample, or
            the sum of these surfaces for separate patches; "exact" for the band-limited surface, at a cost
            proportional to the number of points times that of wave vectors
        velocity : whether to compute velocities as well

        Raises ValueError for an unknown surface, a time or place that is not finite, or an exact surface with
        trough damping, which is not a sum of waves.

        Examples
        --------
        >>> from ocean_tweak.core import Ocean, OceanParameters
        >>> sea = Ocean(OceanParameters(resolution=64, domain_size=200.0, seed=3))
        >>> sea.points_at([0.0, 10.0], 5.0, time=2.5, velocity=True).velocity.shape
        (2, 3)
        """
        if surface not in ("mesh", "exact"):
            raise ValueError(f"surface = {surface!r}: must be mesh or exact")
        _check_time(time)
        x, y = Places(x, y).rest_positions()
        exact = self._anywhere.exact_field(time) if surface == "exact" else None
        if not self._has_tile:
            points, spacing = self._anywhere.points_above(x, y, time, velocity)
        else:
            points, spacing = self._points_of_tile(x, y, time, velocity)
        return points if exact is None else refine_points(x, y, exact, points, spacing, velocity)

    def height_at(
        self, x: ArrayLike, y: ArrayLike, time: float | Fraction, surface: str = "mesh"
    ) -> NDArray[np.float64]:
        """Height of the surface in m above places x and y in m, at a time in s; see `points_at`.

        Examples
        --------
        >>> from ocean_tweak.core import Ocean, OceanParameters
        >>> sea = Ocean(OceanParameters(resolution=64, domain_size=200.0, seed=3))
        >>> sea.height_at([0.0, 200.0], 5.0, time=2.5).round(3)  # the domain repeats after 200 m
        array([-0.354, -0.354])
        """
        return self.points_at(x, y, time, surface).height

    def statistics(self) -> Statistics:
        """Wave height, period and wavelength of the spectrum, as resolved by the grid, and of this seed.

        For merged patches, of the waves on the merged grid; always without masks.

        Examples
        --------
        >>> from ocean_tweak.core import Ocean, OceanParameters, WaveLayer
        >>> swell = WaveLayer(definition="SEA_STATE", significant_wave_height=2.0, peak_period=9.0)
        >>> sea = Ocean(OceanParameters(resolution=64, layers=(swell,)))
        >>> round(sea.statistics().significant_wave_height, 2)
        2.0
        """
        parameters = self._added_up
        patches = patch_parameters(parameters)
        whole = [Ocean(patch, self.precision, self._workers) for patch in patches]
        states = [sea.initial_state for sea in (whole if parameters.is_masked else self._parts)]
        found = [sea_statistics(patch, state) for patch, state in zip(patches, states, strict=True)]
        return statistics_of_patches(parameters, found) if parameters.patches else found[0]

    @cached_property
    def foam_model(self) -> FoamModel:
        """The foam model for foam computed on these samples.

        Its threshold is that of the sea without masks, from the strains of all parts together.
        """
        return foam_model(self.parameters, self._strains, self._spacing)

    @cached_property
    def foam_history(self) -> FoamHistory:
        """The history of the tile's foam, efficient for ascending times; foam at other times is computed from
        scratch.

        Raises ValueError for separate patches.
        """
        return self.new_foam_history()

    def new_foam_history(self) -> FoamHistory:
        """A further history of the same foam, for an independent sequence of times."""
        # avoid a reference cycle, so that both are freed as soon as they are unused
        sea, dtype = self.of_foam, real_type(self.precision)
        tile, n = sea._tile, sea.parameters.resolution

        def compression_at(time: Fraction) -> RealArray:
            # negative where the surface is stretched, as needed for interpolation in time
            left: RealArray = np.empty((n, n), dtype)
            tile.fill(time, frozenset({"min_eigenvalue"}), {"min_eigenvalue": left})
            return np.subtract(1.0, left, out=left)

        return FoamHistory(sea.foam_model, compression_at, self.parameters.resolution, self._workers)

    def _whitecaps_at(self, x: Array, y: Array, time: float | Fraction) -> Whitecaps:
        """Foam at flat arrays of places in m: that of the tile, or without one from the history of each
        place."""
        if self._has_tile:
            return self.foam_history.whitecaps(time).at(x, y, self.parameters.domain_size)
        sea = self.of_foam
        found = whitecaps_at(sea.foam_model, sea._anywhere.compression_at, x, y, time)
        if self.coast is None:
            return with_own_foam(self.parameters, found, x, y, time)
        whole = with_own_foam(self.parameters, found, x, y, time, self.coast.afloat)
        return whole.over(*self.coast.foam(x, y, time))

    def _state_at(self, x: Array, y: Array) -> StateFields:
        """At flat arrays of places in m; in the open sea the same everywhere, without masks."""
        if self.coast is not None:
            return self.coast.state(x, y)
        variance, flow = open_state(self._parts)
        return StateFields.of(np.full(x.shape, variance), np.zeros(x.shape), np.tile(flow, (len(x), 1)))

    def compression_at(self, x: Array, y: Array, time: Fraction) -> RealArray:
        """(places,) float32 compression at flat arrays of rest positions in m, negative where the sea is
        stretched."""
        return self._anywhere.compression_at(x, y, time)

    def new_drifting_foam(self, x: Array, y: Array) -> DriftingFoam:
        """Foam at arbitrary places that drift with it.

        x, y : (places,) rest positions at time 0, m
        """
        sea = self.of_foam
        return DriftingFoam(sea.foam_model, sea._anywhere.compression_at, x, y)

    @cached_property
    def divergence_variance(self) -> float:
        """Mean square of ∂Dx/∂x + ∂Dy/∂y, bilinear between samples, without masks."""
        (xx, yy, _), _ = self._strain_covariances((0.0, 0.0))
        return float(xx[0] + 2.0 * xx[1] + yy[1])

    @cached_property
    def mean_breaking(self) -> float:
        """Mean of the breaking foam over the horizontal plane at any time."""
        model = self.foam_model
        return self._strains(model.drift).covered(max(model.threshold, model.breaking_threshold), 0.0)

    @property
    def foam_is_of_its_samples(self) -> bool:
        """Whether foam uses the compression at these samples, not that of the sea at another resolution."""
        return self.parameters.foam.resolution in (0, self.parameters.resolution)

    @property
    def of_foam(self) -> Ocean:
        """The sea at the resolution of its foam."""
        return self if self.foam_is_of_its_samples else self._coarser

    @cached_property
    def _coarser(self) -> Ocean:
        resolution = self.parameters.foam.resolution
        return Ocean(self.parameters.at_resolution(resolution), self.precision, self._workers)

    @cached_property
    def _added_up(self) -> OceanParameters:
        """The sea with its merged patches on the separate grids from which they are summed."""
        return merged_bands(self.parameters) if self.parameters.merged_resolution else self.parameters

    @cached_property
    def _parts(self) -> tuple[PartWaves, ...]:
        sides = [patch.resolution for patch in self.parameters.patches if self.parameters.is_cascade]
        samples = " and ".join(f"{side}²" for side in sides or [self.parameters.resolution])
        check_memory(self.memory().peak(), f"A sea of {samples} samples")
        side = self.parameters.domain_size
        return tuple(PartWaves(part, side, self.precision, self._workers) for part in parts(self._added_up))

    @cached_property
    def _placed(self) -> tuple[PlacedWaves, ...]:
        return placed_waves(self.parameters)

    @cached_property
    def _tile(self) -> PartWaves | TileSum:
        """Computes the samples of the tile. Raises ValueError for a sea without one."""
        check_repeats(self.parameters)
        if self.parameters.is_cascade:
            raise ValueError(
                f"on = Tile(): patches that are separate, here {len(self.parameters.patches)}, have a tile "
                "each, in axes of their own: ask those in `patches`, ask for an Area or Places of their sum, "
                "or merge them with `parameters.on_one_grid(samples)`"
            )
        if not self.parameters.needs_summation:
            return self._parts[0]
        return TileSum(self.parameters, self._parts, real_type(self.precision), self._workers)

    @cached_property
    def _anywhere(self) -> AnywhereSum:
        return AnywhereSum(self.parameters, self._parts, self._placed, self.precision, self.coast)

    @cached_property
    def coast(self) -> CoastWaves | None:
        """What the waves are over the sea's bed; None for the open sea."""
        return CoastWaves(self.parameters, self._parts) if self.parameters.has_coast else None

    @property
    def _has_tile(self) -> bool:
        return has_tile(self.parameters)

    @property
    def _spacing(self) -> float:
        return self.parameters.domain_size / self.parameters.resolution

    def _arrays(
        self, wanted: frozenset[str], shape: tuple[int, ...], out: Mapping[str, RealArray]
    ) -> dict[str, RealArray]:
        dtype = real_type(self.precision)
        fields: dict[str, RealArray] = {}
        for name in sorted(wanted):
            components = CHANNELS[name].components
            whole = (*shape, components) if components else shape
            array = out[name] if name in out else np.empty(whole, dtype)
            if array.shape != whole or array.dtype != dtype:
                raise ValueError(
                    f"out[{name!r}]: must be an array {whole} of {np.dtype(dtype)}, "
                    f"not {array.shape} of {array.dtype}"
                )
            fields[name] = array
        return fields

    def _strains(self, drift: tuple[float, float]) -> Strains:
        """Strain statistics of all parts together, seen from a point with this drift."""
        return gaussian_strains(*self._strain_covariances(drift))

    def _strain_covariances(self, drift: tuple[float, float]) -> tuple[Array, Array]:
        between_samples = not self._has_tile
        gradient, rates = strain_covariances(self._parts, drift, between_samples)
        for of_gradient, of_rates in placed_strain_covariances(self.parameters, drift):
            gradient, rates = gradient + of_gradient, rates + of_rates
        return gradient, rates

    def _points_of_tile(
        self, x: ArrayLike, y: ArrayLike, time: float | Fraction, with_velocity: bool
    ) -> tuple[SurfacePoints, float]:
        """Points of the surface bilinear between the tile's samples, and the sample spacing in m."""
        outputs = {"displacement", "min_eigenvalue"} | ({"velocity"} if with_velocity else set())
        fields = self.surface(time, outputs)
        folded = fields.min_eigenvalue < _NEARLY_FOLDED
        moving = fields.velocity if with_velocity else None
        return find_points(x, y, fields.displacement, moving, self._spacing, folded), self._spacing


def _fill(fields: Mapping[str, RealArray], made: Whitecaps | StateFields) -> None:
    """Fill the fields that were made together."""
    for name in fields.keys() & set(made._fields):
        fields[name][...] = getattr(made, name).reshape(fields[name].shape)


def _check_time(time: float | Fraction) -> None:
    if not np.isfinite(float(time)):
        raise ValueError(f"time = {time!r}: must be a finite number of seconds")
