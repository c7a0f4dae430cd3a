# SPDX-License-Identifier: GPL-3.0-or-later
"""Points with named attributes as PLY files for Blender's nodes: binary, little-endian, float."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .exr import ExrError
from .files import open_file, whole_file

_FORMAT = "binary_little_endian 1.0"
_ABOUT = "comment Ocean Tweak "
#: largest size of a header in bytes
LONGEST_HEADER = 4096


class PlyError(ExrError):
    """Points that cannot be written or read, with their path and the reason."""


def write_ply(
    path: Path, names: Sequence[str], values: NDArray[np.floating], about: Mapping[str, object]
) -> None:
    """Write (points, columns) atomically.

    names : of the columns
    about : plain data for the header

    Raises PlyError for a value that is not finite, and OSError if it cannot be written.
    """
    if not np.all(np.isfinite(values)):
        raise PlyError(f"{path}: the points hold values that are not finite")
    head = [
        "ply", f"format {_FORMAT}", _ABOUT + json.dumps(about), f"element vertex {len(values)}",
        *(f"property float {name}" for name in names), "end_header",
    ]  # fmt: skip
    with whole_file(path) as beside, beside.open("wb") as file:
        file.write(("\n".join(head) + "\n").encode("ascii"))
        file.write(np.ascontiguousarray(values, "<f4").data)


def read_ply(path: Path, known: Collection[Sequence[str]]) -> dict[str, NDArray[np.float32]]:
    """The columns of a file written here, by name, each (points,).

    known : the columns that it may have, in their order

    Raises PlyError for a file that is damaged or was not written here.
    """
    try:
        with open_file(path) as file:
            names, count, _ = _header(file.read(LONGEST_HEADER), known)
            file.seek(0)
            content = file.read()
    except (OSError, ValueError) as error:
        raise PlyError(f"{path}: not readable points of Ocean Tweak ({error})") from None
    start = content.index(b"end_header\n") + len(b"end_header\n")
    if len(content) - start != 4 * count * len(names):
        raise PlyError(f"{path}: its length does not match its header")
    values = np.frombuffer(content, "<f4", offset=start).reshape(count, len(names))
    return {name: values[:, column] for column, name in enumerate(names)}


def told_by_ply(path: Path, known: Collection[Sequence[str]]) -> dict[str, Any] | None:
    """The data in the header of a complete file; None if it is missing, truncated or was not written here."""
    try:
        with open_file(path) as file:
            text = file.read(LONGEST_HEADER)
        names, count, about = _header(text, known)
        start = text.index(b"end_header\n") + len(b"end_header\n")
        return about if path.stat().st_size == start + 4 * count * len(names) else None
    except (OSError, ValueError):
        return None


def _header(text: bytes, known: Collection[Sequence[str]]) -> tuple[list[str], int, dict[str, Any]]:
    """Names of the columns, number of points and the header's data. Raises ValueError."""
    head, end, _ = text.partition(b"end_header\n")
    lines = head.decode("ascii").splitlines()
    is_ours = lines[:2] == ["ply", f"format {_FORMAT}"] and "".join(lines[2:3]).startswith(_ABOUT)
    if not end or not is_ours:
        raise ValueError("its header is another one")
    (count,) = [line.rpartition(" ")[2] for line in lines if line.startswith("element vertex ")]
    names = [line.rpartition(" ")[2] for line in lines if line.startswith("property float ")]
    if names not in [list(each) for each in known]:
        raise ValueError("its columns are others")
    try:
        about = json.loads(lines[2].removeprefix(_ABOUT))
    except RecursionError:
        about = None
    if not isinstance(about, dict):
        raise ValueError("its header is another one")
    return names, int(count), about
