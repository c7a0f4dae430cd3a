# SPDX-License-Identifier: GPL-3.0-or-later
"""Open Job Description bundles: what openjd and Deadline Cloud say to them, and the real jobs, run."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from ocean_tweak.cli import FileSea, main
from ocean_tweak.core import OceanParameters
from ocean_tweak.core.parameters.shot import Shot as SeaOfShot
from tools import environments, real_blender

from .conftest import Run, Shot
from .light import NOTHING, PER_METRE, PIXELS

WITH_BLEND = ["--blend", "BLEND", "--blender", "blender 5"]


@pytest.fixture(scope="module")
def shot(make_shot: Callable[[str], Shot]) -> Shot:
    return make_shot("images")


@pytest.fixture(scope="module")
def bundle(shot: Shot, wheel: Path) -> Path:
    """The job of which everything is run here, in the order of this file."""
    blend = shot.folder / "shot.blend"
    return shot.write("job", "--blend", blend, "--blender", wheel, "--render-chunk", "2")


def run_step(openjd: Run, shot: Shot, bundle: Path, step: str, *more: str, **environment: str) -> str:
    """Run a step, here and now; what it said, and OK or FAILED before it."""
    values = {"Cache": shot.cache, "BlendFile": shot.folder / "shot.blend", "Pictures": shot.pictures}
    parameters = [word for name, value in values.items() for word in ("-p", f"{name}={value}")]
    answer = openjd("run", bundle / "template.json", "--step", step, *parameters, *more, **environment)
    return ("FAILED" if answer.returncode else "OK") + "\n" + answer.stdout


def pixels(path: Path) -> np.ndarray:
    """(y, x, 3), from the bottom row to the top."""
    with OpenEXR.File(str(path)) as file:
        return np.array(file.channels()["RGB"].pixels)[::-1]


@pytest.mark.parametrize(
    ("arguments", "tasks"),
    [
        ([], {"Bake": 3, "Verify": 3}),
        (["--frames=-3-95x2", "--bake-with", "blender", "--workers", "3"], {"Bake": 50, "Verify": 50}),
        (WITH_BLEND, {"Bake": 3, "Verify": 3, "Render": 3}),
        ([*WITH_BLEND, "--plain-ranges", "--chunk", "1"], {"Bake": 3, "Verify": 3, "Render": 1}),
    ],
    ids=["bake", "blender", "render", "plain"],
)
def test_openjd_accepts_it(
    shot: Shot, openjd: Run, tmp_path: Path, arguments: list[str], tasks: dict[str, int]
) -> None:
    words = [str(shot.folder / "shot.blend") if word == "BLEND" else word for word in arguments]
    template = shot.write(f"accepted {tmp_path.name}", *words) / "template.json"
    extensions = ["--extensions", ""] if "--plain-ranges" in arguments else []
    checked = openjd("check", template, *extensions)
    assert checked.returncode == 0, checked.stdout
    blend = ["-p", "BlendFile=shot.blend"] if "--blend" in arguments else []
    summary = openjd("summary", template, *blend, *extensions, "--output", "json")
    assert summary.returncode == 0, summary.stdout
    steps = json.loads(summary.stdout[summary.stdout.index("{") :])["steps"]
    assert {step["name"]: step["total_tasks"] for step in steps} == tasks


def test_oceans_of_a_file_are_baked_side_by_side(openjd: Run, tmp_path: Path) -> None:
    seas = {
        "Bay.001": FileSea(SeaOfShot(OceanParameters(resolution=32)), "0123abcd", (1, 2)),
        "Open Sea": FileSea(SeaOfShot(OceanParameters(resolution=64)), None, (1, 2)),
    }
    (tmp_path / "shot.blend").touch()
    out = tmp_path / "job"
    arguments = ["job", "--out", str(out), "--blend", str(tmp_path / "shot.blend")]
    assert main(arguments, lambda: seas) == 0
    steps = json.loads((out / "template.json").read_text())["steps"]
    assert [step["name"] for step in steps] == ["Bake 1", "Verify 1", "Bake 2", "Verify 2", "Render"]
    assert steps[-1]["dependencies"] == [{"dependsOn": "Verify 1"}, {"dependsOn": "Verify 2"}]
    assert json.loads((out / "seas" / "Bay_001.json").read_text())["resolution"] == 32
    render = steps[-1]["script"]["actions"]["onRun"]["args"]
    assert [word for word in render if word.startswith("Bay_001-0123abcd/")]
    assert openjd("check", out / "template.json").returncode == 0


NAMES = ["{{Param.Nothing}}", "a{{b", "a}}b{{{{", "x" * 200, "a\nb\u2028c\x1b[31m", "é海", '"\\<script>']


@pytest.mark.parametrize("stem", NAMES)
def test_any_name_of_a_file_makes_a_job(openjd: Run, tmp_path: Path, stem: str) -> None:
    seas = {name: FileSea(SeaOfShot(OceanParameters(resolution=32)), None, (1,)) for name in ("A", "{{B}}")}
    blend = tmp_path / f"{stem}.blend"
    blend.touch()
    arguments = ["job", "--frames", "1-2", "--blend", str(blend), "--out", str(tmp_path / "job")]
    assert main(arguments, lambda: seas) == 0
    template = tmp_path / "job" / "template.json"
    checked = openjd("check", template)
    assert checked.returncode == 0, checked.stdout
    assert 1 <= len(json.loads(template.read_text())["name"]) <= 128


def test_deadline_cloud_reads_the_bundle(bundle: Path, run: Run, shot: Shot) -> None:
    answer = run(environments.program("farm", "deadline"), "bundle", "info", bundle)
    assert answer.returncode == 0, answer.stdout
    told = json.loads(answer.stdout[answer.stdout.index("{") :])
    assert told["steps"] == ["Bake", "Verify", "Render"]
    values = json.loads((bundle / "parameter_values.json").read_text())["parameterValues"]
    assert values == [{"name": "BlendFile", "value": str(shot.folder / "shot.blend")}]
    # what it does before it sends a job off
    script = (
        "import sys; from deadline.client.job_bundle import parameters, loader;"
        "loader.validate_directory_symlink_containment(sys.argv[1]);"
        "read = parameters.read_job_bundle_parameters(sys.argv[1]);"
        "print(*sorted(parameter['name'] for parameter in read))"
    )
    answer = run(environments.program("farm", "python"), "-c", script, bundle)
    names = "BlendFile Blender Cache ChunkSize Frames Pictures Python RenderChunkSize Seas"
    assert answer.stdout.strip() == names


def test_the_job_bakes_verifies_and_renders(openjd: Run, shot: Shot, bundle: Path) -> None:
    said = run_step(openjd, shot, bundle, "Render", "--run-dependencies")
    assert said.startswith("OK"), said
    assert sorted(path.name for path in shot.pictures.iterdir()) == [
        f"shot_{frame:04d}.exr" for frame in (1, 2, 3)
    ]
    for frame in (1, 2, 3):
        displacement = pixels(shot.bake / f"storm_disp.{frame:04d}.exr")[:PIXELS, :PIXELS]
        picture = pixels(shot.pictures / f"shot_{frame:04d}.exr")
        np.testing.assert_allclose(picture, NOTHING + PER_METRE * displacement, atol=2e-5)
    assert "openjd_progress: 100.0" in said


def test_frames_with_a_step_and_before_0_are_rendered(
    openjd: Run, make_shot: Callable[[str], Shot], wheel: Path
) -> None:
    """By the file's own modifiers, without the extension; they knew other frames of another bake, which was
    made before the scene's time was stretched."""
    stepped = make_shot("baked")
    job = stepped.write(
        "job", "--frames=-2-40x14", "--chunk", "3", "--render-chunk", "3",
        "--set", "choppiness=0", "--set", "timing.stretch=2",
        "--blend", stepped.folder / "shot.blend", "--blender", wheel,
    )  # fmt: skip
    frames = {-2: "-002", 12: "0012", 26: "0026", 40: "0040"}
    said = run_step(openjd, stepped, job, "Render", "--run-dependencies")
    assert said.startswith("OK"), said
    pictures = {
        frame: pixels(stepped.pictures / f"shot_{'-' * (frame < 0)}{abs(frame):04d}.exr") for frame in frames
    }
    assert len(list(stepped.pictures.iterdir())) == 4
    heights = {
        frame: pixels(stepped.bake / f"storm_disp.{label}.exr")[..., 2] for frame, label in frames.items()
    }
    for frame, picture in pictures.items():
        height = (picture[..., 2] - NOTHING) / PER_METRE
        # a pixel is a quad, seen from above
        quads = {
            other: sum(field[y : y + PIXELS, x : x + PIXELS] for y in (0, 1) for x in (0, 1)) / 4
            for other, field in heights.items()
        }
        errors = {other: float(np.abs(height - field).mean()) for other, field in quads.items()}
        assert all(errors[frame] < 0.5 * error for other, error in errors.items() if other != frame), errors


