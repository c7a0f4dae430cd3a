# SPDX-License-Identifier: GPL-3.0-or-later
"""A bake's folder, `CACHE/NAME-UID/vNNN-hash8/`, and the job in it.

The folder's name contains the job's fingerprint, so frames of another sea are never overwritten, and the same
job has the same folder on every machine. `bake.json` in it is the job, written once; it is only replaced if
it is damaged.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import chain, combinations, product
from pathlib import Path

from ...core.data import formats
from ...core.data.errors import ParameterError
from ...core.data.frames import Frame, frame_label
from ...core.parameters.shot import Shot
from ...core.sea.regions import told_area
from ..exr import ExrError, read_header
from ..files import LARGEST_JSON, PART, alone, is_link, new_file, read_bytes, sync_folder, write_text
from ..frame_files import SPRAY
from .job import UID, CacheError, Job, NewerBakeError, maps_for, safe_name

JOB_FILE = "bake.json"
RECORDS, LOCKS = "records", "locks"
#: locked while a version is chosen or claims are examined
ENTRY = "entry"

_VERSION = re.compile(r"v(\d{3,})-([0-9a-f]{8})")
#: number of images from which a lost job is recovered
_TELLING_IMAGES = 8


def find_folder(cache: Path, job: Job) -> Path | None:
    """The job's folder in a cache; None if it has not been started."""
    versions = _versions(cache / job.home)
    return next((path for path, (_, hash8) in versions if hash8 == job.hash8), None)


def open_folder(cache: Path, job: Job) -> Path:
    """The job's folder in a cache, created if missing.

    Raises CacheError if another job has its name, OSError if it cannot be created.
    """
    home = cache / job.home
    home.mkdir(parents=True, exist_ok=True)
    with alone(home / ENTRY):  # otherwise two machines might give the same job different numbers
        folder = find_folder(cache, job)
        if folder is None:
            number = max((number for _, (number, _) in _versions(home)), default=0) + 1
            folder = home / f"v{number:03d}-{job.hash8}"
        for part in (RECORDS, LOCKS):
            (folder / part).mkdir(parents=True, exist_ok=True)
        write_job(folder, job)
        for begun in folder.glob(f".{JOB_FILE}.*{PART}"):  # of killed processes: whoever writes it is alone
            begun.unlink(missing_ok=True)
        sync_folder(home)
    return folder


def write_job(folder: Path, job: Job) -> None:
    """Write `bake.json`, or check that it is this job; an unreadable one is replaced."""
    path = folder / JOB_FILE
    text = json.dumps(job.to_dict(), indent=1) + "\n"
    if new_file(path, text):
        return
    try:
        present = read_job(folder)
    except NewerBakeError:
        raise
    except CacheError:
        write_text(path, text)
        return
    if present.fingerprint != job.fingerprint:
        raise CacheError(
            f"{path} belongs to another job, though its folder has this one's name: move it away"
        )


def is_bake(folder: Path) -> bool:
    """Whether a folder is a bake, by its name or by the job in it."""
    if _VERSION.fullmatch(folder.name) and (folder / RECORDS).is_dir():
        return True
    try:
        read_job(folder)
    except CacheError:
        return False
    return True


def bakes_in(place: Path) -> list[Path]:
    """The bakes in a cache, or in a sea's folder there; for a bake's folder, the folder itself."""
    if is_bake(place):
        return [place]
    homes = [place, *sorted(path for path in place.iterdir() if path.is_dir())] if place.is_dir() else []
    return [folder for home in homes for folder, _ in _versions(home) if is_bake(folder)]


def read_job(folder: Path, asked: tuple[Frame, ...] = ()) -> Job:
    """The job of a folder, with these frames, or with those requested first.

    Raises CacheError if it is missing, damaged or of another version.
    """
    path = folder / JOB_FILE
    try:
        job = Job.from_dict(json.loads(read_bytes(path, LARGEST_JSON)))
    except OSError as error:
        raise CacheError(f"{path}: {error.strerror}; a bake's folder is named vNNN-hash8") from None
    except json.JSONDecodeError as error:
        raise CacheError(f"{path} is not JSON ({error}): run resume to write it again") from None
    except formats.NewerFormatError as error:
        raise NewerBakeError(f"{path}: {error}") from None
    except (ValueError, RecursionError) as error:
        raise CacheError(f"{path} {error}: run resume to write it again") from None
    return replace(job, frames=asked) if asked else job


def recovered_job(folder: Path) -> Job:
    """The job of a folder whose `bake.json` is missing or damaged, from the headers of its images.

    Raises CacheError if they do not contain it, or if it does not match the folder's name.
    """
    match = _VERSION.fullmatch(folder.name)
    name, _, uid = folder.parent.name.rpartition("-")
    problem = (
        f"{folder / JOB_FILE} cannot be read, and the job cannot be restored from the images: "
        "bake with the same arguments as before; complete frames are kept"
    )
    if match is None or name != safe_name(name) or not UID.fullmatch(uid):
        raise CacheError(problem)
    for path in sorted(folder.glob("*.exr"))[:_TELLING_IMAGES]:
        try:
            metadata = read_header(path)
            shot, compression = Shot.from_dict(metadata["parameters"]), str(metadata["compression"])
            area = told_area(metadata)
        except (ExrError, ValueError, KeyError):
            continue
        for maps in _all_choices(maps_for(shot.parameters, area)):
            versions = (range(newest, 0, -1) for newest in (formats.FOAM, formats.WINDROWS, formats.ENCODING))
            for foam, windrows, encoding in product(*versions):
                try:
                    job = Job(
                        name, uid, shot, maps, compression, area=area, foam=foam, windrows=windrows,
                        encoding=encoding,
                    )  # fmt: skip
                except ParameterError:  # waves that do not repeat, of which no image tells the place
                    continue
                if job.fingerprint[:8] == match[2]:
                    return job
    raise CacheError(problem)


def _all_choices(names: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    return chain.from_iterable(combinations(names, count) for count in range(1, len(names) + 1))


def _versions(home: Path) -> Iterator[tuple[Path, tuple[int, str]]]:
    if not home.is_dir():
        return
    for path in sorted(home.iterdir()):
        match = _VERSION.fullmatch(path.name)
        if match is not None and path.is_dir():
            yield path, (int(match[1]), match[2])


def log_file(folder: Path) -> Path:
    """The path of a bake's optional log, beside its folder."""
    home = folder.resolve()
    return home.with_name(f"{home.name}.log")


def refuse_links(folder: Path) -> None:
    """Raise CacheError if parts of a bake's folder are links, so that files elsewhere would be written or
    removed."""
    for part in (folder / RECORDS, folder / LOCKS, folder / SPRAY):
        if is_link(part):
            raise CacheError(f"{part} is a link to something that may not belong to this bake: remove it")


def record_path(folder: Path, frame: Frame) -> Path:
    """The path of a frame's record."""
    return folder / RECORDS / f"{frame_label(frame)}.json"
