# SPDX-License-Identifier: GPL-3.0-or-later
"""The waves of one part of a sea, on a grid of their own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from ..foam import threshold as foam_threshold
from ..masks.noise import SeaTime
from ..masks.weights import weights
from ..numerics.interpolation import close
from ..numerics.memo import MEMO, remembered
from ..parameters.ocean_parameters import Foam, OceanParameters, Timing
from ..parameters.patch_seas import Part
from ..statistics.sea_spectrum import SeaSpectrum
from ..synthesis.channels import CHANNELS, memory_groups
from ..synthesis.coefficients import InitialState, initial_state
from ..synthesis.transforms import Rows, Synthesis
from ..synthesis.trough_damping import TroughDamping, trough_damping
from ..waves.contribution import Gives
from ..waves.kinds import KINDS
from .sampling import Key
from .surfaces import Field, bilinear, exact, turned_field, weighted_field

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

PRECISIONS = {"single": np.complex64, "double": np.complex128}


# seas that use them keep them alive; allocating new ones for each wind that is tried would cost as much as
# the waves
MEMO.limit("waves", 64)


@remembered("waves")
def _initial_state(parameters: OceanParameters, dtype: type) -> InitialState:
    return initial_state(parameters, dtype)


@remembered("trough filters")
def _damping(parameters: OceanParameters, dtype: type, strength: float) -> TroughDamping | None:
    peak = SeaSpectrum(parameters).peak_wave_number
    return trough_damping(strength, _initial_state(parameters, dtype), peak)


class PartWaves:
    """The waves of a part. Creating one is cheap; its coefficients are computed when needed.

    side : of the sea's domain, with which masks repeat, m
    precision, workers : as for an `Ocean`
    """

    def __init__(self, part: Part, side: float, precision: str, workers: int | None) -> None:
        self.part = part
        self.parameters = part.parameters
        self.precision = precision
        self._side = side
        self._workers = workers

    @property
    def is_on_tile(self) -> bool:
        """Whether its samples coincide with those of the sea's tile."""
        return self.part.patch == 0 and not self.part.rotation

    @cached_property
    def initial_state(self) -> InitialState:
        """Shared by all waves whose parameters differ only in settings that do not affect it."""
        return _initial_state(self.drawn_from, PRECISIONS[self.precision])

    @cached_property
    def drawn_from(self) -> OceanParameters:
        """All that waves follow from before time, choppiness and foam."""
        # the loop was checked against the shot's frame rate: keep that, but not the start frame
        timing = Timing(fps=self.parameters.timing.fps) if self.parameters.loop_duration else Timing()
        kept = Gives.SPECTRUM | Gives.COEFFICIENTS
        on_grid = tuple(layer for layer in self.parameters.layers if layer.gives & kept)
        return self.parameters.replace(
            choppiness=0.0, trough_damping=0.0, foam=Foam(), timing=timing, layers=on_grid
        )

    @cached_property
    def _synthesis(self) -> Synthesis:
        strength = self.parameters.trough_damping
        given = (kind.shares(self.parameters) for kind in KINDS if self.parameters.active(kind))
        return Synthesis(
            self.initial_state,
            self.parameters,
            _damping(self.drawn_from, PRECISIONS[self.precision], strength) if strength > 0.0 else None,
            PRECISIONS[self.precision],
            self._workers,
            tuple(sharing for sharing in given if sharing is not None),
        )

    def fill(self, time: float | Fraction, wanted: frozenset[str], fields: Mapping[str, RealArray]) -> None:
        """Fill the arrays of all outputs except foam on the part's own samples, the fastest case."""
        groups = memory_groups(wanted)
        needs = [frozenset().union(*(CHANNELS[name].needs for name in group)) for group in groups]
        most = max((len(self._synthesis.columns(each)) for each in needs), default=0)
        for group, needed in zip(groups, needs, strict=True):

            def write(block: slice, rows: Rows, group: Sequence[str] = group) -> None:
                for name in group:
                    CHANNELS[name].write(rows, fields[name][block])

            self._synthesis.fill(time, needed, write, most, sum(map(len, needs)))

    def components(
        self, time: float | Fraction, wanted: Iterable[Key], closed: bool = False
    ) -> dict[Key, RealArray]:
        """(N, N) components of the displacement, (0…2, ""), or their derivatives by "x", "y" or "t".

        closed : whether they are (N+1, N+1), with the first row and column repeated at the end
        """
        return components(self._synthesis, time, wanted, closed)

    def some(self, modes: NDArray[np.bool_]) -> Synthesis:
        """What makes some waves alone, of those with the sea's own frequencies.

        modes : (N, N//2+1, 2) which, of those along +k and of those along -k
        """
        state = self.initial_state
        both = enumerate((state.h_plus, state.h_minus))
        plus, minus = ((h.T * modes[..., side].T).T for side, h in both)
        some = replace(state, h_plus=plus, h_minus=minus, others=())
        return Synthesis(some, self.parameters, None, PRECISIONS[self.precision], self._workers)

    def exact_field(self, time: float | Fraction) -> Field:
        """The band-limited surface in the sea's axes, whose cost grows with points times wave vectors.

        Raises ValueError with trough damping, with which it is not a sum of waves.
        """
        if self.parameters.trough_damping > 0.0:
            raise ValueError("surface = 'exact': not available with trough damping; use mesh")
        return self._in_sea(exact(replace(self._synthesis, dtype=np.complex128), time), time)

    def mesh_field(self, time: float | Fraction, with_velocity: bool) -> tuple[Field, float]:
        """The surface bilinear between samples, and its largest horizontal displacement in m."""
        outputs = frozenset({"displacement"} | ({"velocity"} if with_velocity else set()))
        n, dtype = self.parameters.resolution, real_type(self.precision)
        made: dict[str, RealArray] = {name: np.empty((n, n, 3), dtype) for name in outputs}
        self.fill(time, outputs, made)
        displacement = made["displacement"]
        reach = float(np.max(np.hypot(displacement[..., 0], displacement[..., 1])))
        return self._in_sea(bilinear(displacement, made.get("velocity"), self.part.spacing), time), reach

    def _in_sea(self, field: Field, time: float | Fraction) -> Field:
        """A surface of these waves, rotated to the sea's axes and masked."""
        masks, when = self.part.masks, SeaTime(time, self.parameters.loop_duration)
        weights_at = partial(weights, masks, self._side, when=when) if masks else None
        return weighted_field(turned_field(field, self.part.rotation), weights_at)


