# SPDX-License-Identifier: GPL-3.0-or-later
"""Damages a bake in many ways and lets every command read it, in a process that may use little memory.

`python -m tests.batch.fuzz FOLDER SCRATCH FIRST LAST`: prints the number of each damage before it is tried,
so that whoever started this knows which one ended it.
"""

from __future__ import annotations

import contextlib
import io
import json
import random
import resource
import shutil
import signal
import sys
from pathlib import Path

from ocean_tweak.cli import main
from ocean_tweak.export.cache.job import sealed
from ocean_tweak.export.cache.records import file_hash

MEMORY = 1_500 * 2**20
#: of the processor; whoever started this limits the time that passes
SECONDS = 20
WORDS = (
    b"nan", b"1e999", b"-1", b"null", b"[]", b"{}", b'"', b"1e999999999", b"9" * 400, b"9" * 5000, b"true",
    b"[" * 100_000, b'{"a":' * 5000, b"\xff\xfe", b"\x00" * 40, b"../../x", b"\\ud800", b"0.1e-400",
    b"1-20000", b"4294967295", b"\xff\xff\xff\x7f",
)  # fmt: skip

VALUES = (
    None, -1, 0, 10**400, 1e300, 5e-324, True, "", "x" * 1000, [], {}, "\ud800", "1e99999999", float("nan"),
    "1-20000", ["disp"] * 3, {"a": 1},
)  # fmt: skip


def mutated(content: bytes, chance: random.Random) -> bytes:
    """The bytes with one to four changes; of JSON mostly other values, which its syntax does not tell."""
    data = bytearray(content)
    if chance.random() < 0.7:
        data = _other_value(data, chance)
        if data != content:
            return bytes(data)
    for _ in range(chance.randint(1, 4)):
        # half of them in front, where what an image is stands
        place = chance.randrange(chance.choice((200, 1000, *2 * [len(data) + 1]))) % (len(data) + 1)
        kind = chance.randrange(6)
        if kind == 0:
            del data[place:]
        elif kind == 1 and data:
            data[place % len(data)] ^= 1 << chance.randrange(8)
        elif kind == 2:
            del data[place : place + chance.choice((1, 4, 100, 4000))]
        elif kind == 3:
            data[place : place + 4] = chance.choice(WORDS)
        elif kind == 4:
            data[place : place + 4] = chance.randrange(2**32).to_bytes(4, "little")
        else:
            data[place:place] = data[: chance.choice((1, 8, 1000))]
    return bytes(data)


def _other_value(data: bytearray, chance: random.Random) -> bytearray:
    """Another value for a key, where the bytes are JSON."""
    try:
        plain = json.loads(data)
    except (ValueError, RecursionError):
        return data
    place = plain
    while isinstance(place, (dict, list)) and place:
        key = chance.choice(list(place) if isinstance(place, dict) else range(len(place)))
        inner = place[key]
        if not isinstance(inner, (dict, list)) or not inner or chance.random() < 0.3:
            place[key] = chance.choice(VALUES)
            break
        place = inner
    return bytearray(json.dumps(plain).encode())


def damage(folder: Path, chance: random.Random) -> str:
    """Change one file; often its record vouches for it, so that its contents are looked at."""
    files = sorted(path for path in folder.rglob("*") if path.suffix in (".exr", ".json"))
    images = [path for path in files if path.suffix == ".exr"]
    path = chance.choice(images if chance.random() < 0.5 else files)
    path.write_bytes(mutated(path.read_bytes(), chance))
    if chance.random() < 0.8:
        _vouch(folder, path)
    if chance.random() < 0.1:
        (folder / "bake.json").unlink(missing_ok=True)
    return path.name


def _vouch(folder: Path, changed: Path) -> None:
    records = [changed] if changed.parent.name == "records" else (folder / "records").iterdir()
    for record in records if changed.name != "bake.json" else [changed]:
        try:
            data = json.loads(record.read_bytes())
            data.pop("sha256", None)
            for entry in data.get("files", ()):
                path = folder / entry["name"]
                entry |= {"bytes": path.stat().st_size, "sha256": file_hash(path)}
            record.write_text(json.dumps(sealed(data)))
        except (ValueError, TypeError, KeyError, AttributeError, OSError, RecursionError):
            continue  # no longer a record


def attempt(pristine: Path, scratch: Path, seed: int) -> None:
    """One damage, and every command on it. Raises where one does anything but end with a code."""
    chance = random.Random(seed)
    shutil.rmtree(scratch, ignore_errors=True)
    home = scratch / pristine.parent.name
    shutil.copytree(pristine.parent, home)
    folder = home / pristine.name
    name = damage(folder, chance)
    sea = scratch / "sea.json"
    text = json.dumps(json.loads((pristine / "bake.json").read_text())["shot"]).encode()
    sea.write_bytes(mutated(text, chance))
    said = io.StringIO()
    commands = (
        ["verify", str(folder)],
        ["resume", str(folder), "--frames", "1-2", "--workers", "1", "--take-over"],
        ["info", "--params", str(sea)],
        ["clean", str(folder)],
    )
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        codes = [main(arguments) for arguments in commands]
    assert set(codes) <= {0, 1, 2}, (name, codes)
    assert "Traceback" not in said.getvalue(), name


def run(pristine: Path, scratch: Path, seeds: range) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    for seed in seeds:
        print(seed, flush=True)
        signal.setitimer(signal.ITIMER_PROF, SECONDS)  # ends the process where a command goes on and on
        attempt(pristine, scratch, seed)
    signal.setitimer(signal.ITIMER_PROF, 0)
    print("done", flush=True)


if __name__ == "__main__":
    run(Path(sys.argv[1]), Path(sys.argv[2]), range(int(sys.argv[3]), int(sys.argv[4])))