def test_a_damaged_frame_stops_the_job_until_its_task_ran_again(
    openjd: Run, run: Run, shot: Shot, bundle: Path
) -> None:
    frame, other = (shot.bake / f"storm_disp.{number:04d}.exr" for number in (2, 3))
    before, untouched = frame.read_bytes(), other.stat().st_mtime_ns
    frame.write_bytes(before[:-100] + bytes(100))
    said = run_step(openjd, shot, bundle, "Verify", "--no-run-dependencies")
    assert said.startswith("FAILED"), said
    assert "frame 2 is damaged: storm_disp.0002.exr has contents other than those written" in said
    # a machine that was lost in the middle leaves its lock behind
    lost = (
        "import os, sys; from pathlib import Path; from ocean_tweak.export.cache.locks import claimed\n"
        "with claimed(Path(sys.argv[1]), (1, 2)): os._exit(0)"
    )
    assert run(sys.executable, "-c", lost, shot.bake).returncode == 0
    assert list((shot.bake / "locks").glob("*.lock"))
    again = run_step(openjd, shot, bundle, "Bake", "--no-run-dependencies", "--task-param", "Frames=1-2")
    assert again.startswith("OK"), again
    assert frame.read_bytes() == before
    assert other.stat().st_mtime_ns == untouched
    said = run_step(openjd, shot, bundle, "Verify", "--no-run-dependencies")
    assert said.startswith("OK"), said


