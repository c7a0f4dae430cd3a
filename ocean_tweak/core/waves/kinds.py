# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of all kinds of waves."""

from __future__ import annotations

from itertools import count

from ..data.errors import ParameterError
from .contribution import Contribution
from .hero.parameters import HeroWave
from .image.parameters import ImageLayer
from .spectral import WaveLayer
from .wake.parameters import WakeLayer
from .wind_field.parameters import WindFieldLayer

#: in the order in which their waves are added, on which sums of floats depend; a layer of which JSON does not
#: say its kind is of the first
KINDS: list[type[Contribution]] = [WaveLayer, HeroWave, ImageLayer, WindFieldLayer, WakeLayer]


def shown() -> list[type[Contribution]]:
    """The kinds in the order of menus and lists."""
    return sorted(KINDS, key=lambda kind: kind.names.number)


def identified(layers: tuple[Contribution, ...]) -> tuple[Contribution, ...]:
    """Layers with ids that are unique within each kind; layers without an id get the first free ones.

    Raises ParameterError for an id that two layers of a kind have.
    """
    taken: dict[str, set[int]] = {kind.kind: set() for kind in KINDS}
    for index, layer in enumerate(layers):
        if layer.id >= 0 and layer.id in taken[layer.kind]:
            raise ParameterError(f"layers.{index}.id", layer.id, "is already the id of another layer")
        taken[layer.kind].add(layer.id)
    result = list(layers)
    for index, layer in enumerate(layers):
        if layer.id < 0 and layer.has("id"):
            ids = taken[layer.kind]
            result[index] = layer.changed(id=next(number for number in count() if number not in ids))
            ids.add(result[index].id)
    return tuple(result)
