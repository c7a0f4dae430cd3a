# SPDX-License-Identifier: GPL-3.0-or-later
"""How much foam a sea has, and the threshold of the compression above which whitecaps form.

At physical wave heights hardly any crest folds over, so folding cannot trigger foam. Instead the threshold is
derived from the statistics of the sea's strains, such that the covered fraction of the surface is the
whitecap coverage measured for the wind.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..parameters.foam import FOAM_LAWS
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.shot import Shot
from ..spectral import constants
from ..synthesis.coefficients import InitialState
from ..waves.contribution import Wind
from .model import FAINTEST, FoamModel, births
from .windrows import are_there, windrows

Array = NDArray[np.float64]

#: smallest compression at which foam may be born: values below are rounding noise of float32 fields
LEAST_COMPRESSION = 1e-6

#: number of directions of the gradient to average over; number of levels of compression, and their range in
# standard deviations of the most compressed direction
_DIRECTIONS, _LEVELS, _REACH = 2048, 160, 9.0
#: ratio of the lowest level to the highest
_LOWEST = 1e-5
#: stands for 0 in logarithms
_NONE = 1e-300
#: highest frequency of the strains over their root mean square frequency, and the threshold, in standard
# deviations, at which exceedances become rare
_BAND, _RARE = 2.0, 3.7
#: largest mean duration for which a crest breaks at a place, s
_BREAKS_FOR = 0.35
#: iterations of the search for the threshold
_HALVINGS = 40


def foam_wind(parameters: OceanParameters) -> Wind | None:
    """The strongest wind of the layers; None if there is none, as swell does not break."""
    winds = [wind for layer in parameters.active() if (wind := layer.wind(parameters)) is not None]
    return max(winds, key=lambda wind: wind.speed) if winds else None


def has_windrows(shot: Shot) -> bool:
    """Whether the wind may draw the foam out in any frame of a shot."""
    parameters = shot.parameters
    winds = [foam_wind(parameters)]
    for path, values in () if shot.animation is None else shot.animation.samples:
        owner, _, name = path.rpartition(".")
        if name not in ("wind_speed", "measured_time") or not isinstance(values, tuple):
            continue
        layer = parameters.layers[int(owner.rpartition(".")[2])]
        measured = getattr(layer, "measured", None)
        if name == "wind_speed":
            strongest: Sequence[float] = (max(values),)
        else:  # in between, and beyond the ends, no wind is stronger than at a time that was measured
            strongest = () if measured is None or measured.wind is None else measured.seconds.tolist()
        winds += [layer.changed(**{name: value}).wind(parameters) for value in strongest]
    return any(wind is not None and are_there(wind.speed) for wind in winds)


def callaghan_2008(wind_speed: float) -> float:
    """Whitecap coverage, a fraction, by Callaghan, de Leeuw, Cohen & O'Dowd (2008), eq. 1 and 2.

    wind_speed : m/s at 10 m. Measured from 3.7 to 23 m/s; the upper curve is used beyond.
    """
    slow = constants.CALLAGHAN_SLOW_FACTOR * max(0.0, wind_speed - constants.CALLAGHAN_LEAST) ** 3
    fast = constants.CALLAGHAN_FAST_FACTOR * (wind_speed + constants.CALLAGHAN_FAST_OFFSET) ** 3
    return slow if wind_speed <= constants.CALLAGHAN_FAST_FROM else fast


def monahan_1980(wind_speed: float) -> float:
    """Whitecap coverage, a fraction, by Monahan & O'Muircheartaigh (1980): 3.84·10⁻⁶ U^3.41.

    wind_speed : m/s at 10 m. Measured up to 20 m/s; beyond, it gives twice the coverage of later
        measurements.
    """
    return constants.WHITECAP_FACTOR * wind_speed**constants.WHITECAP_EXPONENT


#: a name in FOAM_LAWS → the law
_LAWS = dict(zip(FOAM_LAWS, (callaghan_2008, monahan_1980), strict=True))


def whitecap_coverage(wind_speed: float, law: str = FOAM_LAWS[0]) -> float:
    """Whitecap coverage, 0…1, for a wind in m/s at 10 m, by one of FOAM_LAWS."""
    return min(1.0, _LAWS[law](wind_speed))


class FoamOutlook(NamedTuple):
    """The amount and the cost of a sea's foam.

    coverage : fraction of the sea under foam, 0…1
    memory : number of earlier surfaces needed for a single frame
    """

    coverage: float
    memory: int


def foam_outlook(parameters: OceanParameters) -> FoamOutlook:
    """Coverage and cost of the foam, without computing any."""
    coverage = _coverage(parameters)
    model = FoamModel(1.0 if coverage > 0.0 else math.inf, parameters.foam.half_life, (0.0, 0.0), 1.0)
    return FoamOutlook(coverage, model.memory)


def _coverage(parameters: OceanParameters) -> float:
    wind = foam_wind(parameters)
    foam = parameters.foam
    return min(1.0, foam.coverage * whitecap_coverage(wind.speed, foam.law)) if wind is not None else 0.0


@dataclass(frozen=True)
class Strains:
    """Statistics of the compression of a random sea; arrays over levels of compression.

    level : compression (1 - minimum eigenvalue), ascending
    share : fraction of rest positions with a greater compression
    area : fraction of the horizontal plane that these cover; compressed places cover less
    crossings : up-crossings of the level per second at a place
    frequency : root mean square frequency of the gradient, rad/s
    """

    level: Array
    share: Array
    area: Array
    crossings: Array
    frequency: float

    def at(self, compression: Array, name: str) -> Array:
        """Interpolate one of the arrays between levels, in its logarithm, as it falls by orders of
        magnitude."""
        of_levels = np.log(np.maximum(getattr(self, name), _NONE))
        return np.asarray(np.exp(np.interp(np.log(compression), np.log(self.level), of_levels)))

    def covered(self, threshold: float, half_life: float) -> float:
        """Mean foam, new and old, over the horizontal plane for a threshold.

        F > f where the present c exceeds f, and elsewhere where a birth has left as much: a birth of strength
        c does so for T log₂(c/f) seconds. Births are up-crossings of the corresponding compression, rare and
        therefore independent; old foam lies on waves of any phase. Foam fainter than the limit counts as
        none.
        """
        strength, rise = births()
        octaves = np.diff(np.log2(strength), prepend=2.0 * np.log2(strength[0]) - np.log2(strength[1]))
        share, area, crossings = (self.at(threshold * rise, name) for name in ("share", "area", "crossings"))
        later = half_life * np.cumsum((crossings * octaves)[::-1])[::-1] / np.maximum(1.0 - share, 1e-3)
        covered = 1.0 - (1.0 - area) * np.exp(-later)
        return float(np.sum(covered * strength * octaves)) * math.log(2.0) + FAINTEST * float(covered[0])

    def highest_frequency(self, threshold: float) -> float:
        """Highest frequency in rad/s of the compression that must be resolved to detect exceedances of a
        threshold.

        It is twice the root mean square frequency, and more for a rare threshold, above which the compression
        rises only by a fraction of about 1/u², with the threshold at u standard deviations.
        """
        share = float(self.at(np.array([threshold]), "share")[0])
        deviations = math.sqrt(max(0.0, -2.0 * math.log(share)))
        return _BAND * self.frequency * max(1.0, deviations / _RARE)

    def threshold(self, coverage: float, half_life: float) -> float:
        """The threshold at which foam covers a given fraction of the sea.

        At least LEAST_COMPRESSION, so that a sea without compression has no foam.
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
    """Covariances (3, 3) of the gradient's xx, yy and xy, and of their rates in 1/s². Those of independent
    waves add up.

    They describe the waves that the grid resolves, seen from a point that drifts with (x, y) m/s. The
    gradient of the horizontal displacement is Gaussian, with the covariance of its spectrum; its rate is
    Gaussian and independent of it, with ω² (the encounter frequency of the drifting point) in the integral.

    rotation : of the grid relative to the axes of the drift and of the gradient, rad
    interpolated : whether strains are bilinearly interpolated between samples, which reduces the mean square
        of a wave by (2 + cos kΔ)/3 along each axis
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
        against = part.omega if part.omega_against is None else part.omega_against
        frequency = part.omega - along, against + along
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
    """Statistics of strains with the covariances returned by `strain_covariances`.

    The compression is proportional to the length r of the normalised gradient, and for a Gaussian gradient r
    has a chi distribution with three degrees of freedom: exceedances are averages of its tails over
    directions, accurate far out. By Rice (1944) the rate of up-crossings is the mean positive rate at the
    level, Gaussian for each direction, times the density of the compression.
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
    # the mean of the Jacobian 1 + tr + det there, with tr proportional to r and det to r²
    area = share + np.sum(beyond[1] * (xx + yy) + beyond[2] * (xx * yy - xy * xy), axis=1) / _DIRECTIONS
    density = math.sqrt(2.0 / math.pi) * radius**2 * np.exp(-0.5 * radius**2) / compression
    crossings = np.sum(density * rate, axis=1) / (math.sqrt(2.0 * math.pi) * _DIRECTIONS)
    variance = float(np.trace(of_gradient))
    frequency = math.sqrt(float(np.trace(of_rates)) / variance) if variance > 0.0 else 0.0
    return Strains(level, share, np.maximum(area, 0.0), crossings, frequency)