def test_a_missing_frame_is_not_rendered_flat(openjd: Run, shot: Shot, bundle: Path) -> None:
    frame = shot.bake / "storm_disp.0003.exr"
    aside = frame.rename(frame.with_suffix(".aside"))
    said = run_step(openjd, shot, bundle, "Render", "--no-run-dependencies", "--task-param", "Frames=3")
    aside.rename(frame)
    assert said.startswith("FAILED"), said
    assert f"{frame} is missing: bake and verify this frame again" in said


def test_written_out_ranges_bake_without_the_extension(openjd: Run, shot: Shot) -> None:
    plain = shot.write("plain", "--plain-ranges")
    cache = shot.folder / "plain cache"
    answer = openjd(
        "run", plain / "template.json", "--extensions", "", "--step", "Bake", "-p", f"Cache={cache}"
    )
    assert answer.returncode == 0, answer.stdout
    baked = {path.name: path.read_bytes() for path in cache.glob("*/v*/*.exr")}
    assert baked == {path.name: path.read_bytes() for path in shot.bake.glob("*.exr")}


def test_a_real_blender_renders_the_same(shot: Shot, bundle: Path, run: Run, tmp_path: Path) -> None:
    try:
        blender = real_blender.find()
    except real_blender.NoBlender as reason:
        pytest.skip(str(reason))
    step = json.loads((bundle / "template.json").read_text())["steps"][-1]["script"]
    script = tmp_path / "render_baked.py"
    script.write_text(step["embeddedFiles"][0]["data"])
    given = {
        "{{Param.BlendFile}}": shot.folder / "shot.blend", "{{Task.File.Render}}": script,
        "--cache={{Param.Cache}}": f"--cache={shot.cache}",
        "--pictures={{Param.Pictures}}": f"--pictures={tmp_path}",
        "--frames={{Task.Param.Frames}}": "--frames=2",
    }  # fmt: skip
    answer = run(*blender.command, *(given.get(word, word) for word in step["actions"]["onRun"]["args"]))
    assert answer.returncode == 0, answer.stdout
    picture = pixels(tmp_path / "shot_0002.exr")
    np.testing.assert_allclose(picture, pixels(shot.pictures / "shot_0002.exr"), atol=2e-5)


def test_a_live_ocean_is_rendered_from_its_bake(
    openjd: Run, make_shot: Callable[[str], Shot], wheel: Path
) -> None:
    live = make_shot("live")
    rendered = ["--blend", live.folder / "shot.blend", "--blender", wheel]
    step = ["Render", "--no-run-dependencies", "--task-param", "Frames=2"]
    bake = ["bake", "--params", str(live.folder / "storm.json"), "--frames", "2", "--out", str(live.cache)]
    assert main(bake) == 0
    said = run_step(openjd, live, live.write("job", *rendered), *step, WITH_EXTENSION="1")
    assert said.startswith("OK"), said
    assert f"Ocean reads {live.bake}" in said
    assert [path.name for path in live.pictures.iterdir()] == ["shot_0002.exr"]

    wider = ["--set", "domain_size=300"]
    assert main([*bake, *wider]) == 0
    said = run_step(openjd, live, live.write("other", *rendered, *wider), *step, WITH_EXTENSION="1")
    assert said.startswith("FAILED")
    assert "Ocean is 200 m wide" in said


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--frames", "1-2x0.5"], "frame 1.5: farm tasks are whole frames"),
        (["--frames", "1-2000", "--chunk", "1", "--plain-ranges"], "2000 tasks in a step: at most 1024"),
        (["--frames", "1", "--blend", "absent.blend"], "--blend absent.blend: is not a file"),
        (["--frames", "1", "--pictures", "x"], "--pictures: nothing is rendered without --blend"),
        (
            ["--frames", ",".join(str(number**2) for number in range(300))],
            "write them out with --plain-ranges",
        ),
        (["--frames", "1", "--cache", "/" + 1030 * "x"], "1031 characters; a farm job holds at most 1024"),
        (["--frames", "1", "--cache", "\udce4"], "is not Unicode text"),
        (["--frames", "1", "--python", ""], "--python and --blender: say how"),
        (["--frames", "1", "--chunk", "0"], "'0' must be a whole number from 1"),
        (["--frames=-1", "--form", "flamenco"], "frame -1: Flamenco has no negative frames"),
        (["--frames", "1", "--form", "flamenco", "--plain-ranges"], "divides frames itself"),
    ],
)
def test_what_no_farm_can_run_is_refused(
    arguments: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["job", "--out", str(tmp_path / "job"), *arguments]) == 2
    assert said in capsys.readouterr().err


def test_what_ends_a_command_is_told_to_the_farm(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--out", str(tmp_path), "--openjd"]) == 1
    (line,) = capsys.readouterr().out.splitlines()
    assert line.startswith(f"openjd_fail: {tmp_path}/ocean-")
    assert main(["verify", str(tmp_path), "--out", str(tmp_path)]) == 2
