# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of all fields and maps of a sea.

Fields over the patch, image maps, mesh attributes, primvars, point columns, the command line's choices and
docs/channels.md all follow from CHANNELS and MAPS. The formulas are defined above the table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from .transforms import PositionRows, X, Y, Z

RealArray = NDArray[np.floating]


def displacement(rows: PositionRows, out: RealArray) -> None:
    """(N, N, 3) m: offset from the rest position (x, y, 0), with choppiness applied."""
    for component in (X, Y, Z):
        rows.position(component, out=out[..., component])


def slope(rows: PositionRows, out: RealArray) -> None:
    """(N, N, 2) m/m: derivatives of the elevation with respect to the rest position's x and y."""
    for index, along in enumerate("xy"):
        rows.position(Z, along, out=out[..., index])


def velocity(rows: PositionRows, out: RealArray) -> None:
    """(N, N, 3) m/s: derivative of the displacement with respect to ocean time."""
    for component in (X, Y, Z):
        rows.position(component, "t", out=out[..., component])


def _gradient(rows: PositionRows) -> tuple[RealArray, RealArray, RealArray, RealArray]:
    """Jxx, Jxy, Jyx, Jyy of the map from the rest position to the displaced one, seen from above."""
    return (
        1.0 + rows.position(X, "x"),
        rows.position(X, "y"),
        rows.position(Y, "x"),
        1.0 + rows.position(Y, "y"),
    )


def strain(rows: PositionRows, out: RealArray) -> None:
    """(N, N, 3): of the horizontal displacement, Dx by x, Dy by y, and the mean of Dx by y and Dy by x.

    Rotated strains of several patches add up; normals, Jacobians and eigenvalues do not.
    """
    rows.position(X, "x", out=out[..., 0])
    rows.position(Y, "y", out=out[..., 1])
    np.multiply(rows.position(X, "y") + rows.position(Y, "x"), 0.5, out=out[..., 2])


def jacobian(rows: PositionRows, out: RealArray) -> None:
    """(N, N): determinant of the gradient of x ↦ x + λD; 1 - λkA at one wave's crest, < 0 in a fold."""
    xx, xy, yx, yy = _gradient(rows)
    np.subtract(xx * yy, xy * yx, out=out)


def min_eigenvalue(rows: PositionRows, out: RealArray) -> None:
    """(N, N): smaller eigenvalue of the gradient of x ↦ x + λD, < 0 where the surface folds.

    The crest field of Horvath (2015), § 8. With trough damping the gradient is not symmetric, and its
    symmetric part is used.
    """
    half_sum, half_difference, shear = _symmetric_part(rows)
    # plain square root: strains are near 1, and hypot's overflow protection costs as much as a field
    np.multiply(half_difference, half_difference, out=half_difference)
    half_difference += shear * shear
    np.subtract(half_sum, np.sqrt(half_difference, out=half_difference), out=out)


def cusp(rows: PositionRows, out: RealArray) -> None:
    """(N, N): how far the surface is compressed, 1 - min_eigenvalue; 0 where it is stretched, 1 in a fold."""
    min_eigenvalue(rows, out)
    np.subtract(1.0, out, out=out)
    np.maximum(out, 0.0, out=out)


def min_eigenvector(rows: PositionRows, out: RealArray) -> None:
    """(N, N, 2): unit vector of strongest compression, with x ≥ 0."""
    _, half_difference, shear = _symmetric_part(rows)
    angle = 0.5 * np.arctan2(-shear, -half_difference)
    np.cos(angle, out=out[..., 0])
    np.sin(angle, out=out[..., 1])


def _symmetric_part(rows: PositionRows) -> tuple[RealArray, RealArray, RealArray]:
    """Half the sum and half the difference of the diagonal, and the mean of the off-diagonal elements."""
    along_x, along_y = rows.position(X, "x"), rows.position(Y, "y")
    across, also_across = rows.position(X, "y"), rows.position(Y, "x")
    shear = across if across is also_across else 0.5 * (across + also_across)
    half_sum = along_x + along_y
    half_sum *= 0.5
    half_sum += 1.0
    half_difference = along_x - along_y
    half_difference *= 0.5
    return half_sum, half_difference, shear