def _root(covariance: Array) -> Array:
    """(3, 3) matrix that maps independent normal numbers to ones with a given covariance."""
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def _directions() -> Array:
    """(3, _DIRECTIONS) unit vectors, evenly spread over the sphere on a Fibonacci spiral."""
    number = np.arange(_DIRECTIONS) + 0.5
    z = 1.0 - 2.0 * number / _DIRECTIONS
    longitude = math.pi * (1.0 + math.sqrt(5.0)) * number
    return np.stack((np.sqrt(1.0 - z * z) * np.cos(longitude), np.sqrt(1.0 - z * z) * np.sin(longitude), z))


def _chi_tails() -> tuple[Array, Array, Array, Array]:
    """Radii, and the tail means of 1, r and r² beyond each, with r the length of three standard normal
    numbers."""
    r = np.linspace(0.0, 14.0, 2801)
    normal = math.sqrt(2.0 / math.pi) * np.exp(-0.5 * r * r)
    beyond = np.array([math.erfc(radius / math.sqrt(2.0)) for radius in r])
    return r, beyond + r * normal, (r * r + 2.0) * normal, 3.0 * beyond + (r**3 + 3.0 * r) * normal


_RADII, *_TAILS = _chi_tails()


def foam_model(
    parameters: OceanParameters, strains_of: Callable[[tuple[float, float]], Strains], spacing: float
) -> FoamModel:
    """The foam model of a sea.

    strains_of : function that returns the strains met by a point with a drift in m/s, of the waves on the
        foam's own grid, so that coarser foam covers as much
    spacing : of the foam's grid, m
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
    if parameters.current is not None:
        x, y = parameters.current.velocity
        drift = (drift[0] + x, drift[1] + y)
    coverage = _coverage(parameters)
    if coverage > 0.0:
        strains = strains_of(drift)
        threshold = strains.threshold(coverage, foam.half_life)
        frequency = strains.highest_frequency(threshold)
        # mean duration of remaining foam: half_life/ln 2
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
