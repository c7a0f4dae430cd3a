# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of baked frames, each written once all of its files exist.

A record shows that a frame is complete without opening its images; comparing their hashes shows that it still
is.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any, NamedTuple

from ...core.data import formats
from ...core.data.errors import ParameterError
from ...core.data.frames import MOST_FRAMES, Frame, format_frames, frame_label, parse_frames
from ...core.data.printable import shown
from ...core.synthesis.channels import SurfaceFields
from ..files import PART, begun_file, open_file, read_bytes, remove_begun, sync_folder, write_text
from .folders import LOCKS, RECORDS, record_path
from .job import Job, NewerBakeError, check_seal, made_with, sealed

_LARGEST_RECORD = 2**20
_BLOCK = 2**20
#: largest length in characters, as thousands of separate frames would fill every record
_LONGEST_RANGE = 4000


class FileEntry(NamedTuple):
    """A file of a frame: map, name in the folder, size in bytes and SHA-256."""

    map: str
    name: str
    bytes: int
    sha256: str


@dataclass(frozen=True)
class FrameRecord:
    """A frame's own record.

    fingerprint : of its parameters
    asked : the frames requested together with it, in the form of `format_frames`; "" if that is too long
    """

    frame: Frame
    fingerprint: str
    files: tuple[FileEntry, ...]
    asked: str = ""

    def to_dict(self) -> dict[str, Any]:
        """Plain data, as in the file."""
        data = {
            "format": formats.RECORD,
            "frame": frame_label(self.frame),
            "fingerprint": self.fingerprint,
            "files": [entry._asdict() for entry in self.files],
            "asked": self.asked,
            "made_with": made_with(),
        }
        return sealed(data)

    @classmethod
    def from_dict(cls, data: Any) -> FrameRecord:
        """A record from plain data. Raises ValueError for invalid data."""
        if not isinstance(data, dict):
            raise ValueError("it has another format")
        formats.check_format(data, formats.RECORD)
        if data.get("format") != formats.RECORD:
            raise ValueError("it has another format")
        check_seal(data)
        files = data.get("files")
        if not isinstance(files, list) or not files:
            raise ValueError("it lists no files")
        return cls(
            _frame(data.get("frame")), _text(data.get("fingerprint")), tuple(map(_entry, files)),
            _text(data.get("asked")),
        )  # fmt: skip


class State(Enum):
    """State of a frame."""

    WHOLE = "whole"
    MISSING = "missing"
    STALE = "stale"
    DAMAGED = "damaged"


class Finding(NamedTuple):
    """State of a frame, and why it is not complete."""

    frame: Frame
    state: State
    reason: str = ""


class CacheSink:
    """Writes a frame's maps into a job's folder, and its record last.

    tell : called with the number of files written
    """

    def __init__(
        self, folder: Path, job: Job, tell: Callable[[Frame, str], None] = lambda frame, doing: None
    ) -> None:
        self.folder = folder
        self.job = job
        self.tell = tell
        asked = format_frames(job.frames)
        self._asked = asked if len(asked) <= _LONGEST_RANGE else ""

    @property
    def outputs(self) -> frozenset[str]:
        """The fields that a frame must have."""
        return self.job.outputs

    def write(self, frame: Frame, *fields: SurfaceFields) -> tuple[Path, ...]:
        """Write the frame from the fields of each patch, and of each part if points are baked.

        All files or none. Returns their paths. Raises CacheError for a job of a version that can no longer be
        baked.
        """
        self.job.check_foam()
        record = record_path(self.folder, frame)
        # an old record must not refer to new files
        record.unlink(missing_ok=True)
        paths: list[Path] = []
        count = len(self.job.files(self.folder, frame))
        for path in self.job.write(self.folder, frame, fields):
            paths.append(path)
            self.tell(frame, f"wrote {len(paths)} of {count} files")
        sync_folder(self.folder)
        entries = tuple(
            FileEntry(name, path.name, path.stat().st_size, file_hash(path))
            for (name, _), path in zip(self.job.files(self.folder, frame), paths, strict=True)
        )
        made = FrameRecord(frame, self.job.frame_fingerprint(frame), entries, self._asked)
        write_text(record, json.dumps(made.to_dict(), indent=1) + "\n")
        sync_folder(record.parent)
        return tuple(paths)


def read_record(folder: Path, frame: Frame) -> FrameRecord | None:
    """A frame's record, or None. Raises ValueError if it cannot be read."""
    path = record_path(folder, frame)
    try:
        content = read_bytes(path, _LARGEST_RECORD)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise ValueError(f"it cannot be read: {error.strerror}") from None
    try:
        record = FrameRecord.from_dict(json.loads(content))
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    if record.frame != frame:
        raise ValueError(f"it belongs to frame {frame_label(record.frame)}")
    return record


def recorded_frames(folder: Path) -> tuple[Frame, ...]:
    """The frames that have a record, ascending, without reading it."""
    frames = []
    for path in (folder / RECORDS).glob("*.json"):
        try:
            (frame,) = parse_frames(path.stem)
        except (ParameterError, ValueError):
            continue
        if frame_label(frame) == path.stem:
            frames.append(frame)
    return tuple(sorted(frames))


