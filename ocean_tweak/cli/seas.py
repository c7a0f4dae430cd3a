# SPDX-License-Identifier: GPL-3.0-or-later
"""The seas for a command: from a parameter file or the open .blend file, with changes from the command
line."""

from __future__ import annotations

import argparse
import dataclasses
import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..core import OceanParameters, ParameterError, Spray
from ..core.data.frames import Frame
from ..core.data.plain_data import class_of, to_plain
from ..core.data.printable import printable
from ..core.data.raster import Raster
from ..core.parameters.ocean_parameters import parse_json
from ..core.parameters.presets import built_in
from ..core.parameters.shot import Shot
from ..core.sea.patch_plan import planned
from ..export.files import LARGEST_JSON
from ..export.hulls import with_hulls
from ..export.images import with_rasters
from ..export.sea_files import read_sea, sea_of_text
from .outcome import UsageError


class FileSea(NamedTuple):
    """A sea from a file, with further data from a .blend file.

    uid : distinguishes it from other seas of the same name; None if it has none
    frames : of the scene
    cache : the file's folder for baked frames
    maps : maps that the file always needs in a bake
    needs : what will not move in a Blender without the extension, one line each
    place : position (x, y) in m of the camera around which spray is created; None for spray on the sea's tile
    """

    shot: Shot
    uid: str | None = None
    frames: tuple[Frame, ...] = ()
    cache: Path | None = None
    maps: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    place: tuple[float, float] | None = None

    def first_parameters(self) -> OceanParameters:
        """Parameters at the first animated frame, or of all frames."""
        animation = self.shot.animation
        return self.shot.parameters if animation is None else self.shot.at(animation.first_frame).parameters


#: `--params -`: read from standard input
_STDIN = Path("-")

SceneOceans = Callable[[], Mapping[str, FileSea]]


def chosen_seas(arguments: argparse.Namespace, scene_oceans: SceneOceans | None) -> dict[str, FileSea]:
    """The seas for the command, by name. Raises ParameterError or UsageError."""
    if arguments.preset is not None:
        seas = {arguments.preset: FileSea(Shot(built_in()[arguments.preset].parameters))}
    elif arguments.params is not None or scene_oceans is None:
        seas = {_file_sea_name(arguments.params): FileSea(_file_shot(arguments.params))}
    else:
        seas = _chosen(scene_oceans(), arguments.object)
    return {name: sea._replace(shot=changed(sea.shot, arguments)) for name, sea in seas.items()}


def _file_sea_name(path: Path | None) -> str:
    return "ocean" if path is None or path == _STDIN else path.stem


def _file_shot(path: Path | None) -> Shot:
    if path is None:
        return Shot(OceanParameters())
    try:
        return sea_of_text(_piped_text(), Path()) if path == _STDIN else read_sea(path)
    except UnicodeDecodeError as error:
        raise ParameterError("params", str(path), f"is not UTF-8 text ({error.reason})") from None
    except OSError as error:
        raise UsageError(f"--params {path}: {error.strerror}") from None


def _piped_text() -> str:
    content = sys.stdin.buffer.read(LARGEST_JSON + 1)
    if len(content) > LARGEST_JSON:
        raise OSError(None, f"is larger than {LARGEST_JSON / 1e6:g} MB")
    return content.decode("utf-8")


def _chosen(oceans: Mapping[str, FileSea], name: str | None) -> dict[str, FileSea]:
    if not oceans:
        raise UsageError("the file holds no ocean: add one, or give --params FILE.json")
    if name is None:
        return dict(oceans)
    if name not in oceans:
        raise UsageError(f"--object {name!r}: no such ocean; the file has {', '.join(sorted(oceans))}")
    return {name: oceans[name]}


def changed(shot: Shot, arguments: argparse.Namespace) -> Shot:
    """The shot with the command line's changes, and with spray if requested.

    Raises ParameterError or UsageError.
    """
    data = shot.to_dict()
    if getattr(arguments, "spray", False):
        data.setdefault("spray", to_plain(Spray()))
    for assignment in arguments.assignments:
        path, equals, value = assignment.partition("=")
        if not equals:
            raise UsageError(f"--set {assignment}: must look like layers.0.wind_speed=25")
        if shot.animation is not None and path.strip() in dict(shot.animation.samples):
            raise UsageError(f"--set {assignment}: the shot animates this; change its samples instead")
        if data.get("patches") and path.strip() in ("resolution", "domain_size"):
            raise UsageError(f"--set {assignment}: this sea has patches; set patches.0.{path.strip()}")
        _assign(data, path.strip(), _value(value))
    for key in ("fps", "start_frame"):
        value = getattr(arguments, key)
        if value is not None:
            data["timing"][key] = _value(value)
    made = Shot.from_dict(with_rasters(OceanParameters, with_hulls(data, Path()), Path()))
    if arguments.plan is None:
        return made
    return dataclasses.replace(made, parameters=planned(made.parameters, arguments.plan))


def _value(text: str) -> Any:
    """Parse as JSON, or keep the text itself, so that enumeration names need no quotes."""
    try:
        return parse_json(text)
    except ParameterError:
        return text.strip()


def _assign(data: Any, path: str, value: Any) -> None:
    """Set data[a][0][b] for the path a.0.b; the result is validated with the parameters.

    What a sea may lack, such as its coast, is begun by what is set in it, and a file takes a raster's place.
    """
    *parents, last = path.split(".")
    metadata: Mapping[str, Any] = {"nested": OceanParameters}
    is_begun = False  # keys are checked by validation
    for key in parents:
        if isinstance(data, dict):
            metadata = _metadata(metadata, data, key)
            if is_begun or _begins(metadata, data.get(key)):
                data[key], is_begun = {}, True
        data = _entry(data, key, path)
    if isinstance(data, list):
        _entry(data, last, path)
        data[int(last)] = value
    elif isinstance(data, dict):
        data[last] = value
    else:
        raise UsageError(f"--set {path}: there is nothing inside {parents[-1]}")


def _begins(metadata: Mapping[str, Any], value: Any) -> bool:
    """Whether there is nothing yet in which something can be set: nothing at all, or an image's numbers."""
    is_image = metadata.get("kind") is Raster and isinstance(value, dict) and "file" not in value
    return bool(metadata.get("optional")) and (value is None or is_image)


def _metadata(metadata: Mapping[str, Any], data: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    """Of a field of a dataclass, an entry of a list or the only one, of which there is plain data."""
    if "nested" not in metadata:
        return {}
    kind = class_of(metadata, data) if metadata.get("kinds") else metadata["nested"]
    return next((field.metadata for field in dataclasses.fields(kind) if field.name == key), {})


def _entry(data: Any, key: str, path: str) -> Any:
    if isinstance(data, list):
        if not re.fullmatch("[0-9]{1,6}", key) or int(key) >= len(data):
            raise UsageError(
                f"--set {printable(path)}: {printable(key)} must be a number from 0 to {len(data) - 1}"
            )
        return data[int(key)]
    if not isinstance(data, dict) or key not in data:
        known = f"; known keys: {', '.join(data)}" if isinstance(data, dict) else ""
        raise UsageError(f"--set {printable(path)}: there is no {printable(key)}{known}")
    return data[key]
