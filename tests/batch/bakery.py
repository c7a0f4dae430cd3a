# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes of small seas for the tests of this folder: run, watched, disturbed and compared."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from ocean_tweak.export.exr import read_image

ROOT = Path(__file__).parents[2]
SEA = {"resolution": 64, "domain_size": 300.0, "seed": 11, "layers": [{"wind_speed": 14.0}]}
LONG = os.environ.get("OCEAN_TWEAK_LONG_TESTS") == "1"
SOON = 60.0  # s; more than anything here takes on a busy machine


def times(count: int, more: int = 10) -> int:
    """How often a test repeats itself: ten times as often, or `more`, in the long run."""
    return more * count if LONG else count


def command(*arguments: object) -> list[str]:
    return [sys.executable, "-m", "ocean_tweak", *map(str, arguments)]


def run(*arguments: object, **options: object) -> subprocess.CompletedProcess[str]:
    """A command in a process of its own, to its end."""
    defaults = {"cwd": ROOT, "capture_output": True, "text": True, "check": False, "timeout": 4 * SOON}
    return subprocess.run(command(*arguments), **{**defaults, **options})


def start(*arguments: object) -> subprocess.Popen[str]:
    """A command in a process and a process group of its own, as a shell starts it."""
    return subprocess.Popen(
        command(*arguments), cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True, start_new_session=True,
    )  # fmt: skip


def end(process: subprocess.Popen[str]) -> tuple[int, str, str]:
    """Its code and what it said; it must end soon."""
    out, err = process.communicate(timeout=SOON)
    return process.returncode, out, err


def children(process: subprocess.Popen[str]) -> list[int]:
    """Numbers of the processes that a process has started."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = path.read_text().rpartition(")")[2].split()[1]
        except OSError:
            continue
        if int(parent) == process.pid:
            found.append(int(path.parent.name))
    return found


def wait_for(condition: Callable[[], object], what: str) -> None:
    until = time.monotonic() + SOON
    while not condition():
        assert time.monotonic() < until, f"waited in vain for {what}"
        time.sleep(0.01)


def write_sea(path: Path, **changes: object) -> Path:
    path.write_text(json.dumps({**SEA, **changes}))
    return path


def only_folder(cache: Path) -> Path:
    (folder,) = cache.glob("*/v*-*")
    return folder


def images(folder: Path) -> list[Path]:
    return sorted(path for path in folder.glob("*.exr") if not path.name.startswith("."))


def records(folder: Path) -> list[Path]:
    return sorted(path for path in (folder / "records").glob("*.json") if not path.name.startswith("."))


def contents(folder: Path) -> dict[str, str]:
    """SHA-256 of every image and record, by name."""
    files = [*images(folder), *records(folder)]
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def image_contents(folder: Path) -> dict[str, str]:
    return {name: digest for name, digest in contents(folder).items() if name.endswith(".exr")}


def times_of_change(folder: Path) -> dict[str, int]:
    files = (path for path in folder.rglob("*") if path.is_file() and path.parent.name != "locks")
    return {str(path.relative_to(folder)): path.stat().st_mtime_ns for path in files}


def leftovers(folder: Path) -> list[str]:
    """Whatever lies about besides images, records and the job."""
    known = {*images(folder), *records(folder), folder / "bake.json", folder / "locks" / "entry"}
    return sorted(
        str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file() and path not in known
    )


class Watch:
    """Looks at a cache while it is baked into, and keeps what was seen half written.

    An image that is visible must be readable to its last pixel; a record that is visible must be readable,
    and the files that it lists must be there with the bytes that it tells.
    """

    def __init__(self, cache: Path) -> None:
        self.cache = cache
        self.problems: list[str] = []
        self.looks = 0
        self._seen: set[tuple[str, int, int]] = set()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._look, daemon=True)

    def __enter__(self) -> Watch:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()
        assert self.problems == []
        assert self.looks > 0, "nothing was seen at all"

    def _look(self) -> None:
        while not self._ended.wait(0.025):
            for path in self._visible():
                if self._is_new(path):
                    self.looks += 1
                    try:
                        (_read_image if path.suffix == ".exr" else _read_record)(path)
                    except FileNotFoundError:
                        pass  # removed since
                    except Exception as error:  # noqa: BLE001 - whatever it is, the file was not whole
                        if path.exists():
                            self.problems.append(f"{path.name}: {error!r}")

    def _visible(self) -> Iterator[Path]:
        for folder in (*self.cache.glob("*/v*"), *self.cache.glob("*/v*/records")):
            for path in folder.iterdir():
                if path.suffix in (".exr", ".json") and not path.name.startswith((".", "bake")):
                    yield path

    def _is_new(self, path: Path) -> bool:
        try:
            status = path.stat()
        except FileNotFoundError:
            return False
        key = (str(path), status.st_ino, status.st_mtime_ns)
        if key in self._seen:
            return False
        self._seen.add(key)
        return True


def _read_image(path: Path) -> None:
    pixels, _ = read_image(path)
    assert pixels.any()


def _read_record(path: Path) -> None:
    record = json.loads(path.read_bytes())
    for entry in record["files"]:
        content = (path.parent.parent / entry["name"]).read_bytes()
        assert hashlib.sha256(content).hexdigest() == entry["sha256"]


def baking(process: subprocess.Popen[str], cache: Path, count: int) -> None:
    """Wait until a process that is baking has made so many frames."""

    def made() -> bool:
        assert process.poll() is None, process.communicate()
        return len(list(cache.glob("*/v*/records/[0-9]*.json"))) >= count

    wait_for(made, f"{count} frames")


def each_json_line(text: str) -> Iterator[dict[str, object]]:
    for line in text.splitlines():
        yield json.loads(line)
