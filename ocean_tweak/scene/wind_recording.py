# SPDX-License-Identifier: GPL-3.0-or-later
"""Force fields of the type Wind, recorded over the patch: what they were cannot be asked for later.

A field blows along its object's local z. At a point, with Strength S, its speed in m/s is S·f(d)·f(r):

    f(x) = 1                            below the field's minimum distance
    f(x) = 0                            beyond its maximum distance
    f(x) = (1 + x - x_min)^(-power)     between, x_min = 0 without a minimum

d is the distance from the object, with the shape Plane from its plane, and for the falloffs Tube and Cone
along z; r is the distance from that axis for Tube, the angle from it in degrees for Cone, and f(r) = 1 for
Sphere. Distances are in Blender units, as in the field's own settings. Noise is another for each of Blender's
evaluations and Flow drags particles rather than air: neither is recorded. The part across the water counts.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import Raster, WindKey
from ..core.data.plain_data import from_plain, parse_json, to_plain
from ..core.data.raster import check_numbers, numbers_in, raster_bytes
from ..core.numerics.memo import MEMO
from ..core.parameters.ocean_parameters import ParameterError
from ..core.waves.wind_field.parameters import MOST_KEYS
from .animated import clock_of, shown_settings
from .settings import OceanObjectError
from .shots import evaluations

Array = NDArray[np.float64]

#: vectors of a whole recording: some megabytes in the file
MOST_VECTORS = 1_000_000

_RECORDINGS = "wind recordings"


@dataclass(frozen=True)
class _Recording:
    """Keys that were read: they can be read again."""

    keys: tuple[WindKey, ...]
    nbytes: int


def record(
    item: bpy.types.Object,
    scene: bpy.types.Scene,
    frames: Sequence[int],
    samples: int,
    objects: bpy.types.Collection | None = None,
    told: Callable[[int], None] = lambda _count: None,
) -> tuple[WindKey, ...]:
    """The wind over an ocean's patch at each of the frames, which ascend; the scene ends where it was.

    samples : vectors along each side
    objects : the fields that count, by default all of the scene
    told : called with the number of frames that are done

    Raises OceanObjectError where nothing blows, for too many vectors, and for an ocean whose own time does
    not run forwards.
    """
    _check_size(len(frames), samples)
    names = {other.name for other in objects.all_objects} if objects is not None else None
    keys: list[WindKey] = []
    blows = False
    for count, depsgraph in enumerate(evaluations(scene, frames, item), start=1):
        fields = [
            other for other in depsgraph.objects if is_wind(other) and (names is None or other.name in names)
        ]
        blows = blows or bool(fields)
        settings = shown_settings(item, depsgraph)
        time = float(clock_of(settings, scene, settings.timing.start_frame).time)
        if keys and time <= keys[-1].time:
            raise OceanObjectError("Keyed Time must run forwards over the frames that are recorded")
        size = settings.domain_size
        vectors = patch_wind(fields, item.evaluated_get(depsgraph), size, samples)
        keys.append(WindKey(time, Raster(vectors, f"{item.name} wind")))
        told(count)
    if not blows:
        where = f"The collection {objects.name}" if objects is not None else "The scene"
        raise OceanObjectError(f"{where} has no force field of the type Wind: add one with Add > Force Field")
    return tuple(_without_repeats(keys))


def is_wind(item: bpy.types.Object) -> bool:
    """Whether an object is a force field of the type Wind."""
    return item.field is not None and item.field.type == "WIND"


def patch_wind(
    fields: Iterable[bpy.types.Object], item: bpy.types.Object, size: float, samples: int
) -> NDArray[np.float32]:
    """(samples, samples, 2) wind in m/s along the ocean's x and y.

    fields, item : evaluated
    size : of the patch, Blender units
    """
    places = np.arange(samples) * (size / samples)
    x, y = np.meshgrid(places, places)
    local = np.stack((x, y, np.zeros_like(x)), axis=-1)
    matrix = np.array(item.matrix_world, np.float64)
    points = local @ matrix[:3, :3].T + matrix[:3, 3]
    wind = sum((wind_at(field, points) for field in fields), np.zeros_like(points))
    axes = matrix[:3, :2] / np.linalg.norm(matrix[:3, :2], axis=0)
    # half as many digits are plenty, and half as long in the file
    return (wind @ axes).astype(np.float16).astype(np.float32)


def wind_at(item: bpy.types.Object, points: Array) -> Array:
    """(…, 3) wind of one field in m/s at places in the world, see above.

    item : evaluated
    points : (…, 3) Blender units
    """
    field, matrix = item.field, np.array(item.matrix_world, np.float64)
    axis = matrix[:3, 2] / np.linalg.norm(matrix[:3, 2])
    offset = points - matrix[:3, 3]
    along = offset @ axis
    distance = np.linalg.norm(offset, axis=-1)
    aside = np.sqrt(np.maximum(distance**2 - along**2, 0.0))
    strength = np.full(along.shape, field.strength)
    if field.falloff_type == "SPHERE":
        strength *= _near(field, np.abs(along) if field.shape == "PLANE" else distance)
    elif field.falloff_type == "TUBE":
        strength *= _near(field, np.abs(along)) * _beside(field, aside)
    else:
        strength *= _near(field, np.abs(along)) * _beside(field, np.degrees(np.arctan2(aside, along)))
    if field.z_direction == "POSITIVE":
        strength[along < 0.0] = 0.0
    elif field.z_direction == "NEGATIVE":
        strength[along > 0.0] = 0.0
    return strength[..., np.newaxis] * axis


def _near(field: bpy.types.FieldSettings, distance: Array) -> Array:
    least = field.distance_min if field.use_min_distance else None
    most = field.distance_max if field.use_max_distance else None
    return _falloff(distance, field.falloff_power, least, most)


def _beside(field: bpy.types.FieldSettings, distance: Array) -> Array:
    least = field.radial_min if field.use_radial_min else None
    most = field.radial_max if field.use_radial_max else None
    return _falloff(distance, field.radial_falloff, least, most)


def _falloff(distance: Array, power: float, least: float | None, most: float | None) -> Array:
    share = (1.0 + np.maximum(distance - (least or 0.0), 0.0)) ** -power
    return share if most is None else np.where(distance > most, 0.0, share)


def _check_size(frames: int, samples: int) -> None:
    if frames > MOST_KEYS:
        raise OceanObjectError(f"{frames} frames are too many for a recording: record fewer, at most "
        f"{MOST_KEYS} in all")  # fmt: skip
    if frames * samples**2 > MOST_VECTORS:
        raise OceanObjectError(
            f"{frames} frames of {samples}² vectors are too many: at most {MOST_VECTORS} in all; "
            "use fewer samples or a larger step"
        )


def _without_repeats(keys: Sequence[WindKey]) -> Iterable[WindKey]:
    """The keys without those between two like them: linear between is the same."""
    for index, key in enumerate(keys):
        is_inner = 0 < index < len(keys) - 1
        if not (is_inner and keys[index - 1].vectors == key.vectors == keys[index + 1].vectors):
            yield key


def to_text(keys: tuple[WindKey, ...]) -> tuple[str, str]:
    """Keys as JSON, and a hash that tells them from others."""
    text = json.dumps(to_plain(keys), separators=(",", ":"))
    name = hashlib.sha256(text.encode()).hexdigest()
    MEMO.put(_RECORDINGS, name, _Recording(keys, raster_bytes(keys)))
    return text, name


def known_keys(name: str) -> tuple[WindKey, ...] | None:
    """Keys by their hash, where they were read already."""
    found = MEMO.find(_RECORDINGS, name)
    return None if found is None else found.keys


def from_text(text: str, name: str) -> tuple[WindKey, ...]:
    """Keys from JSON, remembered by their hash. Raises ParameterError for what is damaged."""
    try:
        plain = parse_json(text)
        check_numbers(numbers_in(plain))
        keys = tuple(from_plain(WindKey, data) for data in plain)
    except (ValueError, TypeError) as error:
        raise ParameterError("recording", text[:20], f"cannot be read, record it again: {error}") from None
    MEMO.put(_RECORDINGS, name, _Recording(keys, raster_bytes(keys)))
    return keys
