# SPDX-License-Identifier: GPL-3.0-or-later
"""The user's own presets: one JSON file each in the user's folder."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path

from ..core.parameters.ocean_parameters import ParameterError
from ..core.parameters.presets import LARGEST, Preset, built_in
from ..export.files import read_bytes, write_text
from .preferences import user_folder
from .sea_picture import SeaView, write_png

#: prefix that distinguishes the keys of a user's presets from built-in ones
_OWN = "user:"


def all_presets() -> dict[str, Preset]:
    """Built-in presets, then the user's by title; invalid files are skipped."""
    return {**built_in(), **own_presets()}


def own_presets() -> dict[str, Preset]:
    """The user's presets by key, in the order of their titles; cached, as menus need them often."""
    folder = user_folder("presets")
    # writing atomically, renaming or deleting a file changes its folder
    return dict(_presets_of(folder, folder.stat().st_mtime_ns))


@lru_cache(maxsize=1)
def _presets_of(folder: Path, _changed: int) -> dict[str, Preset]:
    found = {}
    for path in folder.glob("*.json"):
        try:
            found[f"{_OWN}{path.stem}"] = read_preset(path)
        except (ParameterError, OSError):
            continue
    return dict(sorted(found.items(), key=lambda entry: entry[1].title.lower()))


def is_own(key: str) -> bool:
    """Whether this is the key of a preset that can be renamed and deleted."""
    return key.startswith(_OWN)


def read_preset(path: Path) -> Preset:
    """A preset from a file. Raises ParameterError for an invalid one, OSError if it cannot be read."""
    try:
        return Preset.from_json(read_bytes(path, LARGEST).decode("utf-8"))
    except UnicodeDecodeError as error:
        raise ParameterError("preset", path.name, f"is not UTF-8 text ({error.reason})") from None


def save(preset: Preset, replace: bool = False) -> str:
    """Save a preset and a picture of its sea in the user's folder; returns its key.

    Raises ParameterError if the title is taken and `replace` is off, or if images are too large for a preset,
    and OSError if it cannot be saved.
    """
    key, text = _key(preset.title), preset.to_json()
    if len(text) > LARGEST:
        raise ParameterError(
            "title", preset.title,
            f"its images make it larger than the {LARGEST // 1000} kB of a preset: export the "
            "parameters instead",
        )  # fmt: skip
    path = path_of(key)
    if path.exists() and not replace:
        raise ParameterError("title", preset.title, "is already the name of another preset")
    write_text(path, text)
    _draw(preset, path.with_suffix(".png"))
    _presets_of.cache_clear()  # timestamps are coarse: a second change may not be noticed
    return key


def _draw(preset: Preset, path: Path) -> None:
    """Write the picture of a preset's sea, unless it cannot be shown with few samples."""
    path.unlink(missing_ok=True)  # of another sea
    try:
        picture = SeaView(preset.parameters).picture()
    except (ValueError, MemoryError):
        return
    write_png(picture, path)


def rename(key: str, title: str) -> str:
    """Give a user's preset another title; returns its new key. Raises ParameterError or OSError."""
    old = own_presets()[key]
    renamed = Preset(title, old.description, old.parameters)
    new = save(renamed, replace=_key(title) == key)
    if new != key:
        delete(key)
    return new


def delete(key: str) -> None:
    """Delete a user's preset. Raises OSError."""
    for path in (path_of(key), picture_of(key)):
        path.unlink(missing_ok=True)
    _presets_of.cache_clear()


def path_of(key: str) -> Path:
    """The file of a user's preset."""
    return user_folder("presets") / f"{key.removeprefix(_OWN)}.json"


def picture_of(key: str) -> Path:
    """The path of the picture of a user's preset, which may not exist."""
    return path_of(key).with_suffix(".png")


def _key(title: str) -> str:
    stem = re.sub(r"[^\w\-]+", "_", title.strip()).strip("_").lower()[:60]
    if not stem:
        raise ParameterError("title", title, "must hold a letter or a digit")
    return f"{_OWN}{stem}"
