# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of baked files: sea_disp.0001.exr, of a patch sea_p2_disp.0001.exr and sea_p2_points.0001.ply, of a
coast sea_coast.0001.ply, and of wakes sea_wakes.0001.ply."""

from __future__ import annotations

import re
from typing import NamedTuple

from ..core.data.frames import Frame, frame_label
from ..core.synthesis.channels import MAPS

#: in place of a map's name in point files: all samples, and averages for the viewport
POINTS, SMALL_POINTS = "points", "small_points"
#: the same for what is over the bed of a coast
COAST = "coast"
#: the same for waves that do not repeat, around the camera
WAKES = "wakes"
#: the same for spray, whose files are in a folder of this name
SPRAY = "spray"
#: everything that can be baked, as listed in jobs: images, and points
BAKED = (*MAPS, POINTS, COAST, WAKES)

_IMAGE = re.compile(rf"(?P<name>.+)_(?P<map>{'|'.join(MAPS)})\.(?P<frame>-\d{{3,}}|\d{{4,}})\.exr")


class ImageFile(NamedTuple):
    """The parts of an image's file name.

    name : of the sea, and of the patch if it has several: storm, storm_p2
    """

    name: str
    map: str
    frame: int


def frame_file(name: str, map_name: str, frame: Frame, patch: int | None = None) -> str:
    """The name of a frame's file.

    map_name : one of MAPS, POINTS, SMALL_POINTS, COAST, WAKES or SPRAY
    patch : its number, from 1, in a sea of several patches
    """
    ending = "ply" if map_name in (POINTS, SMALL_POINTS, COAST, WAKES, SPRAY) else "exr"
    return f"{files_start(name, map_name, patch)}{frame_label(frame)}.{ending}"


def files_start(name: str, map_name: str, patch: int | None = None) -> str:
    """The common start of the names of all frames."""
    of_patch = "" if patch is None else f"_p{patch}"
    return f"{name}{of_patch}_{map_name}."


def image_file_of(file_name: str) -> ImageFile | None:
    """The parts of a file name; None if it is not an image of a whole frame."""
    match = _IMAGE.fullmatch(file_name)
    return None if match is None else ImageFile(match["name"], match["map"], int(match["frame"]))
