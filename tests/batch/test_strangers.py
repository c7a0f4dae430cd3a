# SPDX-License-Identifier: GPL-3.0-or-later
"""Folders and files of somebody else: what they hold is not run, and leads nowhere else."""

from __future__ import annotations

import hashlib
import json
import os
import shlex
import subprocess
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest

from ocean_tweak.cli import FileSea, main
from ocean_tweak.cli.outcome import shell_word
from ocean_tweak.core import OceanParameters
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.export.cache.folders import read_job
from ocean_tweak.export.cache.job import CacheError, sealed
from ocean_tweak.export.exr import read_image, write_image
from tests.batch.bakery import ROOT, command, contents

SMALL = OceanParameters(resolution=16)


def test_modules_of_the_current_folder_are_not_run(tmp_path: Path) -> None:
    # what Python itself, NumPy or this package would import first
    for module in ("numpy", "json", "argparse", "__future__", "pathlib", "OpenEXR", "sitecustomize"):
        (tmp_path / f"{module}.py").write_text(f"open({str(tmp_path / 'RUN')!r}, 'w')")
    arguments = ["bake", "--set", "resolution=16", "--frames", "1-2", "--workers", "2", "--out", "cache"]
    answer = subprocess.run(
        command(*arguments), cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True,
        text=True, check=False,
    )  # fmt: skip
    assert answer.returncode == 0, answer.stderr
    assert len(list(tmp_path.glob("cache/*/*/*.exr"))) == 2
    assert not (tmp_path / "RUN").exists()


@pytest.mark.parametrize("uid", ["/../../elsewhere/x", "../x", "a/b", "a\\b", "", "\n", "x" * 33, "é"])
@pytest.mark.parametrize("arguments", [["bake", "--workers", "1", "--out"], ["job", "--cache", "c", "--out"]])
def test_a_uid_of_a_scene_is_no_path(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, uid: str, arguments: list[str]
) -> None:
    seas = {"Sea": FileSea(Shot(SMALL), uid, (1,))}
    code = main([*arguments, str(tmp_path / "chosen" / "out")], lambda: seas)
    assert code == (0 if uid == "" else 2)  # without one, it follows from the name
    if code:
        assert "must be 1 to 32 letters and digits" in caplog.text
    assert {path for path in tmp_path.rglob("*") if path.is_file()} <= set(tmp_path.rglob("chosen/out/**/*"))


@pytest.mark.parametrize(
    ("key", "value"),
    [("name", "../../x"), ("name", "/x"), ("name", "a\\b"), ("name", "C:x"), ("uid", "/../x")],
)
def test_a_job_that_names_files_elsewhere_is_none(copy: Path, key: str, value: str) -> None:
    job = json.loads((copy / "bake.json").read_text())
    del job["sha256"]
    (copy / "bake.json").write_text(json.dumps(sealed({**job, key: value})))
    with pytest.raises(CacheError, match=f"{key} = .*(cannot hold|letters and digits)"):
        read_job(copy)


@pytest.mark.parametrize("part", ["locks", "records"])
@pytest.mark.parametrize(
    "command_line", ["clean {}", "resume {} --take-over", "resume {} --workers 1 --frames 1-8"]
)
def test_no_command_goes_through_links(
    copy: Path, capsys: pytest.CaptureFixture[str], part: str, command_line: str
) -> None:
    """A folder of a bake that somebody sent may lead into one of our own."""
    elsewhere = copy.parent / "elsewhere"
    (copy / part).rename(elsewhere)
    for name in ("entry", "poetry.lock", "0001.json", ".0001.json.0.part"):
        (elsewhere / name).write_text("mine")
    (copy / part).symlink_to(elsewhere)
    before = contents(elsewhere)
    assert main(command_line.format(copy).split()) == 1
    assert f"{copy / part} is a link" in capsys.readouterr().err
    assert contents(elsewhere) == before


