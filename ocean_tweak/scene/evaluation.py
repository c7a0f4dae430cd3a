# SPDX-License-Identifier: GPL-3.0-or-later
"""Caches the latest surfaces and the statistics of the open file's oceans."""

from __future__ import annotations

import json
import threading
from collections import OrderedDict
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters
from ..core.foam.model import FoamHistory, FoamModel, Whitecaps
from ..core.foam.threshold import LEAST_COMPRESSION, foam_outlook
from ..core.numerics.memo import MEMO, total_bytes
from ..core.synthesis.channels import CHANNELS, OF_MEMORY

RealArray = NDArray[np.float32]

# a frame with motion blur asks for n, n - ¼, n + ¼ and n again
_MOST_SURFACES = 4
# limit, as a fraction of the memory budget, for surfaces, which are quick to recompute
_PART = 8
# time in s after the last foam within which the next is quick to compute
_FOAM_IS_NEAR = Fraction(1)
# prefix of channel names for foam without its history
_INSTANT = "instant "
# compression, relative to the threshold, at which foam has half its strength
_HALF_STRENGTH = 1.125


class Surfaces:
    """An ocean and its latest surfaces."""

    def __init__(self, parameters: OceanParameters) -> None:
        self.ocean = Ocean(parameters)
        self._surfaces: OrderedDict[Fraction, dict[str, RealArray]] = OrderedDict()
        # arrays of an evicted surface, reused for the next one
        self._spare: dict[str, RealArray] = {}
        # foam depends on its history, which restarts when time goes back. Motion blur goes back and forth,
        # but whole frames ascend and so do subframes: each has a history of its own
        self._foam = {whole: FoamMaker(self.ocean) for whole in (True, False)}

    @property
    def nbytes(self) -> int:
        """Bytes of the surfaces, and of the arrays for the next one."""
        return sum(map(_bytes_of, [*self._surfaces.values(), self._spare]))

    def fields(
        self, time: Fraction, outputs: frozenset[str], is_whole: bool = True, patient: bool = True
    ) -> tuple[dict[str, RealArray], bool]:
        """Fields at a time in s by output, and whether they are final.

        Each is (N+1, N+1, …) float32, in m and m/s; the last row and column are the first ones again.
        Existing fields are reused. The arrays are overwritten by later surfaces, so they must be consumed at
        once.

        outputs : known to the core; foam needs cusp
        is_whole : whether it is the time of a whole frame
        patient : if False, foam is returned without its history if that would take long
        """
        kept = self._kept(time)
        self._make(time, kept, outputs - kept.keys() - OF_MEMORY)
        result = {name: kept[name] for name in outputs - OF_MEMORY}
        remembered = outputs & OF_MEMORY
        if remembered:
            before = self._foam_at(time, kept, self.foam_of(is_whole), patient)
            result.update({name: kept[before + name] for name in remembered})
        MEMO.put(_SURFACES, self.ocean.parameters, self)  # it has grown
        return result, remembered <= kept.keys()

    def _foam_at(self, time: Fraction, kept: dict[str, RealArray], maker: FoamMaker, patient: bool) -> str:
        """Compute the foam, with or without its history; returns the prefix of its channel names."""
        if "foam" not in kept and (patient or maker.is_near(time)):
            known = kept.get("cusp") if self.ocean.foam_is_of_its_samples else None
            made = Whitecaps(*map(self._array, Whitecaps._fields))
            inner = Whitecaps(*(field[:-1, :-1] for field in made))
            maker.at(time, None if known is None else known[:-1, :-1], inner)
            self._keep(kept, "", made)
        if "foam" in kept:
            return ""
        if _INSTANT + "foam" not in kept:
            foam = self._array(_INSTANT + "foam")
            foam[:-1, :-1] = _instant_foam(self.ocean.parameters, kept["cusp"][:-1, :-1])
            self._keep(kept, _INSTANT, Whitecaps(foam, foam, np.zeros_like(foam)))
        return _INSTANT

    def _keep(self, kept: dict[str, RealArray], before: str, made: Whitecaps) -> None:
        for name, field in made._asdict().items():
            _close(field)
            kept[before + name] = field

    def foam_of(self, is_whole: bool) -> FoamMaker:
        """The foam maker for whole frames or for subframes."""
        return self._foam[is_whole]

    def _make(self, time: Fraction, kept: dict[str, RealArray], outputs: frozenset[str]) -> None:
        if not outputs:
            return
        made = {name: self._array(name) for name in outputs}
        self.ocean.surface(time, outputs, out={name: field[:-1, :-1] for name, field in made.items()})
        for field in made.values():
            _close(field)
        kept.update(made)

    def _array(self, name: str) -> RealArray:
        if name in self._spare:
            return self._spare.pop(name)
        side = self.ocean.parameters.resolution + 1
        return np.empty(CHANNELS[name.removeprefix(_INSTANT)].shape(side), np.float32)

    def _kept(self, time: Fraction) -> dict[str, RealArray]:
        """Cached fields of a time; evicts the oldest ones if there are too many."""
        if time not in self._surfaces:
            largest = max(map(_bytes_of, self._surfaces.values()), default=0)
            # a surface that failed for want of memory has none
            most = min(MEMO.budget // _PART // max(largest, 1), _MOST_SURFACES)
            while len(self._surfaces) >= max(most, 1):
                self._spare = self._surfaces.popitem(last=False)[1]
            self._surfaces[time] = {}
        self._surfaces.move_to_end(time)
        return self._surfaces[time]


class FoamMaker:
    """Computes the foam of a sea; fast if time continues from the previous moment."""

    def __init__(self, ocean: Ocean) -> None:
        self._ocean = ocean
        self._history: FoamHistory | None = None
        self._last: Fraction | None = None
        # used by the window's thread and by the one that computes foam ahead
        self._busy = threading.Lock()

    def at(
        self, time: Fraction, compression: RealArray | None = None, out: Whitecaps | None = None
    ) -> Whitecaps:
        """(N, N) each. It may be called on any thread, and waits for another one.

        compression : (M, M) that the foam of this time is made of, where it is known
        out : arrays to fill
        """
        with self._busy:
            if self._history is None:
                self._history = self._ocean.new_foam_history()
            made = self._history.whitecaps(time, compression, out)
            self._last = self._reduced(time)
        return made

    def is_near(self, time: Fraction) -> bool:
        """Whether the foam of a time is quick to compute now."""
        if self._last is None or self._busy.locked():
            return False
        forgets = self._ocean.parameters.foam.half_life == 0.0
        return forgets or 0 <= self._reduced(time) - self._last <= _FOAM_IS_NEAR

    def _reduced(self, time: Fraction) -> Fraction:
        loop = self._ocean.parameters.loop_duration
        return time if loop is None else time % loop


def _instant_foam(parameters: OceanParameters, cusp: RealArray) -> RealArray:
    """(N, N) 0…1: foam where the (N, N) compression is largest, on as much of the sea as foam will cover.

    The threshold is read off this one field: the model's own, from the sea's statistics, takes longer to
    find than a surface takes to make.
    """
    coverage = foam_outlook(parameters).coverage
    covered = round(coverage * cusp.size)
    if covered == 0:
        return np.zeros_like(cusp)
    least = np.partition(cusp, cusp.size - covered, axis=None)[cusp.size - covered]
    if least <= LEAST_COMPRESSION:
        return np.zeros_like(cusp)
    model = FoamModel(float(least) / _HALF_STRENGTH, 0.0, (0.0, 0.0), 1.0)
    return model.strength(cusp).astype(np.float32)


def _bytes_of(fields: dict[str, RealArray]) -> int:
    return total_bytes(list(fields.values()))


def _close(field: RealArray) -> None:
    """Make the last row and column the first ones again."""
    field[-1, :-1] = field[0, :-1]
    field[:, -1] = field[:, 0]


# Kinds of what is kept, so that playback neither makes waves again nor, where the same frame is asked for
# several times, its surface.
_SURFACES, _STATISTICS = "surfaces", "statistics"
MEMO.limit(_SURFACES, _PART)


def surfaces_of(parameters: OceanParameters) -> Surfaces:
    """The surfaces of the sea with these parameters; oceans that are alike share them."""
    return MEMO.get(_SURFACES, parameters, lambda: Surfaces(parameters))


def known_statistics(parameters: OceanParameters) -> str | None:
    """The sea's statistics as JSON where they are known already."""
    return MEMO.find(_STATISTICS, _statistical(parameters))


def statistics_of(parameters: OceanParameters) -> str:
    """The sea's statistics as JSON. Raises MemoryError for a sea too large."""
    known = known_statistics(parameters)
    return known if known is not None else computed_statistics(parameters)


def computed_statistics(parameters: OceanParameters) -> str:
    """The sea's statistics as JSON, computed; touches no data of Blender and may run on any thread."""
    # of all waves, also those too short for the one grid that shows their sum
    return json.dumps(Ocean(parameters.separate).statistics().to_dict())


def keep_statistics(parameters: OceanParameters, statistics: str) -> None:
    """Store the result of `computed_statistics`."""
    MEMO.put(_STATISTICS, _statistical(parameters), statistics)


def _statistical(parameters: OceanParameters) -> OceanParameters:
    """What statistics depend on: heights, not what is done with them."""
    return parameters.replace(choppiness=0.0, trough_damping=0.0, orbital_motion="DEEP")
