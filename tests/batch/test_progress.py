# SPDX-License-Identifier: GPL-3.0-or-later
"""What a bake says: a bar on a terminal, JSON for machines, a farm's lines, in any alphabet."""

from __future__ import annotations

import errno
import json
import logging
import math
import os
import re
import subprocess
import time
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from ocean_tweak.cli import main, progress
from ocean_tweak.cli.progress import Progress
from ocean_tweak.core.foam.model import Births
from ocean_tweak.core.sea.bake import BakedFrame
from ocean_tweak.export import logs
from tests.batch.bakery import ROOT, SOON, command, each_json_line, images, only_folder, run, write_sea


@pytest.fixture
def sea(tmp_path: Path) -> Path:
    return write_sea(tmp_path / "sea.json", resolution=16)


def bake(sea: Path, cache: Path, *more: object) -> list[str]:
    return [str(a) for a in ("bake", "--params", sea, "--frames", "1-5", "--out", cache, *more)]


def on_a_terminal(arguments: list[str], columns: int) -> str:
    """What a command writes to a terminal of its own."""
    pty = pytest.importorskip("pty")
    ours, its = pty.openpty()
    with subprocess.Popen(
        command(*arguments), cwd=ROOT, stdin=its, stdout=its, stderr=its,
        env={**os.environ, "COLUMNS": str(columns)},
    ) as process:  # fmt: skip
        os.close(its)
        said = b""
        while True:
            try:
                block = os.read(ours, 4096)
            except OSError as error:  # so Linux says that the other end is closed
                if error.errno != errno.EIO:
                    raise
                break
            if not block:
                break
            said += block
        assert process.wait(SOON) == 0
    os.close(ours)
    return said.decode()


@pytest.mark.parametrize("workers", [1, 2])
def test_a_bar_on_a_terminal(sea: Path, tmp_path: Path, workers: int) -> None:
    said = on_a_terminal(bake(sea, tmp_path / "c", "--workers", workers), 80)
    drawn = re.findall(r"\r(\d)/5 \[(#*)(\.*)\] (\d+:\d\d) left  sea *", said)
    assert [int(count) for count, *_ in drawn] == [1, 2, 3, 4, 5]
    assert [len(filled) for _, filled, *_ in drawn] == [6, 12, 18, 24, 30]
    assert all(len(filled) + len(empty) == 30 for _, filled, empty, _ in drawn)
    assert said.endswith("\r\n")
    assert "frame 1 (" not in said


