# SPDX-License-Identifier: GPL-3.0-or-later
"""How much foam a sea has, and where whitecaps begin: the compression of the surface beyond which it is foam.

With true wave heights hardly anything folds, so foam cannot wait for folding. Instead the threshold follows
from the sea's own strains, so that the share of the surface under foam is the one that winds leave at sea.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..parameters.ocean_parameters import FOAM_LAWS, OceanParameters
from ..spectral import constants
from ..synthesis.coefficients import InitialState
from ..waves.contribution import Wind
from .model import FAINTEST, FoamModel, births
from .windrows import windrows

Array = NDArray[np.float64]

#: compression from which foam may be born: below it are roundings of float32 fields, and of a sea without any
LEAST_COMPRESSION = 1e-6

#: directions of the gradient over which means are taken; levels of compression, and how far they reach in
#: standard deviations of the direction that is compressed most
_DIRECTIONS, _LEVELS, _REACH = 2048, 160, 9.0
#: the lowest level over the highest
_LOWEST = 1e-5
#: what is taken for none where logarithms are
_NONE = 1e-300
#: the strains' highest frequency over the root mean square, and the standard deviations at which a threshold
#: becomes rare
_BAND, _RARE = 2.0, 3.7
#: s; mean time for which a crest breaks at a place, at the most
_BREAKS_FOR = 0.35
#: of the range in which the threshold is looked for
_HALVINGS = 40


def foam_wind(parameters: OceanParameters) -> Wind | None:
    """The strongest of the winds that the layers are given by; None without one: swell does not break."""
    winds = [wind for layer in parameters.active() if (wind := layer.wind(parameters)) is not None]
    return max(winds, key=lambda wind: wind.speed) if winds else None


def callaghan_2008(wind_speed: float) -> float:
    """Share of the sea under whitecaps, Callaghan, de Leeuw, Cohen & O'Dowd (2008), eq. 1 and 2.

    wind_speed : m/s at 10 m. It was measured from 3.7 to 23 m/s; beyond, it is the upper curve.
    """
    slow = constants.CALLAGHAN_SLOW_FACTOR * max(0.0, wind_speed - constants.CALLAGHAN_LEAST) ** 3
    fast = constants.CALLAGHAN_FAST_FACTOR * (wind_speed + constants.CALLAGHAN_FAST_OFFSET) ** 3
    return slow if wind_speed <= constants.CALLAGHAN_FAST_FROM else fast


def monahan_1980(wind_speed: float) -> float:
    """Share of the sea under whitecaps, Monahan & O'Muircheartaigh (1980): 3.84·10⁻⁶ U^3.41.

    wind_speed : m/s at 10 m. It was measured up to 20 m/s; beyond, it gives twice what others saw.
    """
    return constants.WHITECAP_FACTOR * wind_speed**constants.WHITECAP_EXPONENT


#: a name in FOAM_LAWS → the law
_LAWS = dict(zip(FOAM_LAWS, (callaghan_2008, monahan_1980), strict=True))


def whitecap_coverage(wind_speed: float, law: str = FOAM_LAWS[0]) -> float:
    """Share of the sea under whitecaps, 0…1, for a wind in m/s at 10 m, by one of FOAM_LAWS."""
    return min(1.0, _LAWS[law](wind_speed))


class FoamOutlook(NamedTuple):
    """What foam a sea will have, and what it costs.

    coverage : share of the sea under foam, 0…1
    memory : earlier surfaces that a frame alone must look at
    """

    coverage: float
    memory: int


def foam_outlook(parameters: OceanParameters) -> FoamOutlook:
    """Coverage and cost of the foam, without making any."""
    coverage = _coverage(parameters)
    model = FoamModel(1.0 if coverage > 0.0 else math.inf, parameters.foam.half_life, (0.0, 0.0), 1.0)
    return FoamOutlook(coverage, model.memory)


def _coverage(parameters: OceanParameters) -> float:
    wind = foam_wind(parameters)
    foam = parameters.foam
    return min(1.0, foam.coverage * whitecap_coverage(wind.speed, foam.law)) if wind is not None else 0.0


@dataclass(frozen=True)
class Strains:
    """How often a random sea is compressed by how much; arrays by level.

    level : compression (1 - minimum eigenvalue), ascending
    share : of the places at rest that are compressed by more
    area : of the horizontal plane that these cover; compressed places cover less
    crossings : how often in a second a place comes to be compressed by more
    frequency : root mean square of that of the gradient, rad/s
    """

    level: Array
    share: Array
    area: Array
    crossings: Array
    frequency: float

    def at(self, compression: Array, name: str) -> Array:
        """One of the other arrays between its levels: what falls by orders of magnitude, by its logarithm."""
        of_levels = np.log(np.maximum(getattr(self, name), _NONE))
        return np.asarray(np.exp(np.interp(np.log(compression), np.log(self.level), of_levels)))

    def covered(self, threshold: float, half_life: float) -> float:
        """The mean of the foam over the horizontal plane, new and old, with this threshold.

        The share of the plane where F > f is that where the present c is, and of the rest where a birth has
        left as much: one of strength c does for T log₂(c/f) seconds. Births are crossings of the compression
        at which c begins to be born, rare and so independent; old foam lies on waves of any phase. Foam that
        is thinner than the faintest is none.
        """
        strength, rise = births()
        octaves = np.diff(np.log2(strength), prepend=2.0 * np.log2(strength[0]) - np.log2(strength[1]))
        share, area, crossings = (self.at(threshold * rise, name) for name in ("share", "area", "crossings"))
        later = half_life * np.cumsum((crossings * octaves)[::-1])[::-1] / np.maximum(1.0 - share, 1e-3)
        covered = 1.0 - (1.0 - area) * np.exp(-later)
        return float(np.sum(covered * strength * octaves)) * math.log(2.0) + FAINTEST * float(covered[0])

    def highest_frequency(self, threshold: float) -> float:
        """Frequency in rad/s up to which the compression must be known in time, to tell when it is over a
        threshold.

        That is twice the root mean square, and more for a threshold that is so rare that the compression
        rises little above it: by a share of 1/u² of it, u the standard deviations at which it lies.
        """
        share = float(self.at(np.array([threshold]), "share")[0])
        deviations = math.sqrt(max(0.0, -2.0 * math.log(share)))
        return _BAND * self.frequency * max(1.0, deviations / _RARE)

    def threshold(self, coverage: float, half_life: float) -> float:
        """The compression from which foam is to be born, so that it covers a share of the sea.

        It is never below LEAST_COMPRESSION, so that a sea without compression has no foam.
        """
        low, high = np.log(self.level[0]), np.log(self.level[-1])
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if self.covered(math.exp(middle), half_life) > coverage:
                low = middle
            else:
                high = middle
        return max(LEAST_COMPRESSION, math.exp(low))


def strain_covariances(
    state: InitialState,
    choppiness: float,
    drift: tuple[float, float],
    rotation: float = 0.0,
    interpolated: bool = False,
) -> tuple[Array, Array]:
    """Covariances (3, 3) of the gradient's xx, yy and xy, and of their rates in 1/s²; those of waves add.

    They are of the waves that the grid resolves, as seen by a point that drifts with (x, y) m/s. The gradient
    of the horizontal displacement is Gaussian with the covariance of its spectrum; so is its rate,
    independent of it, with ω² (ω as the drifting point meets the waves) in the integral.

    rotation : by which the grid is turned against the axes of the drift and of the gradient, rad
    interpolated : whether what is wanted are the strains between the samples, bilinear: the mean square of a
        wave is less there, by (2 + cos kΔ)/3 along each axis
    """
    grid = state.grid
    kx, ky = grid.kx, grid.ky
    if rotation:
        c, s = np.cos(rotation), np.sin(rotation)
        kx, ky = c * grid.kx - s * grid.ky, s * grid.kx + c * grid.ky
    factor = choppiness * state.potential_factor.real.astype(np.float64)
    along = kx * drift[0] + ky * drift[1]
    components = np.stack([np.broadcast_to(c, grid.shape) for c in (kx**2, ky**2, kx * ky)])
    components *= factor
    energy, rates = np.zeros(grid.shape), np.zeros(grid.shape)
    for part in state.parts:
        present = part.expected_plus * grid.multiplicity, part.expected_minus * grid.multiplicity
        frequency = part.omega - along, part.omega + along
        energy += present[0] + present[1]
        rates += present[0] * frequency[0] ** 2 + present[1] * frequency[1] ** 2
    if interpolated:
        spacing = grid.domain_size / grid.resolution
        left = (2.0 + np.cos(grid.kx * spacing)) * (2.0 + np.cos(grid.ky * spacing)) / 9.0
        energy, rates = energy * left, rates * left
    flat = components.reshape(3, -1)
    gradient, change = ((flat * weight.ravel()) @ flat.T for weight in (energy, rates))
    return gradient, change


def gaussian_strains(of_gradient: Array, of_rates: Array) -> Strains:
    """Strains whose gradient and its rate have the covariances that `strain_covariances` gives.

    The compression is as large as the gradient, r times that of its direction, and r of a Gaussian gradient
    has the chi distribution of three numbers: so shares are means over directions of its tails, also far out.
    By Rice (1944) a level is crossed upwards at the mean of the positive rates there, a Gaussian's of the
    direction alone, times the compression's density.
    """
    xx, yy, xy = _root(of_gradient) @ _directions()
    half_difference = 0.5 * (xx - yy)
    root = np.hypot(half_difference, xy)
    compression = root - 0.5 * (xx + yy)
    turning = half_difference / np.maximum(root, 1e-300), xy / np.maximum(root, 1e-300)
    change = np.stack((0.5 * turning[0] - 0.5, -0.5 * turning[0] - 0.5, turning[1]))
    rate = np.sqrt(np.maximum(np.einsum("ip,ij,jp->p", change, of_rates, change), 0.0))
    is_compressed = compression > _LOWEST * LEAST_COMPRESSION
    compression, rate, xx, yy, xy = (part[is_compressed] for part in (compression, rate, xx, yy, xy))
    highest = max(_REACH * float(compression.max(initial=0.0)), LEAST_COMPRESSION / _LOWEST)
    level = np.geomspace(_LOWEST * highest, highest, _LEVELS)
    radius = np.minimum(level[:, np.newaxis] / compression, _RADII[-1])
    beyond = [np.interp(radius, _RADII, tail) for tail in _TAILS]
    share = np.sum(beyond[0], axis=1) / _DIRECTIONS
    # the mean of the Jacobian 1 + tr + det there, of which tr grows with r and det with r²
    area = share + np.sum(beyond[1] * (xx + yy) + beyond[2] * (xx * yy - xy * xy), axis=1) / _DIRECTIONS
    density = math.sqrt(2.0 / math.pi) * radius**2 * np.exp(-0.5 * radius**2) / compression
    crossings = np.sum(density * rate, axis=1) / (math.sqrt(2.0 * math.pi) * _DIRECTIONS)
    variance = float(np.trace(of_gradient))
    frequency = math.sqrt(float(np.trace(of_rates)) / variance) if variance > 0.0 else 0.0
    return Strains(level, share, np.maximum(area, 0.0), crossings, frequency)


def _root(covariance: Array) -> Array:
    """(3, 3) matrix that makes numbers of a covariance from independent ones."""
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def _directions() -> Array:
    """(3, _DIRECTIONS) unit vectors, evenly over the sphere: Fibonacci's spiral."""
    number = np.arange(_DIRECTIONS) + 0.5
    z = 1.0 - 2.0 * number / _DIRECTIONS
    longitude = math.pi * (1.0 + math.sqrt(5.0)) * number
    return np.stack((np.sqrt(1.0 - z * z) * np.cos(longitude), np.sqrt(1.0 - z * z) * np.sin(longitude), z))