def normal(rows: PositionRows, out: RealArray) -> None:
    """(N, N, 3): unit normal of the displaced surface, the cross product of its tangents."""
    xx, xy, yx, yy = _gradient(rows)
    zx, zy = rows.position(Z, "x"), rows.position(Z, "y")
    parts = [yx * zy, zx * xy, xx * yy]
    for part, (first, second) in zip(parts, ((zx, yy), (xx, zy), (xy, yx)), strict=True):
        part -= first * second
    largest = max(max(float(np.max(part)), -float(np.min(part))) for part in parts)
    if largest > 1e18:  # whose square underflows float32
        for part in parts:
            part /= largest
    # each component in its own array: reductions over an axis of length 3 would take longer than everything
    # else
    length = np.multiply(parts[X], parts[X], out=xx)
    for part in parts[Y:]:
        length += np.multiply(part, part, out=yy)
    np.sqrt(length, out=length)
    for component, part in enumerate(parts):
        np.divide(part, length, out=out[..., component])


class UsdAttribute(NamedTuple):
    """How a channel is stored in a USD layer.

    name, type : of the attribute; the type is a name in `Sdf.ValueTypeNames`
    halved : whether it may be stored in 16 bits
    """

    name: str
    type: str
    halved: bool = False


#: how values transform under rotation: not at all, as x, y (, z), or as xx, yy, xy of a symmetric tensor
SCALAR, VECTOR, TENSOR = "scalar", "vector", "tensor"
_SUFFIXES = {SCALAR: ("",), VECTOR: ("_x", "_y", "_z"), TENSOR: ("_xx", "_yy", "_xy")}

#: what a channel is computed from: the waves at one instant, the history of the foam, or the energy of all
# waves at a place, whatever the time
WAVES, MEMORY, STATE = "waves", "foam", "state"

_PLACE = frozenset({(X, ""), (Y, ""), (Z, "")})
_MOTION = frozenset({(X, "t"), (Y, "t"), (Z, "t")})
_GRADIENT = frozenset({(X, "x"), (X, "y"), (Y, "x"), (Y, "y")})
_SLOPES = frozenset({(Z, "x"), (Z, "y")})


@dataclass(frozen=True)
class Channel:
    """The properties of a field.

    name : of the output; an attribute of `SurfaceFields`
    text : description, for the documentation
    unit : m or m/s for values that scale with the scene's units, s, or 1
    components : values per sample; 0 for a plain (N, N) array
    turns : SCALAR, VECTOR or TENSOR
    make : function that fills its rows; None unless its source is WAVES
    needs : components of the position and their derivatives that it is computed from
    source : WAVES, MEMORY for fields that depend on earlier times, or STATE for those that depend on none
    adds : whether the rotated fields of the patches add up to that of the sea
    rest : its values on a flat sea
    attribute : of meshes in Blender; "" for none
    switch : the ocean's setting that enables it on the ocean's own mesh; "" if it is always there, None if
        only meshes of patches, or over a bed, have it
    usd : None if USD layers do not have it
    """

    name: str
    text: str
    unit: str
    components: int
    turns: str
    make: Callable[[PositionRows, RealArray], None] | None
    needs: frozenset[tuple[int, str]]
    source: str = WAVES
    adds: bool = False
    rest: float | tuple[float, ...] = 0.0
    attribute: str = ""
    switch: str | None = None
    usd: UsdAttribute | None = None

    def write(self, rows: PositionRows, out: RealArray) -> None:
        """Fill the rows of a field whose source is WAVES."""
        assert self.make is not None
        self.make(rows, out)

    def shape(self, resolution: int) -> tuple[int, ...]:
        """Shape of the whole field."""
        return (resolution, resolution, self.components) if self.components else (resolution, resolution)

    @property
    def scales(self) -> bool:
        """Whether its values are in metres or metres per second."""
        return self.unit.startswith("m")

    @property
    def is_rate(self) -> bool:
        """Whether its values are per second."""
        return self.unit.endswith("/s")

    @property
    def columns(self) -> tuple[str, ...]:
        """A name for each of its values."""
        return tuple(self.name + suffix for suffix in _SUFFIXES[self.turns][: max(self.components, 1)])