def test_what_takes_long_is_told_meanwhile(
    sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A frame's foam looks back, which counts as the frame's time, and its maps are written one by one."""
    monkeypatch.setattr(progress, "_SILENCE", 0.0)
    monkeypatch.setattr(Births, "add", slow_birth)
    command = bake(
        sea, tmp_path / "c", "--maps", "disp,foam", "--workers", "1", "--set", "foam.half_life=0.1"
    )
    assert main([*command, "--json", "--only", "1-2"]) == 0
    said = [line for line in each_json_line(capsys.readouterr().out) if "frame" in line]
    first = [line["doing"] for line in said if line["frame"] == 1 and "doing" in line]
    count = math.floor(6 * 0.1 * 8) + 1  # moments of an eighth of a second until 2⁻⁶ is left
    assert first[:count] == [f"foam: looked back at {n + 1} of {count} moments" for n in range(count)]
    assert first[count:] == ["wrote 1 of 2 files", "wrote 2 of 2 files"]
    (seconds,) = (line["seconds"] for line in said if line["frame"] == 1 and "seconds" in line)
    assert seconds > 0.05 * count


def slow_birth(self: Births, *arguments: Any, add: Callable[..., None] = Births.add) -> None:
    time.sleep(0.05)
    add(self, *arguments)


def test_a_frame_that_is_quick_needs_no_words(
    sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(progress, "_SILENCE", 60.0)  # as quick as that is any machine
    assert main(bake(sea, tmp_path / "c", "--maps", "disp,foam", "--workers", "1", "--json")) == 0
    assert not [line for line in each_json_line(capsys.readouterr().out) if "doing" in line]


def test_a_log_beside_a_bake(sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Each line that was printed, and what ended the second bake; nothing of it twice on the console."""
    for more in ("--workers", "1"), ("--workers", "2", "--only", "3", "--maps", "vel"), ("--only", "9"):
        main(bake(sea, tmp_path / "c", "--log", *more))
    said = capsys.readouterr()
    assert said.out.count("frame 3 (") == 2
    assert said.err.count("\n") == 1
    first, second = sorted((tmp_path / "c").glob("*/v*.log"))
    lines = first.read_text().splitlines()
    assert [re.findall(r"INFO sea: (frame \d)", line) for line in lines[3:]] == [
        [f"frame {n}"] for n in range(1, 6)
    ]
    assert all(re.match(rf"\d{{4}}-\d\d-\d\d \d\d:\d\d:\d\d \S+ {os.getpid()} ", line) for line in lines)
    assert second.read_text().count("frame 3 (1/1)") == 1
    assert main(["clean", str(first.with_suffix(""))]) == 0
    assert not first.exists()
    assert second.exists()


def test_a_log_that_cannot_be_written(sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Nor does one wait for the reader of a fifo, or write through a link."""
    assert main(bake(sea, tmp_path / "c", "--estimate")) == 0
    log = only_folder(tmp_path / "c").with_suffix(".log")
    capsys.readouterr()
    os.mkfifo(log)
    assert main(bake(sea, tmp_path / "c", "--log")) == 1
    log.unlink()
    log.symlink_to(tmp_path / "elsewhere")
    assert main(bake(sea, tmp_path / "c", "--log")) == 1
    assert not (tmp_path / "elsewhere").exists()
    assert [line[: line.rindex(":")] for line in capsys.readouterr().err.splitlines()] == [
        f"ocean_tweak: {log}"
    ] * 2


def test_how_much_the_console_hears(sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def heard(*more: str) -> str:
        assert main(bake(sea, tmp_path / "c", "--workers", "2", *more)) == 0
        return capsys.readouterr().err

    assert heard() == ""
    (tmp_path / "c").rename(tmp_path / "d")
    lines = heard("-vv").splitlines()
    assert lines
    assert all(line.startswith(("ocean_tweak: info: ", "ocean_tweak: debug: ")) for line in lines)


def test_what_another_process_says_is_said_as_it_was(caplog: pytest.LogCaptureFixture) -> None:
    logger = logging.getLogger("ocean_tweak.cli")
    with caplog.at_level(logging.DEBUG, "ocean_tweak"):
        lines = ["ocean_tweak: flat\n", "ocean_tweak: info: done\n", "\n", "a library's own\n"]
        assert [logs.relay(line, logger) for line in lines] == ["flat", "done", "", "a library's own"]
    assert [(record.levelname, record.message) for record in caplog.records] == [
        ("WARNING", "flat"), ("INFO", "done"), ("DEBUG", "a library's own"),
    ]  # fmt: skip


def test_a_message_is_one_line_without_control_characters(capsys: pytest.CaptureFixture[str]) -> None:
    logs.to_console()
    logging.getLogger("ocean_tweak.core").warning("host %s", "a\x1b[31m\nb\u202e" + 9000 * "c")
    line = capsys.readouterr().err
    assert line.startswith("ocean_tweak: host a\\x1b[31m b\\u202ec")
    assert len(line) < 4100


def test_a_narrow_terminal_has_one_line(sea: Path, tmp_path: Path) -> None:
    """A longer one would wrap, and the next be drawn below it."""
    said = on_a_terminal(bake(sea, tmp_path / "c", "--workers", 1, "--name", "x" * 90), 40)
    assert {len(line.rstrip("\r\n")) for line in re.findall(r"\r(\d/5[^\r]*)", said)} == {39}


def test_a_line_a_frame_elsewhere(sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(bake(sea, tmp_path / "c", "--workers", "1")) == 0
    out = capsys.readouterr().out
    assert "\r" not in out
    lines = out.splitlines()[2:]
    assert [re.sub(r"\d\.\d\d s", "_ s", line) for line in lines] == [
        f"sea: frame {n} ({n}/5) _ s  sea_disp.000{n}.exr" for n in range(1, 6)
    ]


def test_json_a_line(sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cache = tmp_path / "Größe"
    assert main(bake(sea, cache, "--workers", "1", "--json", "--name", "Ärmelkanal")) == 0
    folder = only_folder(cache)
    first, *rest = each_json_line(capsys.readouterr().out)
    assert first["frames"] == first["left"] == first["missing"] == 5
    assert Path(first["folder"]) == folder
    assert first["bytes"] > 0
    assert first["free"] > 0
    assert [line["frame"] for line in rest] == [1, 2, 3, 4, 5]
    assert all(Path(path).is_file() for line in rest for path in line["paths"])
    (folder / "records" / "0002.json").unlink()
    (folder / "Ärmelkanal_disp.0003.exr").write_bytes(b"")
    assert main(["verify", str(folder), "--json"]) == 1
    *lines, last = each_json_line(capsys.readouterr().out)
    states = {line["frame"]: line["state"] for line in lines if "state" in line}
    assert states == {1: "whole", 2: "missing", 3: "damaged", 4: "whole", 5: "whole"}
    assert (last["whole"], last["missing"], last["damaged"]) == (3, 1, 1)
    assert main(["clean", str(folder), "--json"]) == 0
    (line,) = each_json_line(capsys.readouterr().out)
    assert line["files"] == 4
    assert line["left"] == []
    assert line["foreign"] == ["Ärmelkanal_disp.0002.exr"]


def farm_lines(text: str, kind: str) -> list[str]:
    return re.findall(rf"^openjd_{kind}: (.*)$", text, re.MULTILINE)


@pytest.mark.parametrize("workers", [1, 2])
def test_a_farms_lines(sea: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], workers: int) -> None:
    arguments = bake(sea, tmp_path, "--workers", workers, "--openjd")
    assert main(arguments) == 0
    out = capsys.readouterr().out
    assert farm_lines(out, "progress") == ["20.0", "40.0", "60.0", "80.0", "100.0"]
    assert len(farm_lines(out, "status")) == 5
    assert farm_lines(out, "fail") == []
    assert main(arguments) == 0
    assert farm_lines(capsys.readouterr().out, "progress") == ["100.0"]  # all is there
    folder = only_folder(tmp_path)
    (folder / "sea_disp.0003.exr").unlink()
    assert main(["verify", str(folder), "--openjd"]) == 1
    out = capsys.readouterr().out
    assert farm_lines(out, "fail") == ["sea: 4 whole, 1 damaged"]
    assert farm_lines(out, "progress")[-1] == "100.0"


def test_a_farm_is_told_why(sea: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(bake(sea, Path("/proc/self/cache"), "--openjd")) == 1
    captured = capsys.readouterr()
    (reason,) = farm_lines(captured.out, "fail")
    assert captured.err == f"ocean_tweak: {reason}\n"


@pytest.mark.parametrize(
    "environment",
    [
        {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
        {"PYTHONIOENCODING": "ascii:strict", "PYTHONUTF8": "0"},
    ],
    ids=["C", "ascii"],
)
def test_other_alphabets(sea: Path, tmp_path: Path, environment: dict[str, str]) -> None:
    """Names that a terminal cannot show are written nevertheless, and nothing fails because of them."""
    env = {**os.environ, **environment}
    cache = tmp_path / "海 Größe"
    for workers in (1, 2):
        answer = run(*bake(sea, cache, "--workers", workers, "--name", "Ärmel海"), env=env, errors="replace")
        assert (answer.returncode, answer.stderr) == (0, "")
        folder = only_folder(cache)
        if workers == 1:
            (folder / "records" / "0002.json").unlink()
    assert len(images(folder)) == 5
    assert run("verify", folder, env=env, errors="replace").returncode == 0
    images(folder)[2].unlink()
    answer = run("verify", folder, env=env, errors="replace")
    assert answer.returncode == 1
    assert "0003.exr is gone" in answer.stdout
    refused = run("bake", "--frames", "1", "--out", "/proc/海", env=env, errors="replace")
    assert refused.returncode == 1
    assert "Traceback" not in refused.stderr
    assert run("bake", "--help", env=env, errors="replace").returncode == 0


def test_a_reader_that_goes_away(sea: Path, tmp_path: Path) -> None:
    """`bake … | head -1`: it ends in a line, and what it has made is whole."""
    with subprocess.Popen(
        command(*bake(sea, tmp_path, "--workers", 1)),
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as process:
        process.stdout.readline()
        process.stdout.close()
        err = process.stderr.read().decode()
        assert process.wait(SOON) == 1
    assert err.count("\n") == 1, err
    assert "Broken pipe" in err
    assert main(["resume", str(only_folder(tmp_path)), "--workers", "1"]) == 0


def test_frames_are_named_as_they_were_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    progress = Progress("sea")
    progress.begin(3)
    for frame in (-7, Fraction(5, 4), 12345):
        progress.frame(BakedFrame(frame, (), 0.5))
    assert re.findall(r"frame (\S+) \(", capsys.readouterr().out) == ["-7", "1.25", "12345"]


def test_several_seas_one_after_the_other(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Where one fails, the next is not begun as if nothing had been."""
    from ocean_tweak.cli import FileSea
    from ocean_tweak.core import OceanParameters
    from ocean_tweak.core.parameters.shot import Shot

    oceans = {name: FileSea(Shot(OceanParameters(resolution=16, seed=len(name)))) for name in ("A", "BB")}
    bad = tmp_path / "bad"
    bad.write_text("a file")
    assert main(["bake", "--frames", "1", "--out", str(bad)], lambda: oceans) == 1
    assert main(["bake", "--frames", "1", "--out", str(tmp_path / "c"), "--json"], lambda: oceans) == 0
    seas = [json.loads(line)["sea"] for line in capsys.readouterr().out.splitlines()]
    assert seas == ["A", "A", "BB", "BB"]
