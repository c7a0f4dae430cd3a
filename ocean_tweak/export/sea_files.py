# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that hold a sea: JSON with images and winds beside it, and layers of USD that were exported."""

from __future__ import annotations

import os
from pathlib import Path

from ..core.data.errors import ParameterError
from ..core.data.plain_data import parse_json
from ..core.parameters.former_json import modern
from ..core.parameters.ocean_parameters import OceanParameters
from ..core.parameters.shot import Shot
from .files import LARGEST_JSON, read_bytes, write_text
from .images import read_raster, with_rasters
from .images.references import Reader
from .usd import isolated
from .usd.reading import SUFFIXES


def read_sea(path: str | os.PathLike[str]) -> Shot:
    """The sea of a file, and what of it changes from frame to frame.

    path : of JSON, in which {"file": "lee.png"} may stand for an image or a wind, or of a layer of USD

    Raises ParameterError, which names the field, its value and what is allowed, for what is no sea, OSError
    or UnicodeDecodeError for a file that cannot be read, and UsdError, a RuntimeError, for a layer.

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
    """The sea of a file's JSON.

    folder : what the paths in it are relative to
    read : what reads the images

    Raises ParameterError.
    """
    return Shot.from_dict(with_rasters(OceanParameters, modern(parse_json(text)), folder, read))


def write_sea(path: str | os.PathLike[str], sea: Shot | OceanParameters) -> None:
    """Write a sea as JSON that `read_sea` reads back to an equal one; images and winds stand in it.

    The file appears whole: on any error an old one stays as it was. Raises ParameterError for the name of
    a layer of USD, which the command `usd` writes, and OSError for what the disk refuses.

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
