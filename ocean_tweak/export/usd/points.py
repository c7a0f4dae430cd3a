# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea whose every frame lies in one layer: for short shots."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ...core.data.frames import Frame
from ...core.synthesis.channels import SurfaceFields
from .attributes import outputs_of
from .layers import save, whole_layer, write_header
from .library import UsdError
from .mesh import ROOT, Edition, write_frame, write_topology

#: bytes of frames that are held before they go into the file. More would only take memory: what a layer has
#: saved it reads from the file again
HELD_BYTES = 64 * 2**20


class PointsSink:
    """A sink for frames: samples of one layer, which several threads may bring."""

    def __init__(self, edition: Edition, layer: Any, path: Path) -> None:
        self._edition = edition
        self._layer = layer
        self._path = path
        self._held = 0
        self._busy = threading.Lock()

    @property
    def outputs(self) -> frozenset[str]:
        """The fields that a frame must have."""
        return outputs_of(self._edition.package.attributes)

    def write(self, frame: Frame, fields: SurfaceFields, *_others: SurfaceFields) -> tuple[Path, ...]:
        """Add a frame. Returns the layer's path. Raises UsdError."""
        with self._busy:
            try:
                self._held += write_frame(self._layer, self._edition, frame, fields)
            except ValueError as error:
                raise UsdError(f"{self._path}: frame {frame}: {error}") from error
            if self._held >= HELD_BYTES:
                save(self._layer, self._path)
                self._held = 0
        return (self._path,)


@contextlib.contextmanager
def points_sink(path: Path, edition: Edition) -> Iterator[PointsSink]:
    """A sink whose layer takes the place of `path` at the end, unless something goes wrong."""
    package = edition.package
    with whole_layer(path) as layer:
        mark = {"fingerprint": package.edition_fingerprint(edition.resolution)}
        write_header(layer, package, package.frames, ROOT, mark)
        write_topology(layer, edition)
        save(layer, path)
        yield PointsSink(edition, layer, path)