def components(
    synthesis: Synthesis, time: float | Fraction, wanted: Iterable[Key], closed: bool = False
) -> dict[Key, RealArray]:
    """As `PartWaves.components` has them."""
    keys = frozenset(wanted)
    n, dtype = synthesis.state.grid.resolution, np.dtype(synthesis.dtype).type(0).real.dtype
    side = n + 1 if closed else n
    made: dict[Key, RealArray] = {key: np.empty((side, side), dtype) for key in keys}

    def write(block: slice, rows: Rows) -> None:
        for component, derivative in keys:
            rows.position(component, derivative, out=made[component, derivative][:n, :n][block])

    synthesis.fill(time, keys, write)
    for field in made.values() if closed else ():
        close(field)
    return made


def real_type(precision: str) -> type:
    """The floating-point type of fields."""
    return np.float32 if precision == "single" else np.float64


def strain_covariances(
    parts: Sequence[PartWaves], drift: tuple[float, float], between_samples: bool = False
) -> tuple[Array, Array]:
    """Strain covariances (see `core.foam.threshold.strain_covariances`) of several parts together, without
    masks.

    Waves are independent, so their covariances add up.

    between_samples : whether all parts are interpolated, which reduces their strains, and not only those
        whose samples differ from the tile's
    """
    found = [
        foam_threshold.strain_covariances(
            waves.initial_state, waves.parameters.choppiness, drift, waves.part.rotation,
            between_samples or not waves.is_on_tile,
        )
        for waves in parts
    ]  # fmt: skip
    gradients, rates = zip(*found, strict=True)
    return np.sum(gradients, axis=0), np.sum(rates, axis=0)
