# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields over the patch: what a shot reads of a sea at one instant."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from .synthesis import Synthesis, X, Y, Z

RealArray = NDArray[np.floating]


def displacement(synthesis: Synthesis) -> RealArray:
    """(N, N, 3) m: what is added to the rest position (x, y, 0), choppiness applied."""
    return np.stack([synthesis.position(component) for component in (X, Y, Z)], axis=-1)


def slope(synthesis: Synthesis) -> RealArray:
    """(N, N, 2) m/m: derivatives of the elevation by the rest position's x and y."""
    return np.stack([synthesis.position(Z, along) for along in "xy"], axis=-1)


def velocity(synthesis: Synthesis) -> RealArray:
    """(N, N, 3) m/s: derivative of the displacement in ocean time."""
    return np.stack([synthesis.position(component, "t") for component in (X, Y, Z)], axis=-1)


def _gradient(synthesis: Synthesis) -> tuple[RealArray, RealArray, RealArray, RealArray]:
    """Jxx, Jxy, Jyx, Jyy of the map from the rest position to the displaced one, seen from above."""
    return (
        1.0 + synthesis.position(X, "x"),
        synthesis.position(X, "y"),
        synthesis.position(Y, "x"),
        1.0 + synthesis.position(Y, "y"),
    )


def jacobian(synthesis: Synthesis) -> RealArray:
    """(N, N): determinant of the gradient of x ↦ x + λD; 1 - λkA at the crest of one wave, < 0 in a fold."""
    xx, xy, yx, yy = _gradient(synthesis)
    return xx * yy - xy * yx


def min_eigenvalue(synthesis: Synthesis) -> RealArray:
    """(N, N): smaller eigenvalue of the gradient of x ↦ x + λD, < 0 where the surface folds.

    The crest field of Horvath (2015), § 8. The gradient is symmetric but where troughs are damped; there
    its symmetric part counts.
    """
    half_sum, half_difference, shear = _symmetric_part(synthesis)
    return half_sum - np.hypot(half_difference, shear)


def min_eigenvector(synthesis: Synthesis) -> RealArray:
    """(N, N, 2): unit vector along which the surface is squeezed most, its x ≥ 0."""
    _, half_difference, shear = _symmetric_part(synthesis)
    angle = 0.5 * np.arctan2(-shear, -half_difference)
    return np.stack((np.cos(angle), np.sin(angle)), axis=-1)


def _symmetric_part(synthesis: Synthesis) -> tuple[RealArray, RealArray, RealArray]:
    xx, xy, yx, yy = _gradient(synthesis)
    return 0.5 * (xx + yy), 0.5 * (xx - yy), 0.5 * (xy + yx)


def normal(synthesis: Synthesis) -> RealArray:
    """(N, N, 3): unit normal of the displaced surface, the cross product of its tangents."""
    xx, xy, yx, yy = _gradient(synthesis)
    zx, zy = synthesis.position(Z, "x"), synthesis.position(Z, "y")
    result = np.stack((yx * zy - zx * yy, zx * xy - xx * zy, xx * yy - xy * yx), axis=-1)
    result /= np.sqrt(np.sum(result * result, axis=-1, keepdims=True))
    return result


#: name of an output → its function; each name is an attribute of `SurfaceFields`
OUTPUTS: dict[str, Callable[[Synthesis], RealArray]] = {
    "displacement": displacement,
    "slope": slope,
    "velocity": velocity,
    "jacobian": jacobian,
    "min_eigenvalue": min_eigenvalue,
    "min_eigenvector": min_eigenvector,
    "normal": normal,
}


class SurfaceFields:
    """Fields of one instant on the (N, N) samples [y, x]; only those asked for exist.

    The names, shapes and units are those of the functions in `OUTPUTS`.
    """

    def __init__(self, time: float, fields: dict[str, RealArray]) -> None:
        self.time = time
        self._fields = fields

    def __getattr__(self, name: str) -> RealArray:
        if name in OUTPUTS:
            fields: dict[str, RealArray] = self.__dict__.get("_fields", {})
            if name in fields:
                return fields[name]
            made = ", ".join(sorted(fields)) or "nothing"
            raise AttributeError(
                f"{name} was not computed (only {made}): ask for it with surface(time, outputs={{'{name}'}})"
            )
        raise AttributeError(f"surface fields have no {name!r}: known are {', '.join(OUTPUTS)}")


def checked_outputs(outputs: Iterable[str]) -> frozenset[str]:
    """The wanted outputs as a set. Raises ValueError for a name that is not known."""
    wanted = frozenset((outputs,) if isinstance(outputs, str) else outputs)
    unknown = sorted(wanted - set(OUTPUTS))
    if unknown:
        raise ValueError(f"outputs = {unknown[0]!r}: must be among {', '.join(OUTPUTS)}")
    return wanted