def test_the_lock_of_a_folder_is_no_link(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    outside = copy.parent / "made by a link"
    (copy / "locks" / "entry").unlink()
    (copy / "locks" / "entry").symlink_to(outside)
    assert main(["resume", str(copy), "--workers", "1"]) == 1
    assert "entry" in capsys.readouterr().err
    assert not outside.exists()


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("bake.json", "bake.json: is no file"),
        ("records/0002.json", "frame 2 is damaged: its record cannot be used: it cannot be read: is no file"),
        ("sea_disp.0002.exr", "frame 2 is damaged: sea_disp.0002.exr"),
    ],
)
def test_pipes_keep_nobody_waiting(
    copy: Path, capsys: pytest.CaptureFixture[str], name: str, said: str
) -> None:
    (copy / name).unlink()
    os.mkfifo(copy / name)
    assert main(["verify", str(copy), "--frames", "2"]) == 1
    printed = capsys.readouterr()
    assert said in printed.out + printed.err


HOSTILE = "\x1b]0;owned\x07\r\n\u202e" + 100_000 * "x"


def resealed(path: Path, **changes: object) -> None:
    data = json.loads(path.read_text())
    del data["sha256"]
    path.write_text(json.dumps(sealed({**data, **changes})))


def other_header(path: Path) -> None:
    """A whole image that its record vouches for, and that says it is something else."""
    pixels, metadata = read_image(path)
    write_image(path, pixels, {**metadata, "map": HOSTILE}, Fraction(24))
    record = path.parent / "records" / "0002.json"
    files = json.loads(record.read_text())["files"]
    for entry in files:
        if entry["name"] == path.name:
            entry.update(bytes=path.stat().st_size, sha256=hashlib.sha256(path.read_bytes()).hexdigest())
    resealed(record, files=files)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda home: resealed(home / "bake.json", maps=[HOSTILE]),
        lambda home: resealed(home / "bake.json", name=HOSTILE),
        lambda home: resealed(home / "bake.json", shot={HOSTILE: 1}),
        lambda home: resealed(home / "records" / "0002.json", frame=HOSTILE),
        lambda home: resealed(home / "records" / "0002.json", fingerprint=[HOSTILE]),
        lambda home: other_header(home / "sea_disp.0002.exr"),
    ],
)
def test_what_files_say_is_printed_short_and_plain(
    copy: Path, capsys: pytest.CaptureFixture[str], spoil: Callable[[Path], None]
) -> None:
    spoil(copy)
    assert main(["verify", str(copy), "--frames", "2"]) == 1
    printed = capsys.readouterr()
    for line in (printed.out + printed.err).splitlines():
        assert line.isprintable()
        assert len(line) < 2000
    assert "owned" in printed.out + printed.err


def test_a_pipe_is_nobodys_claim_and_no_parameters(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(copy / "locks" / "x.lock")
    assert main(["resume", str(copy), "--workers", "1"]) == 1
    assert "x.lock cannot be read" in capsys.readouterr().err
    assert main(["info", "--params", str(copy / "locks" / "x.lock")]) == 2
    assert "is no file" in capsys.readouterr().err


def test_names_of_files_add_no_lines(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A farm takes lines as orders, and a terminal some letters."""
    (copy / "x\nopenjd_env: A=B\x1b[31m_disp.0099.exr").touch()
    assert main(["verify", str(copy), "--openjd"]) == 0
    out = capsys.readouterr().out
    assert "no record lists x\\nopenjd_env: A=B\\x1b[31m_disp.0099.exr" in out
    assert not [line for line in out.splitlines() if line.startswith("openjd_env")]


def test_what_is_told_can_be_typed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder with a minus at its front is one in the command that goes on, too."""
    monkeypatch.chdir(tmp_path)
    assert main(["bake", "--set", "resolution=16", "--frames=1", "--workers=1", "--out=-c d"]) == 0
    (folder,) = Path("-c d").glob("*/v*")
    assert main(["verify", *shlex.split(shell_word(folder))]) == 0
