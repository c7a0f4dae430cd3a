# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea of several patches that can be asked for its surface at any place and time."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import cached_property, partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..channels import CHANNELS, FOAM, SurfaceFields, checked_outputs
from ..foam import FoamModel
from ..foam_field import foam_model_of
from ..foam_threshold import Strains, sampled_strains
from ..masks.parameters import Mask
from ..masks.weights import Weights, weights
from ..memory import check_memory, memory_need
from ..ocean import Ocean
from ..parameters import OceanParameters
from ..surface_query import Field, SurfacePoints, bilinear, refine_points
from .foam import foam_at
from .patch_seas import Part, parts, patch_parameters, rotations
from .query import find_summed_points
from .sampling import (
    Components,
    Grid,
    Key,
    Summed,
    closed,
    summed_field,
    turned_field,
    unweighted,
    weighted_field,
)  # fmt: skip
from .statistics import CascadeStatistics, cascade_statistics
from .strains import summed_strain_covariances

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

_SQUEEZE = CHANNELS["cusp"].needs

#: bytes of squeezed surfaces of earlier moments that are kept for the next frame's foam
_KEPT = 2**28


class Cascade:
    """The sea of some parameters, whether of one patch or of several. Making one is cheap.

    patches : the `Ocean` of each patch, in axes along its own sides, without masks
    rotations : by which those axes are turned, rad counter-clockwise

    Patches that are joined are apart here: any place has all of their waves.

    precision, workers : as for an Ocean

    Raises ValueError as Ocean does.
    """

    def __init__(
        self, parameters: OceanParameters, precision: str = "single", workers: int | None = None
    ) -> None:
        if not isinstance(parameters, OceanParameters):
            raise TypeError(f"Cascade wants OceanParameters, not {type(parameters).__name__}")
        parameters = parameters.apart
        check_memory(memory_need(parameters, precision=precision).peak(), f"A sea of {_samples(parameters)}")
        self.parameters = parameters
        self.rotations = rotations(parameters)
        self._parts = parts(parameters)
        self._oceans = tuple(Ocean(part.parameters, precision, workers) for part in self._parts)
        self._kept: OrderedDict[Fraction, list[Components]] = OrderedDict()

    @cached_property
    def patches(self) -> tuple[Ocean, ...]:
        """The sea of each patch; where no mask parts them, they are what the sum is made of."""
        if not self.parameters.is_masked:
            return self._oceans
        first = self._oceans[0]
        return tuple(
            Ocean(patch, first.precision, first.workers) for patch in patch_parameters(self.parameters)
        )

    @property
    def spacings(self) -> tuple[float, ...]:
        """Metres between the samples of each patch."""
        return tuple(ocean.parameters.domain_size / ocean.parameters.resolution for ocean in self.patches)

    def surfaces(
        self, time: float | Fraction, outputs: Iterable[str] = ("displacement",)
    ) -> tuple[SurfaceFields, ...]:
        """Fields of each patch at a time in s, on its own samples and in its own axes.

        Displacement, velocity, slope and strain of the sea are the sums of theirs, each turned by the patch's
        rotation; the other fields are not sums.
        """
        wanted = checked_outputs(outputs)
        return tuple(ocean.surface(time, wanted) for ocean in self.patches)

    def fields_at(
        self, x: ArrayLike, y: ArrayLike, time: float | Fraction, outputs: Iterable[str] = ("displacement",)
    ) -> SurfaceFields:
        """Fields of the sum at rest positions x and y in m, of one shape, at a time in s.

        Each array is as long as the places, with the field's channels behind. Displacements and derivatives
        are bilinear in each patch and add up before a normal or eigenvalue is made of them.

        Raises ValueError for an unknown output or a time that is not finite.
        """
        wanted = checked_outputs(outputs)
        places_x, places_y = _places(x, y, time)
        shape, px, py = places_x.shape, places_x.ravel(), places_y.ravel()
        fields: dict[str, RealArray] = {}
        needs = frozenset().union(*(CHANNELS[name].needs for name in wanted - {FOAM}))
        sums = self._summed(px, py, self._components(time, needs))
        for name in wanted - {FOAM}:
            components = (CHANNELS[name].components,) if CHANNELS[name].components else ()
            field: RealArray = np.empty((px.size, *components), self._dtype)
            CHANNELS[name].write(sums, field)
            fields[name] = field.reshape(*shape, *components)
        if FOAM in wanted:
            fields[FOAM] = foam_at(self.foam_model, self._squeeze_at, px, py, time).reshape(shape)
        return SurfaceFields(float(time), fields)

    def area(
        self,
        size: float,
        resolution: int,
        time: float | Fraction,
        outputs: Iterable[str] = ("displacement",),
        corner: tuple[float, float] = (0.0, 0.0),
    ) -> SurfaceFields:
        """Fields of the sum on (N, N) samples [y, x] over a square of some size in m, from its corner.

        The square does not repeat: its far sides do not fit its near ones.
        """
        along = size / resolution * np.arange(resolution)
        return self.fields_at(corner[0] + along, (corner[1] + along)[:, np.newaxis], time, outputs)

    def points_at(
        self,
        x: ArrayLike,
        y: ArrayLike,
        time: float | Fraction,
        surface: str = "mesh",
        velocity: bool = False,
    ) -> SurfacePoints:
        """The surface above places x and y in m, of any one shape, at a time in s.

        surface : "mesh" for the sum of the patches' bilinear surfaces, "exact" for the band-limited one,
            whose cost grows with points times wave vectors
        velocity : whether it is wanted too

        Raises ValueError for an unknown surface or a time that is not finite.
        """
        if surface not in ("mesh", "exact"):
            raise ValueError(f"surface = {surface!r}: must be mesh or exact")
        if not self.parameters.is_sum:
            return self._oceans[0].points_at(x, y, time, surface, velocity)
        _places(x, y, time)
        outputs = {"displacement"} | ({"velocity"} if velocity else set())
        fields: list[Field] = []
        reach = 0.0
        for ocean, part in zip(self._oceans, self._parts, strict=True):
            made = ocean.surface(time, outputs)
            reach += float(np.max(np.hypot(made.displacement[..., 0], made.displacement[..., 1])))
            moving = made.velocity if velocity else None
            fields.append(self._in_sea(bilinear(made.displacement, moving, part.spacing), part))
        spacings = [part.spacing for part in self._parts]
        points = find_summed_points(x, y, fields, spacings, reach, velocity)
        if surface == "mesh":
            return points
        return refine_points(x, y, self.exact_field(time), points, min(spacings), velocity)

    def exact_field(self, time: float | Fraction) -> Field:
        """The band-limited surface of the sum, whose cost grows with points times wave vectors."""
        return summed_field(
            [
                self._in_sea(ocean.exact_field(time), part)
                for ocean, part in zip(self._oceans, self._parts, strict=True)
            ]
        )

    def _in_sea(self, field: Field, part: Part) -> Field:
        """A part's own surface in the sea's axes, under its masks."""
        weights_at = partial(weights, part.masks, self.parameters.domain_size) if part.masks else None
        return weighted_field(turned_field(field, part.rotation), weights_at)

    def height_at(
        self, x: ArrayLike, y: ArrayLike, time: float | Fraction, surface: str = "mesh"
    ) -> NDArray[np.float64]:
        """Height of the surface in m above places x and y in m, at a time in s; see `points_at`."""
        return self.points_at(x, y, time, surface).height

    def statistics(self) -> CascadeStatistics:
        """Wave height, period and wavelength of the sum, and of each patch."""
        return cascade_statistics(self.parameters, [ocean.statistics() for ocean in self.patches])

    @cached_property
    def foam_model(self) -> FoamModel:
        """How foam is born and lives: its threshold follows from the strains of all patches together."""
        sea = self._of_foam

        def strains_of(drift: tuple[float, float]) -> Strains:
            covariances = summed_strain_covariances(
                sea._oceans, sea._parts, drift, lambda _part: self.parameters.is_cascade
            )
            return sampled_strains(*covariances)

        return foam_model_of(self.parameters, strains_of, sea.spacings[-1])

    @cached_property
    def _of_foam(self) -> Cascade:
        """The sea at the resolution at which foam is made."""
        resolution = self.parameters.foam.resolution
        if resolution in (0, self.parameters.resolution):
            return self
        first = self._oceans[0]
        return Cascade(self.parameters.at_resolution(resolution), first.precision, first.workers)

    @property
    def _dtype(self) -> type:
        return np.float32 if self._oceans[0].precision == "single" else np.float64

    def _components(self, time: float | Fraction, needs: Iterable[Key]) -> list[Components]:
        wanted = closed(needs)
        if not wanted:
            return [{} for _ in self._oceans]
        return [
            ocean.components(time, unweighted(wanted) if part.masks else wanted)
            for ocean, part in zip(self._oceans, self._parts, strict=True)
        ]

    def _summed(self, x: Array, y: Array, components: Sequence[Components]) -> Summed:
        known: dict[tuple[Mask, ...], Weights] = {}
        found = []
        for part, of_part in zip(self._parts, components, strict=True):
            if part.masks and part.masks not in known:
                known[part.masks] = weights(part.masks, self.parameters.domain_size, x, y)
            grid = Grid(of_part, part.parameters.domain_size, part.rotation)
            found.append(grid.read(x, y, known.get(part.masks)))
        return Summed(found)

    def _squeeze_at(self, x: Array, y: Array, time: Fraction) -> RealArray:
        sea = self._of_foam
        squeeze = np.empty(x.shape, np.float32)
        CHANNELS["cusp"].write(sea._summed(x, y, self._squeezed(time)), squeeze)
        return squeeze

    def _squeezed(self, time: Fraction) -> list[Components]:
        """Strains of each patch at a time, of which the last ones are kept: the next frame looks back too."""
        if time not in self._kept:
            made = self._of_foam._components(time, _SQUEEZE)
            size = sum(field.nbytes for patch in made for field in patch.values())
            while self._kept and (len(self._kept) + 1) * size > _KEPT:
                self._kept.popitem(last=False)
            self._kept[time] = made
        return self._kept[time]


def _places(x: ArrayLike, y: ArrayLike, time: float | Fraction) -> tuple[Array, Array]:
    if not np.isfinite(float(time)):
        raise ValueError(f"time = {time!r}: must be a finite number of seconds")
    places_x, places_y = np.broadcast_arrays(np.asarray(x, np.float64), np.asarray(y, np.float64))
    if not (np.all(np.isfinite(places_x)) and np.all(np.isfinite(places_y))):
        raise ValueError("x and y: must be finite places in m")
    return places_x, places_y


def _samples(parameters: OceanParameters) -> str:
    sizes = [patch.resolution for patch in parameters.patches] or [parameters.resolution]
    return " and ".join(f"{size}²" for size in sizes) + " samples"
