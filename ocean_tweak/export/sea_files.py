# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and writes files of a sea: JSON, with images and winds in files beside it, and exported USD
layers."""

from __future__ import annotations

import os
from pathlib import Path

from ..core.data.errors import ParameterError
from ..core.data.plain_data import parse_json
from ..core.parameters.former_json import modern
from ..core.parameters.ocean_parameters import OceanParameters
from ..core.parameters.shot import Shot
from .files import LARGEST_JSON, read_bytes, write_text
from .hulls import with_hulls
from .images import read_raster, with_rasters
from .images.references import Reader
from .usd import isolated
from .usd.reading import SUFFIXES


def read_sea(path: str | os.PathLike[str]) -> Shot:
    """Read a sea and its animation from a file.

    path : a JSON file, in which {"file": "lee.png"} may stand for an image or a wind and
        {"file": "hull.obj"} for a footprint, or a USD layer

    Raises ParameterError, which names the field, its value and what is allowed, for an invalid sea, OSError
    or UnicodeDecodeError for a file that cannot be read, and UsdError, a RuntimeError, for an invalid layer.

    Examples
    --------
    >>> from ocean_tweak.core import OceanParameters
    >>> write_sea("breeze.json", OceanParameters(seed=5))
    >>> read_sea("breeze.json").parameters.seed
    5
    """
    path = Path(path)
    if path.suffix in SUFFIXES:
        return isolated.read_package(path)[1].shot
    return sea_of_text(read_bytes(path, LARGEST_JSON).decode("utf-8"), path.parent)


def sea_of_text(text: str, folder: Path, read: Reader = read_raster) -> Shot:
    """Parse a sea from JSON text.

    folder : to which paths in the text are relative
    read : function that reads images

    Raises ParameterError.
    """
    data = with_hulls(modern(parse_json(text)), folder)
    return Shot.from_dict(with_rasters(OceanParameters, data, folder, read))


def write_sea(path: str | os.PathLike[str], sea: Shot | OceanParameters) -> None:
    """Write a sea as JSON from which `read_sea` restores an equal one; images and winds are embedded.

    The file is written atomically: on any error an old one is kept. Raises ParameterError for the suffix of a
    USD layer, which the command `usd` writes, and OSError if the file cannot be written.

    Examples
    --------
    >>> from ocean_tweak.core import OceanParameters, WaveLayer
    >>> write_sea("gale.json", OceanParameters(layers=(WaveLayer(wind_speed=18.0),)))
    >>> read_sea("gale.json").at(frame=12).parameters.layers[0].wind_speed
    18.0
    """
    path = Path(path)
    if path.suffix in SUFFIXES:
        raise ParameterError("path", str(path), "must be that of a JSON file; layers of USD are exported")
    write_text(path, sea.to_json() + "\n")