def asked_frames(folder: Path) -> set[Frame]:
    """The frames that were requested when the recorded ones were baked.

    Raises ParameterError if there are more than a bake can have.
    """
    texts = set()
    for frame in recorded_frames(folder):
        with contextlib.suppress(ValueError):
            record = read_record(folder, frame)
            texts.add(record.asked if record is not None else "")
    frames: set[Frame] = set()
    for text in texts - {""}:
        frames.update(parse_frames(text))
        if len(frames) > MOST_FRAMES:  # for records written by others
            raise ParameterError("frames", f"more than {MOST_FRAMES}", "are asked for by the records")
    return frames


def inspect(folder: Path, job: Job, frame: Frame) -> Finding:
    """Whether a frame is complete: its record, its fingerprint and all bytes of its files.

    Raises NewerBakeError for the record of a newer version of the program.
    """
    try:
        record = read_record(folder, frame)
    except formats.NewerFormatError as error:
        raise NewerBakeError(f"{record_path(folder, frame)}: {error}") from None
    except ValueError as error:
        return Finding(frame, State.DAMAGED, f"its record cannot be used: {error}")
    if record is None:
        return Finding(frame, State.MISSING, "it has no record")
    if record.fingerprint != job.frame_fingerprint(frame):
        return Finding(frame, State.STALE, "it was made from other parameters")
    if sorted((entry.map, entry.name) for entry in record.files) != sorted(job.files(folder, frame)):
        return Finding(frame, State.DAMAGED, "its record lists other files than the job has")
    for entry in record.files:
        try:
            problem = _problem(folder / entry.name, entry)
        except OSError as error:
            problem = f"cannot be read: {error.strerror}"
        if problem:
            return Finding(frame, State.DAMAGED, f"{entry.name} {problem}")
    return Finding(frame, State.WHOLE)


def _problem(path: Path, entry: FileEntry) -> str:
    try:
        size = path.stat().st_size
    except FileNotFoundError:
        return "is gone"
    if not path.is_file():
        return "is no file"
    if size != entry.bytes:
        return f"has {size} bytes, not {entry.bytes}"
    if file_hash(path) != entry.sha256:
        return "has contents other than those written"
    return ""


def inspect_all(
    folder: Path, job: Job, frames: Iterable[Frame], stopped: Callable[[], bool] = lambda: False
) -> Iterator[Finding]:
    """State of each frame; much faster than one by one if most have no record."""
    recorded = set(recorded_frames(folder))
    for frame in frames:
        if frame not in recorded or stopped():
            yield Finding(frame, State.MISSING, "it has no record")
        else:
            yield inspect(folder, job, frame)


def unfinished(
    folder: Path, job: Job, frames: Iterable[Frame], stopped: Callable[[], bool] = lambda: False
) -> Iterator[Finding]:
    """The frames that must be baked, and why.

    stopped : polled before each frame; if True, the rest count as missing
    """
    for finding in inspect_all(folder, job, frames, stopped):
        if finding.state is not State.WHOLE:
            yield finding


def give_up_writing(folder: Path) -> None:
    """Remove unfinished files of this process in a bake, before it ends."""
    for part in (folder, folder / RECORDS, folder / LOCKS):
        remove_begun(part)


def remove_leftovers(folder: Path, job: Job, frames: Iterable[Frame]) -> None:
    """Remove unfinished files of killed processes for these frames."""
    names: set[str] = set()
    for frame in frames:
        names.update(name for _, name in job.files(folder, frame))
        names.add(record_path(folder, frame).name)
    for part in (*folder.glob(f".*{PART}"), *(folder / RECORDS).glob(f".*{PART}")):
        if begun_file(part) in names:
            part.unlink(missing_ok=True)


def file_hash(path: Path) -> str:
    """SHA-256 of a file's bytes, 64 hexadecimal digits."""
    digest = hashlib.sha256()
    with open_file(path) as file:
        while block := file.read(_BLOCK):
            digest.update(block)
    return digest.hexdigest()


def _frame(value: object) -> Frame:
    try:
        (frame,) = parse_frames(_text(value))
    except ParameterError:
        raise ValueError(f"{shown(value)} is not a frame") from None
    return frame


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{shown(value)} is not text")
    return value


def _entry(data: Any) -> FileEntry:
    if not isinstance(data, dict) or set(data) != set(FileEntry._fields):
        raise ValueError("it lists a file in an unknown way")
    size = data["bytes"]
    if isinstance(size, bool) or not isinstance(size, int) or size < 0:
        raise ValueError(f"{shown(size)} is not a number of bytes")
    name = _text(data["name"])
    if name in ("", ".", "..") or Path(name).name != name or "\\" in name or not name.isprintable():
        raise ValueError(f"{shown(name)} is not the name of a file in the folder")
    return FileEntry(_text(data["map"]), name, size, _text(data["sha256"]))
