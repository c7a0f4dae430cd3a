# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh of a sea: quads between its samples, with the first row and column repeated at the far sides.

Vertices are in x-fastest order, from 0 to the domain's size, as in Blender.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.numerics.interpolation import wrapped

RealArray = NDArray[np.floating]


def turned(vectors: RealArray, up_axis: str) -> RealArray:
    """(…, 3) vectors in the axes of a layer: for Y up, rotated by -90° about x."""
    if up_axis == "Y":
        return np.stack([vectors[..., 0], vectors[..., 2], -vectors[..., 1]], axis=-1)
    return vectors


@dataclass(frozen=True)
class UsdGrid:
    """A mesh over the tile of a sea.

    size : side of the tile in m
    samples : along each side
    texels : along each side of images that cover it
    step : samples from one vertex to the next
    up_axis, scale : of the layer; scale in units per metre
    corner : (x, y) of the first vertex in m, for an area with one sample per vertex; None for a tile
    """

    size: float
    samples: int
    texels: int
    step: int = 1
    up_axis: str = "Z"
    scale: float = 1.0
    corner: tuple[float, float] | None = None

    @property
    def quads(self) -> int:
        """Along each side."""
        return self.samples // self.step

    @property
    def vertices(self) -> int:
        """Number of vertices."""
        return (self.quads + 1) ** 2

    def of_vertices(self, field: RealArray) -> RealArray:
        """Samples at the vertices, (quads + 1, quads + 1, …): a tile's first ones are repeated at the end."""
        steps = field[:: self.step, :: self.step]
        return wrapped(steps, np.float32) if self.corner is None else np.array(steps, np.float32)

    def turned(self, vectors: RealArray, scale: float = 1.0) -> RealArray:
        """(…, 3) vectors as (vertices, 3) in the layer's axes, times the scale; may modify the array."""
        vectors = turned(vectors, self.up_axis)
        if scale != 1.0:
            vectors *= scale
        return vectors.reshape(-1, 3)

    def positions(self, displacement: RealArray | None) -> RealArray:
        """(vertices, 3) float32: displaced vertices, or the flat ones."""
        count = self.quads + 1
        shape = (count, count, 3)
        position = np.zeros(shape, np.float32) if displacement is None else self.of_vertices(displacement)
        # summed in double precision and rounded once
        rest = np.arange(count) * (self.size / self.quads)
        x, y = self.corner or (0.0, 0.0)
        for component, along in ((0, x + rest), (1, y + rest[:, np.newaxis])):
            moved = position[..., component]
            np.add(moved, along, out=moved, dtype=np.float64, casting="same_kind")
        return self.turned(position, self.scale)

    def corners(self) -> NDArray[np.int32]:
        """(quads², 4) int32: vertices of each quad, counter-clockwise from above."""
        row = self.quads + 1
        first = np.arange(row * row, dtype=np.int32).reshape(row, row)[:-1, :-1].reshape(-1, 1)
        return first + np.array([0, 1, row + 1, row], np.int32)

    def texture_coordinates(self) -> RealArray:
        """(vertices, 2) float32: the centres of the samples' texels.

        x/size + ½/texels; an image of an area ends at the last vertex.
        """
        whole = 1.0 if self.corner is None else 1.0 - 1.0 / self.texels
        along = np.arange(self.quads + 1) / self.quads * whole + 0.5 / self.texels
        return np.stack(np.meshgrid(along, along), axis=-1).astype(np.float32).reshape(-1, 2)


def proxy_step(samples: int, most: int) -> int:
    """The smallest step that divides the samples and gives at most this many quads along a side; 0 for
    none."""
    if most < 1 or samples <= most:
        return 0
    return next(step for step in range(2, samples + 1) if samples % step == 0 and samples // step <= most)