_ROWS = (
    Channel(
        "displacement", "from the rest position to the present one", "m", 3, VECTOR, displacement, _PLACE,
        adds=True, attribute="displacement", switch="",
    ),
    Channel(
        "slope", "of the elevation, by the place at rest", "1", 2, VECTOR, slope, _SLOPES,
        adds=True, attribute="slope",
    ),
    Channel(
        "velocity", "of the water at the surface", "m/s", 3, VECTOR, velocity, _MOTION,
        adds=True, attribute="velocity", switch="use_velocity",
        usd=UsdAttribute("velocities", "Vector3fArray"),
    ),
    Channel(
        "strain", "of the horizontal displacement", "1", 3, TENSOR, strain, _GRADIENT,
        adds=True, attribute="strain",
    ),
    Channel(
        "jacobian", "remaining area of each piece of the surface; below 0 in a fold",
        "1", 0, SCALAR, jacobian, _GRADIENT, rest=1.0,
    ),
    Channel(
        "min_eigenvalue", "remaining length along the direction of strongest compression; below 0 in a "
            "fold",
        "1", 0, SCALAR, min_eigenvalue, _GRADIENT, rest=1.0,
    ),
    Channel(
        "cusp", "how far the surface is compressed: 0 where it is stretched, 1 in a fold", "1", 0, SCALAR,
        cusp, _GRADIENT, attribute="cusp", switch="use_foam",
        usd=UsdAttribute("primvars:cusp", "FloatArray", halved=True),
    ),
    Channel(
        "min_eigenvector", "unit vector along which the surface is compressed most", "1", 2, VECTOR,
        min_eigenvector, _GRADIENT, rest=(1.0, 0.0),
    ),
    Channel(
        "normal", "unit normal of the waves themselves", "1", 3, VECTOR, normal, _GRADIENT | _SLOPES,
        rest=(0.0, 0.0, 1.0), attribute="custom_normal", switch="use_normals",
        usd=UsdAttribute("normals", "Normal3fArray"),
    ),
    Channel(
        "foam", "how much of the water is white, 0 to 1", "1", 0, SCALAR, None, frozenset(), source=MEMORY,
        attribute="foam", switch="use_foam", usd=UsdAttribute("primvars:foam", "FloatArray", halved=True),
    ),
    Channel(
        "breaking", "how strongly the crest is breaking now, 0 to 1: the fresh part of the foam", "1", 0,
        SCALAR, None, frozenset(), source=MEMORY, attribute="breaking", switch="use_foam",
        usd=UsdAttribute("primvars:breaking", "FloatArray", halved=True),
    ),
    Channel(
        "foam_age", "age of the visible foam, by the waves' own clock; 0 where a crest is breaking and "
            "where there is no foam", "s", 0, SCALAR,
        None, frozenset(), source=MEMORY, attribute="foam_age", switch="use_foam",
        usd=UsdAttribute("primvars:foam_age", "FloatArray", halved=True),
    ),
    Channel(
        "significant_height", "of all waves around, 4 √m0; in the open sea the same everywhere", "m", 0,
        SCALAR, None, frozenset(), source=STATE, attribute="significant_height",
    ),
    Channel(
        "broken_share", "share of waves that are broken for lack of depth, 0 to 1", "1", 0, SCALAR, None,
        frozenset(), source=STATE, attribute="broken_share",
    ),
    Channel(
        "mean_direction", "unit vector towards which most of the energy runs; 0 where there are no waves",
        "1", 2, VECTOR, None, frozenset(), source=STATE, attribute="mean_direction",
    ),
)  # fmt: skip

#: by name
CHANNELS: dict[str, Channel] = {row.name: row for row in _ROWS}

#: a map's name in files, in the order used in jobs → the channels that fill its red, green and blue; the rest
# is 0
MAPS: dict[str, tuple[str, ...]] = {
    "disp": ("displacement",),
    "foam": ("foam", "cusp", "breaking"),
    "normal": ("normal",),
    "vel": ("velocity",),
    "slope": ("slope",),
    "strain": ("strain",),
    "foam_age": ("foam_age",),
    "hs": ("significant_height",),
    "qb": ("broken_share",),
    "direction": ("mean_direction",),
}

