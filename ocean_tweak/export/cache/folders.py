# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a bake lies: its folder `CACHE/NAME-UID/vNNN-hash8/`, and the job in it.

The folder's name holds the job's fingerprint, so frames of another sea are never overwritten, and whoever
bakes the same job, on whatever machine, finds the same folder. `bake.json` in it is the job, written once;
only one that was damaged is ever replaced.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import chain, combinations, product
from pathlib import Path

from ...core.data import formats
from ...core.data.frames import Frame, frame_label
from ...core.parameters.shot import Shot
from ...core.sea.regions import told_area
from ..exr import ExrError, read_header
from ..files import LARGEST_JSON, alone, is_link, new_file, read_bytes, sync_folder, write_text
from ..frame_files import SPRAY
from .job import UID, CacheError, Job, NewerBakeError, maps_for, safe_name

JOB_FILE = "bake.json"
RECORDS, LOCKS = "records", "locks"
#: locked while versions are told apart, or claims are looked at
ENTRY = "entry"

_VERSION = re.compile(r"v(\d{3,})-([0-9a-f]{8})")
#: images that are asked for a lost job
_TELLING_IMAGES = 8


def find_folder(cache: Path, job: Job) -> Path | None:
    """The job's folder in a cache; None where nobody has begun to bake it."""
    versions = _versions(cache / job.home)
    return next((path for path, (_, hash8) in versions if hash8 == job.hash8), None)


def open_folder(cache: Path, job: Job) -> Path:
    """The job's folder in a cache, made where it is missing.

    Raises CacheError where another job has its name, OSError for what the disk refuses.
    """
    home = cache / job.home
    home.mkdir(parents=True, exist_ok=True)
    with alone(home / ENTRY):  # else two machines might number the same job differently
        folder = find_folder(cache, job)
        if folder is None:
            number = max((number for _, (number, _) in _versions(home)), default=0) + 1
            folder = home / f"v{number:03d}-{job.hash8}"
        for part in (RECORDS, LOCKS):
            (folder / part).mkdir(parents=True, exist_ok=True)
        write_job(folder, job)
        sync_folder(home)
    return folder


def write_job(folder: Path, job: Job) -> None:
    """Write `bake.json`, or see that it is this job; one that cannot be read is replaced."""
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
    """Whether a folder is one of baked frames: by its name, or by the job in it."""
    if _VERSION.fullmatch(folder.name) and (folder / RECORDS).is_dir():
        return True
    try:
        read_job(folder)
    except CacheError:
        return False
    return True


def bakes_in(place: Path) -> list[Path]:
    """The folders of bakes in a cache, or in the folder that a sea has there; of a bake's folder, itself."""
    if is_bake(place):
        return [place]
    homes = [place, *sorted(path for path in place.iterdir() if path.is_dir())] if place.is_dir() else []
    return [folder for home in homes for folder, _ in _versions(home) if is_bake(folder)]


def read_job(folder: Path, asked: tuple[Frame, ...] = ()) -> Job:
    """The job of a folder, for these frames or else those asked for first.

    Raises CacheError when it is missing, damaged or of another version.
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
    """The job of a folder whose `bake.json` is missing or damaged, from what its images tell.

    Raises CacheError where they do not tell, or not the job that the folder's name holds.
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
            for foam, encoding in product(range(formats.FOAM, 0, -1), range(formats.ENCODING, 0, -1)):
                job = Job(name, uid, shot, maps, compression, area=area, foam=foam, encoding=encoding)
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
    """Where what happens to a bake is written, when that is asked for: beside its folder."""
    home = folder.resolve()
    return home.with_name(f"{home.name}.log")


def refuse_links(folder: Path) -> None:
    """Raise CacheError where what is written and removed in a bake's folder would be elsewhere."""
    for part in (folder / RECORDS, folder / LOCKS, folder / SPRAY):
        if is_link(part):
            raise CacheError(f"{part} is a link to something that may not belong to this bake: remove it")


def record_path(folder: Path, frame: Frame) -> Path:
    """Where a frame's record lies."""
    return folder / RECORDS / f"{frame_label(frame)}.json"
