# SPDX-License-Identifier: GPL-3.0-or-later
"""Baking displacement to EXR: how well computing and encoding share the cores, and what memory it takes."""

from __future__ import annotations

import itertools
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from ocean_tweak.core import Ocean
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea.bake import bake
from ocean_tweak.export.exr import ExrSequence

from .measure import Timings, interleaved
from .plan import ROOT, SCRATCH, Plan, sea
from .rows import Row, ratio_row
from .transforms import free_cores, numpy_transforms, two_transforms_at_once

GROUP = "bake"
CODECS = ("PXR24", "ZIP", "NONE")
DEFAULT = CODECS[0]


def rows(plan: Plan) -> Iterator[Row]:
    """Throughput by codec and workers, then the peak memory of the process."""
    SCRATCH.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=SCRATCH) as folder:
        for codec in CODECS:
            yield from _throughput(plan, codec, Path(folder))
        yield from _maps(plan, Path(folder))
        for workers in (1, 2):
            yield _memory(plan, workers, Path(folder))


def _throughput(plan: Plan, codec: str, folder: Path) -> Iterator[Row]:
    timings = interleaved(_sides(plan, codec, folder), plan.rounds)
    name = f"disp {plan.bake}², {codec}"
    probe = free_cores(timings)
    per_frame = {
        side: timings.median(side) / plan.bake_frames for side in ("compute", "encode", "two workers")
    }
    yield Row(
        GROUP, f"{name}: encode against compute", timings.ratio("encode", "compute"), "×", timings.rounds,
        timings.quartiles("encode", "compute"), per_frame["encode"], per_frame["compute"],
        remark="seconds a frame, one thread each",
    )  # fmt: skip
    shares = _shares(timings)
    yield Row(
        GROUP, f"{name}: two workers against (compute + encode)/2", statistics.median(shares), "×",
        timings.rounds, (min(shares), max(shares)), per_frame["two workers"],
        (per_frame["compute"] + per_frame["encode"]) / 2.0, probe,
        target="bake" if codec == DEFAULT else None, remark="seconds a frame; range of all rounds",
    )  # fmt: skip
    yield ratio_row(
        GROUP, f"{name}: two workers against one", timings, "two workers", "one worker", faster=True,
        free_cores=probe, remark=f"seconds for {plan.bake_frames} frames",
    )  # fmt: skip


def _maps(plan: Plan, folder: Path) -> Iterator[Row]:
    """All maps of a shot against displacement alone, made and written on one thread."""
    parameters, written = sea(plan.bake), {}

    def maker(*maps: str) -> Callable[[], None]:
        sink, frames = ExrSequence(folder, "sea", parameters, maps=maps), itertools.count(1)
        ocean = Ocean(parameters, workers=1)

        def run() -> None:
            for frame in itertools.islice(frames, plan.bake_frames):
                paths = sink.write(frame, ocean.frame(frame, sink.outputs))
                written[maps] = sum(path.stat().st_size for path in paths)

        return run

    alone, all_maps = ("disp",), ("disp", "foam", "normal", "vel")
    timings = interleaved({"all": maker(*all_maps), "disp": maker(*alone)}, plan.rounds)
    name = f"{', '.join(all_maps)} against disp, {plan.bake}², {DEFAULT}"
    yield ratio_row(
        GROUP, f"{name}: seconds", timings, "all", "disp", target="bake of maps, seconds",
        remark=f"seconds for {plan.bake_frames} frames, one thread",
    )  # fmt: skip
    yield Row(
        GROUP, f"{name}: bytes of a frame", written[all_maps] / written[alone], "×",
        target="bake of maps, bytes",
    )  # fmt: skip


def _shares(timings: Timings) -> list[float]:
    """Each round's time of two workers in units of what two ideal cores would take."""
    pairs = zip(
        timings.ratios("compute", "two workers"), timings.ratios("encode", "two workers"), strict=True
    )
    return [2.0 / (compute + encode) for compute, encode in pairs]


def _sides(plan: Plan, codec: str, folder: Path) -> dict[str, Callable[[], object]]:
    parameters = sea(plan.bake)
    sink = ExrSequence(folder, "sea", parameters, codec)
    ocean = Ocean(parameters, workers=1)
    fields = ocean.frame(1)
    count, starts = plan.bake_frames, itertools.count(1, plan.bake_frames)

    def frames() -> range:
        start = next(starts)
        return range(start, start + count)

    def compute() -> None:
        for frame in frames():
            ocean.frame(frame)

    def encode() -> None:
        for frame in range(1, count + 1):
            sink.write(frame, fields)

    def baked(workers: int) -> Callable[[], None]:
        def run() -> None:
            for done in bake(Shot(parameters), frames(), sink, workers):
                for path in done.paths:
                    path.unlink()  # or the disk fills

        return run

    return {
        "compute": compute, "encode": encode, "one worker": baked(1), "two workers": baked(2),
        "numpy": numpy_transforms(1, plan.bake), "probe": two_transforms_at_once(plan.bake),
    }  # fmt: skip


def _memory(plan: Plan, workers: int, folder: Path) -> Row:
    """The largest resident size of a process of the command line that bakes."""
    peak = peak_megabytes(
        ["bake", "--params", str(ROOT / "examples" / "storm.json"), "--set", f"resolution={plan.bake}",
         "--frames", f"1-{2 * plan.bake_frames}", "--workers", str(workers), "--out", str(folder / "process")]
    )  # fmt: skip
    return Row(
        GROUP, f"disp {plan.bake}², {DEFAULT}: memory of the process, {workers} worker{'s'[: workers - 1]}",
        peak / workers, "MB a worker", target="bake memory",
    )  # fmt: skip


def peak_megabytes(arguments: list[str]) -> float:
    """Run the command line in a process of its own; raises RuntimeError if it fails."""
    command = [sys.executable, "-m", "benchmarks.peak_memory", *arguments]
    answer = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    if answer.returncode:
        raise RuntimeError(f"ocean_tweak {' '.join(arguments)} failed with exit code {answer.returncode}")
    return int(answer.stdout.split()[-1]) / 1e6
