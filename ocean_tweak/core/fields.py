# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields over the patch: what a shot reads of a sea at one instant."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .synthesis import PositionRows, X, Y, Z

RealArray = NDArray[np.floating]


def displacement(rows: PositionRows, out: RealArray) -> None:
    """(N, N, 3) m: what is added to the rest position (x, y, 0), choppiness applied."""
    for component in (X, Y, Z):
        rows.position(component, out=out[..., component])


def slope(rows: PositionRows, out: RealArray) -> None:
    """(N, N, 2) m/m: derivatives of the elevation by the rest position's x and y."""
    for index, along in enumerate("xy"):
        rows.position(Z, along, out=out[..., index])


def velocity(rows: PositionRows, out: RealArray) -> None:
    """(N, N, 3) m/s: derivative of the displacement in ocean time."""
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

    Those of several patches add, once turned; normals, Jacobians and eigenvalues do not.
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

    The crest field of Horvath (2015), § 8. The gradient is symmetric but where troughs are damped; there
    its symmetric part counts.
    """
    half_sum, half_difference, shear = _symmetric_part(rows)
    # a square root of squares: strains are near 1, and hypot's care for overflow costs as much as a field
    np.multiply(half_difference, half_difference, out=half_difference)
    half_difference += shear * shear
    np.subtract(half_sum, np.sqrt(half_difference, out=half_difference), out=out)


def cusp(rows: PositionRows, out: RealArray) -> None:
    """(N, N): how far the surface is squeezed, 1 - min_eigenvalue; 0 where it is stretched, 1 in a fold."""
    min_eigenvalue(rows, out)
    np.subtract(1.0, out, out=out)
    np.maximum(out, 0.0, out=out)


def min_eigenvector(rows: PositionRows, out: RealArray) -> None:
    """(N, N, 2): unit vector along which the surface is squeezed most, its x ≥ 0."""
    _, half_difference, shear = _symmetric_part(rows)
    angle = 0.5 * np.arctan2(-shear, -half_difference)
    np.cos(angle, out=out[..., 0])
    np.sin(angle, out=out[..., 1])


def _symmetric_part(rows: PositionRows) -> tuple[RealArray, RealArray, RealArray]:
    """Half the sum and half the difference of the diagonal, and the mean of the others."""
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
    np.subtract(yx * zy, zx * yy, out=out[..., X])
    np.subtract(zx * xy, xx * zy, out=out[..., Y])
    np.subtract(xx * yy, xy * yx, out=out[..., Z])
    out /= np.sqrt(np.sum(out * out, axis=-1, keepdims=True))


class Output(NamedTuple):
    """How a field is made.

    write : fills its rows
    needs : components of the position and their derivatives that it is made of
    channels : numbers a sample; 0 for a plain (N, N) array
    """

    write: Callable[[PositionRows, RealArray], None]
    needs: frozenset[tuple[int, str]]
    channels: int

    def shape(self, resolution: int) -> tuple[int, ...]:
        """Shape of the whole field."""
        return (resolution, resolution, self.channels) if self.channels else (resolution, resolution)


_GRADIENT = frozenset({(X, "x"), (X, "y"), (Y, "x"), (Y, "y")})
_SLOPES = frozenset({(Z, "x"), (Z, "y")})

#: name of an output → how it is made; each name is an attribute of `SurfaceFields`
OUTPUTS: dict[str, Output] = {
    "displacement": Output(displacement, frozenset({(X, ""), (Y, ""), (Z, "")}), 3),
    "slope": Output(slope, _SLOPES, 2),
    "velocity": Output(velocity, frozenset({(X, "t"), (Y, "t"), (Z, "t")}), 3),
    "strain": Output(strain, _GRADIENT, 3),
    "jacobian": Output(jacobian, _GRADIENT, 0),
    "min_eigenvalue": Output(min_eigenvalue, _GRADIENT, 0),
    "cusp": Output(cusp, _GRADIENT, 0),
    "min_eigenvector": Output(min_eigenvector, _GRADIENT, 2),
    "normal": Output(normal, _GRADIENT | _SLOPES, 3),
}


#: the one output with a memory, made from others: (N, N), 0…1
FOAM = "foam"

KNOWN = (*OUTPUTS, FOAM)


class SurfaceFields:
    """Fields of one instant on the (N, N) samples [y, x]; only those asked for exist.

    The names are those in `OUTPUTS`, the shapes and units those of the functions named there; and `foam`,
    (N, N) in 0…1.
    """

    def __init__(self, time: float, fields: dict[str, RealArray]) -> None:
        self.time = time
        self._fields = fields

    def __contains__(self, name: str) -> bool:
        return name in self._fields

    def including(self, name: str, field: RealArray) -> SurfaceFields:
        """The same fields and one more."""
        return SurfaceFields(self.time, {**self._fields, name: field})

    def __getattr__(self, name: str) -> RealArray:
        if name in KNOWN:
            fields: dict[str, RealArray] = self.__dict__.get("_fields", {})
            if name in fields:
                return fields[name]
            made = ", ".join(sorted(fields)) or "nothing"
            raise AttributeError(
                f"{name} was not computed (only {made}): ask for it with surface(time, outputs={{'{name}'}})"
            )
        raise AttributeError(f"surface fields have no {name!r}: known are {', '.join(KNOWN)}")


def checked_outputs(outputs: Iterable[str]) -> frozenset[str]:
    """The wanted outputs as a set. Raises ValueError for a name that is not known."""
    wanted = frozenset((outputs,) if isinstance(outputs, str) else outputs)
    unknown = sorted(wanted - set(KNOWN))
    if unknown:
        raise ValueError(f"outputs = {unknown[0]!r}: must be among {', '.join(KNOWN)}")
    return wanted


def memory_groups(wanted: Iterable[str]) -> list[list[str]]:
    """The outputs in groups that are made one after the other, so that the arrays between the two passes
    serve them in turn: at most five of those, 20 bytes a sample. Velocity shares none with the others."""
    moving = sorted(
        name for name in wanted if any(derivative == "t" for _, derivative in OUTPUTS[name].needs)
    )
    still = sorted(set(wanted) - set(moving))
    return [group for group in (still, moving) if group]