def _chi_tails() -> tuple[Array, Array, Array, Array]:
    """Radii, and the means of 1, r and r² beyond each, of the length r of three standard normal numbers."""
    r = np.linspace(0.0, 14.0, 2801)
    normal = math.sqrt(2.0 / math.pi) * np.exp(-0.5 * r * r)
    beyond = np.array([math.erfc(radius / math.sqrt(2.0)) for radius in r])
    return r, beyond + r * normal, (r * r + 2.0) * normal, 3.0 * beyond + (r**3 + 3.0 * r) * normal


_RADII, *_TAILS = _chi_tails()


def foam_model(
    parameters: OceanParameters, strains_of: Callable[[tuple[float, float]], Strains], spacing: float
) -> FoamModel:
    """How the foam of a sea is born and lives.

    strains_of : gives the strains that a point with this drift in m/s meets, of the waves that the samples
        hold on which foam is made: so foam made coarser covers as much
    spacing : of those samples, m
    """
    foam, wind = parameters.foam, foam_wind(parameters)
    drift, rows = (0.0, 0.0), None
    threshold = breaking = frequency = math.inf
    if wind is not None:
        # separate patches have finer samples than those over the domain
        finest = parameters.patches[-1].spacing if parameters.is_cascade else spacing
        rows = windrows(wind.speed, wind.direction, parameters.domain_size, parameters.seed, finest)
        speed = foam.drift * wind.speed
        drift = (speed * math.cos(wind.direction), speed * math.sin(wind.direction))
    coverage = _coverage(parameters)
    if coverage > 0.0:
        strains = strains_of(drift)
        threshold = strains.threshold(coverage, foam.half_life)
        frequency = strains.highest_frequency(threshold)
        # what is left of it lasts half_life/ln 2 in the mean
        new = _BREAKS_FOR / (_BREAKS_FOR + foam.half_life / math.log(2.0))
        breaking = max(threshold, strains.threshold(new * coverage, 0.0))
    return FoamModel(
        threshold=threshold,
        breaking_threshold=breaking,
        half_life=foam.half_life,
        drift=drift,
        spacing=spacing,
        loop_duration=parameters.loop_duration,
        windrows=rows,
        frequency=frequency,
    )
