# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever goes wrong, what was there before is still whole, and the reason is said."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from pxr import Sdf, Usd

from ocean_tweak.core import ParameterError
from ocean_tweak.export.usd.layers import whole_layer
from ocean_tweak.export.usd.library import UsdError
from ocean_tweak.export.usd.verify import verify

from .conftest import FORMS, write

ROOT = Path(__file__).parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}


def contents(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name != "entry"
    }


def command(form: str, top: Path, *more: str) -> list[str]:
    return [
        sys.executable, "-m", "ocean_tweak", "usd", "--form", form, "--out", str(top), "--set",
        "resolution=64", "--set", "foam.half_life=0", *more,
    ]  # fmt: skip


def limited() -> None:
    """A disk that takes no file beyond 100 kB."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))


@pytest.mark.parametrize("form", ["points", "clips"])
def test_full_disk_leaves_the_old_files(tmp_path, form):
    top = tmp_path / "sea.usd"
    write(top, form=form)
    before = contents(tmp_path)
    answer = subprocess.run(
        command(form, top, "--frames", "1001-1004", "--force"), preexec_fn=limited, env=ENVIRONMENT,
        capture_output=True, text=True,
    )  # fmt: skip
    assert answer.returncode == 1
    assert str(tmp_path) in answer.stderr
    assert "large" in answer.stderr
    assert "Traceback" not in answer.stderr
    assert contents(tmp_path) == before


@pytest.mark.parametrize("form", ["points", "clips"])
def test_killed_while_writing(tmp_path, form):
    top = tmp_path / "sea.usd"
    write(top, form=form)
    before = contents(tmp_path)
    process = subprocess.Popen(
        command(form, top, "--frames", "1-5000", "--force"), env=ENVIRONMENT, stdout=subprocess.DEVNULL
    )
    until = time.monotonic() + 60.0
    while not list(tmp_path.rglob(".*.part.usdc")) and time.monotonic() < until:
        time.sleep(0.002)
    process.kill()
    process.wait()
    after = contents(tmp_path)
    assert {name: data for name, data in after.items() if name in before} == before
    for name in after:
        if ".part" not in name:
            assert Sdf.Layer.OpenAsAnonymous(str(tmp_path / name))
    assert list(verify(top)) == []
    write(top, form=form)
    assert list(tmp_path.glob(".*")) == []


@pytest.mark.parametrize("form", FORMS)
def test_what_others_made_is_refused(tmp_path, form):
    for name in ("sea.usd", "mtl.usd"):
        foreign = tmp_path / name
        Usd.Stage.CreateNew(str(foreign)).Save()
        before = contents(tmp_path)
        with pytest.raises(UsdError, match=f"{name} exists already and was not written by Ocean Tweak"):
            write(tmp_path / "sea.usd", form=form)
        assert contents(tmp_path) == before
        foreign.unlink()
    (tmp_path / "sea.usd").write_bytes(b"no layer")
    with pytest.raises(UsdError, match="or is damaged"):
        write(tmp_path / "sea.usd", form=form)
    write(tmp_path / "sea.usd", form=form, force=True)
    assert list(verify(tmp_path / "sea.usd")) == []


def test_a_foreign_clip_is_refused(tmp_path):
    (tmp_path / "clips").mkdir()
    Usd.Stage.CreateNew(str(tmp_path / "clips" / "sea.1002.usdc")).Save()
    with pytest.raises(UsdError, match=r"sea\.1002\.usdc"):
        write(tmp_path / "sea.usd", form="clips")


def test_another_asset_in_the_folder_is_refused(tmp_path):
    write(tmp_path / "bay.usd")
    with pytest.raises(UsdError, match="belongs to the asset 'bay': give each asset its own folder"):
        write(tmp_path / "sea.usd")


def test_our_own_are_replaced(tmp_path):
    top = tmp_path / "sea.usd"
    write(top, form="clips")
    clip = tmp_path / "clips" / "sea.1002.usdc"
    stamp = clip.stat().st_mtime_ns
    write(top, form="clips")
    assert clip.stat().st_mtime_ns == stamp  # what is current stays
    write(top, form="clips", up_axis="Y")
    assert clip.stat().st_mtime_ns != stamp
    assert list(verify(top)) == []
    write(top, form="points")
    assert list(verify(top)) == []


def test_a_layer_that_fails_half_way_leaves_nothing(tmp_path):
    def fail() -> None:
        with whole_layer(tmp_path / "a.usd") as layer:
            Sdf.CreatePrimInLayer(layer, "/a")
            raise RuntimeError("stop")

    with pytest.raises(RuntimeError, match="stop"):
        fail()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"form": "alembic"}, "must be one of points, clips, displacement"),
        ({"up_axis": "X"}, "must be one of Z, Y"),
        ({"metres_per_unit": 0.0}, "metres_per_unit = 0"),
        ({"metres_per_unit": float("nan")}, "metres_per_unit = nan"),
        ({"tiles": (0, 3)}, "tiles"),
        ({"variants": (32, 32)}, "must differ"),
        ({"variants": (7,)}, "resolution = 7"),
        ({"variants": tuple(range(16, 50, 2))}, "must be at most 16"),
        ({"attributes": ("heat",)}, "attributes = 'heat'"),
        ({"attributes": ("foam", "foam")}, "must differ"),
        ({"proxy": -1}, "proxy"),
    ],
)
def test_options_that_cannot_be(tmp_path, options, said):
    with pytest.raises(ParameterError, match=said):
        write(tmp_path / "sea.usd", **options)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["payload.usd", "geo.usd"])
def test_names_that_are_taken(tmp_path, name):
    with pytest.raises(ParameterError, match="name"):
        write(tmp_path / name)


PROBE = """
import re, sys
from pathlib import Path
sys.path.insert(0, {root!r})
from ocean_tweak.export.usd import points
from tests.usd.conftest import write
points.HELD_BYTES = 2**20
write(Path({top!r}), frames="1-{count}", attributes=("velocities", "normals"), variants=(96,))
print(re.search(r"VmHWM:\\s+(\\d+)", Path("/proc/self/status").read_text())[1])
"""


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="only Linux tells")
def test_memory_does_not_grow_with_frames(tmp_path):
    peaks, sizes = [], []
    for count in (8, 160):
        top = tmp_path / str(count) / "sea.usd"
        code = PROBE.format(root=str(ROOT), top=str(top), count=count)
        answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        peaks.append(int(answer.stdout.split()[-1]) * 1024)
        sizes.append((top.parent / "96" / "geo.usdc").stat().st_size)
    assert sizes[1] - sizes[0] > 45e6
    assert peaks[1] - peaks[0] < 12e6