#: maps for which a precision of 2^-11 of the largest value is enough; positions and inputs of normals need
# more
HALVED_MAPS = frozenset({"foam", "normal", "vel", "foam_age"})

#: the map that displaces a surface: a sequence has it in every frame
MOVING_MAP = "disp"

#: outputs that depend on one instant only
OF_WAVES = {name: channel for name, channel in CHANNELS.items() if channel.source == WAVES}

#: outputs that depend on earlier times too, and are therefore computed in the order of frames
OF_MEMORY = frozenset(name for name, channel in CHANNELS.items() if channel.source == MEMORY)

#: outputs that depend on no time
OF_STATE = frozenset(name for name, channel in CHANNELS.items() if channel.source == STATE)

#: outputs of patches that add up, once rotated; normals and eigenvalues are computed from the sums
ADDING = frozenset(name for name, channel in CHANNELS.items() if channel.adds)


class Fields(Protocol):
    """Fields by channel name."""

    def __getitem__(self, name: str, /) -> RealArray:
        """The field of a channel."""


def channels_of(maps: Iterable[str]) -> frozenset[str]:
    """The channels that some maps contain."""
    return frozenset(name for each in maps for name in MAPS[each])


def unit_of(map_name: str) -> str:
    """The unit of a map's values."""
    return CHANNELS[MAPS[map_name][0]].unit


def is_put_together(map_name: str) -> bool:
    """Whether a map's image has to be assembled from several channels."""
    return CHANNELS[MAPS[map_name][0]].components != 3


def image_of(map_name: str, fields: Fields) -> RealArray:
    """(N, N, 3): a map's red, green and blue."""
    parts = [fields[name] for name in MAPS[map_name]]
    parts = [part[..., np.newaxis] if part.ndim == 2 else part for part in parts]
    rest = 3 - sum(part.shape[-1] for part in parts)
    if rest:
        parts.append(np.zeros((*parts[0].shape[:2], rest), parts[0].dtype))
    return np.concatenate(parts, axis=-1) if len(parts) > 1 else parts[0]


class SurfaceFields:
    """Fields at one instant on the (N, N) samples [y, x]; those not requested are None.

    The names, shapes and units are those of CHANNELS.
    """

    def __init__(self, time: float, fields: dict[str, RealArray]) -> None:
        self.time = time
        self._fields = fields

    def __contains__(self, name: str) -> bool:
        return name in self._fields

    def __getitem__(self, name: str) -> RealArray:
        """The field of a channel. Raises KeyError."""
        return self._fields[name]

    def including(self, others: SurfaceFields) -> SurfaceFields:
        """A copy with further fields."""
        return SurfaceFields(self.time, {**self._fields, **others._fields})

    def __getattr__(self, name: str) -> RealArray:
        if name in CHANNELS:
            fields: dict[str, RealArray] = self.__dict__.get("_fields", {})
            if name in fields:
                return fields[name]
            made = ", ".join(sorted(fields)) or "nothing"
            raise AttributeError(
                f"{name} was not computed (only {made}): ask for it with surface(time, outputs={{'{name}'}})"
            )
        raise AttributeError(f"surface fields have no {name!r}: known are {', '.join(CHANNELS)}")


def checked_outputs(outputs: Iterable[str]) -> frozenset[str]:
    """The requested outputs as a set. Raises ValueError for an unknown name."""
    wanted = frozenset((outputs,) if isinstance(outputs, str) else outputs)
    unknown = sorted(wanted - CHANNELS.keys())
    if unknown:
        raise ValueError(f"outputs = {unknown[0]!r}: must be among {', '.join(CHANNELS)}")
    return wanted


def memory_groups(wanted: Iterable[str]) -> list[list[str]]:
    """Split the outputs into groups that are computed one after another, so that they can share the arrays
    between the two passes: at most five, 20 bytes per sample. Velocity shares none with the others."""
    moving = sorted(
        name for name in wanted if any(derivative == "t" for _, derivative in CHANNELS[name].needs)
    )
    still = sorted(set(wanted) - set(moving))
    return [group for group in (still, moving) if group]
