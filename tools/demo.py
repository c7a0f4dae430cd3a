# SPDX-License-Identifier: GPL-3.0-or-later
"""From wind to pictures: bakes the storm, builds storm.blend, renders and measures it: `make demo`."""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from . import blender, build, contact_sheet, real_blender
from .project import BUILD, ROOT, ToolError, run_logged

PARAMETERS = ROOT / "examples" / "storm.json"
SCENE_SCRIPT = ROOT / "examples" / "storm_scene.py"
RENDER_SCRIPT = ROOT / "examples" / "storm_render.py"
GALLERY = ROOT / "docs" / "gallery"

FOLDER = BUILD / "demo"
CACHE = FOLDER / "cache"
PICTURES = FOLDER / "pictures"
BLEND = FOLDER / "storm.blend"
PROFILE = FOLDER / "profile"
LOG = FOLDER / "demo.log"

FIRST, LAST = 1, 24
RENDERED = (1, 12, 24)
SCENES = {
    "Displace": "Displace modifier, EXR sequence",
    "Geometry nodes": "Geometry nodes, EXR sequence",
    "Live": "Live, no files",
}
SAMPLES = 10
#: amount and size in m of the spray: over 2 km few particles, each as much larger
SPRAY = ("0.01", "0.01")


class Steps:
    """Runs the steps one after the other and keeps their seconds."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.current = ""

    @contextmanager
    def step(self, name: str) -> Iterator[None]:
        """Announce a step, then say how long it took."""
        self.current = name
        print(f"{name} ...", end=" ", flush=True)
        begin = time.monotonic()
        yield
        self.seconds[name] = time.monotonic() - begin
        print(f"{self.seconds[name]:.1f} s", flush=True)


def main() -> int:
    """Run the demo; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tools.demo", description=__doc__)
    parser.add_argument(
        "--gallery", action="store_true", help="also renew the contact sheet in docs/gallery/"
    )
    arguments = parser.parse_args()
    steps = Steps()
    try:
        table = run(steps)
        if arguments.gallery:
            with steps.step("renew docs/gallery"):
                contact_sheet.save_gallery(FOLDER / "contact_sheet.png", GALLERY)
    except (ToolError, OSError) as error:
        print(f"\ndemo failed: {steps.current}: {error}", file=sys.stderr)
        return 1
    print("", *table, "", *summary(steps), sep="\n")
    return 0


def run(steps: Steps) -> list[str]:
    """Do all there is to do; return the table of wave heights."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    PICTURES.mkdir(parents=True)
    with steps.step(f"bake frames {FIRST}-{LAST} with foam and spray"):
        bake()
    with steps.step("make Blender ready"):
        run_in_blender, note = ready_blender()
    print(f"  {note}")
    with steps.step("build storm.blend"):
        run_in_blender(build_scene_arguments())
    with steps.step(f"render {len(SCENES) * len(RENDERED)} pictures"):
        # before the script enables the extension, it sees that the baked oceans move without it
        render(RENDERED, "--samples", str(SAMPLES), "--check", out=PICTURES)
    with steps.step("compare pictures, lay out contact_sheet.png"):
        pictures = contact_sheet.load(PICTURES, tuple(SCENES), RENDERED)
        differences = contact_sheet.compare(pictures)
        contact_sheet.save(pictures, SCENES, FOLDER / "contact_sheet.png")
    print(f"  {differences}")
    with steps.step("measure the EXR pixels"):
        return wave_heights()


def summary(steps: Steps) -> list[str]:
    """The seconds of each step, and where the results are."""
    lines = [f"  {seconds:6.1f} s  {name}" for name, seconds in steps.seconds.items()]
    total = sum(steps.seconds.values())
    shown = FOLDER.relative_to(ROOT)
    return [
        *lines,
        f"  {total:6.1f} s  in all",
        "",
        f"{shown}/storm.blend and {shown}/contact_sheet.png are ready",
    ]


def bake() -> None:
    """Write displacement, foam and spray with the command line that artists use."""
    frames = f"{FIRST}-{LAST}"
    command = [sys.executable, "-m", "ocean_tweak", "bake", "--params", str(PARAMETERS), "--frames", frames]
    amount, size = SPRAY
    spray = ["--spray", "--set", f"spray.amount={amount}", "--set", f"spray.size={size}"]
    run_logged([*command, "--maps", "disp,foam,foam_age", *spray, "--out", str(CACHE)], LOG)


def frames_folder() -> Path:
    """Where the bake's only version lies."""
    (folder,) = CACHE.glob("*/v*")
    return folder


def ready_blender() -> tuple[Callable[[list[str]], None], str]:
    """What runs a script in Blender with the extension at hand, and a line that says which Blender it is.

    A real Blender gets the built zip, installed in a profile of its own; the bpy wheel takes this checkout.
    """
    try:
        found = real_blender.find()
    except real_blender.NoBlender as reason:
        if real_blender.required():
            raise
        return lambda arguments: run_script(
            SCENE_SCRIPT, arguments, "5.2"
        ), f"the bpy wheel, for want of a Blender: {reason}"
    env = {**os.environ, "BLENDER_USER_RESOURCES": str(PROFILE)}
    run_logged([sys.executable, "-m", "tools.build"], LOG)
    zip_file = build.zip_path()
    install = ["--command", "extension", "install-file", "-r", "user_default", "--enable", str(zip_file)]
    run_logged([*found.command, *install], LOG, env)
    return lambda arguments: run_script(
        SCENE_SCRIPT, arguments, "real", env=env
    ), f"{found.version}, {zip_file.name} installed"


def run_script(
    script: Path,
    arguments: list[str],
    where: str,
    blend: Path | None = None,
    env: dict[str, str] | None = None,
) -> None:
    """Run one of the example scripts in a Blender; raise `ToolError` if it fails."""
    command = blender.command(str(script), arguments, str(blend) if blend else None, where)
    run_logged(command, LOG, env)


def build_scene_arguments() -> list[str]:
    """The arguments of the scene script."""
    return [
        "--params", str(PARAMETERS), "--sequence", str(frames_folder()),
        "--frames", f"{FIRST}-{LAST}", "--spray", *SPRAY, "--out", str(BLEND),
    ]  # fmt: skip


def render(frames: Sequence[int], *options: str, out: Path) -> None:
    """Render pictures in a fresh Blender: the wheel, as it has a denoiser wherever it runs."""
    arguments = ["--frames", *map(str, frames), "--out", str(out), *options]
    run_script(RENDER_SCRIPT, arguments, "5.2", blend=BLEND)


def wave_heights() -> list[str]:
    """Hs and Tp as a table: of the spectrum, as resolved, of this seed, and measured on the files.

    Raises `ToolError` if the files do not hold this seed's waves.
    """
    from ocean_tweak.core import Ocean, OceanParameters

    parameters = OceanParameters.from_json(PARAMETERS.read_text(encoding="utf-8"))
    statistics = Ocean(parameters).statistics()
    states = {
        "spectrum": statistics.spectrum,
        "resolved by the grid": statistics.resolved,
        f"this seed ({parameters.seed})": statistics.seed,
    }
    rows = {name: (state.significant_wave_height, state.peak_period) for name, state in states.items()}
    height, _ = rows[f"EXR pixels, {LAST - FIRST + 1} frames"] = measure(parameters)
    ratio = height / statistics.seed.significant_wave_height
    if not 0.9 < ratio < 1.1:
        raise ToolError(f"the pixels' wave height is {ratio:.3f} of what this seed's should be")
    table = [f"  {name:24}{height:6.2f} m  {period:7.2f} s" for name, (height, period) in rows.items()]
    return [f"  {'':24}{'Hs':>8}  {'Tp':>9}", *table]


def measure(parameters: object) -> tuple[float, float]:
    """Hs in m, of the mean over all frames of the pixels' variance, and the mean peak period in s."""
    import numpy as np
    import OpenEXR

    from ocean_tweak.core.statistics.sea_statistics import field_state
    from ocean_tweak.export.frame_files import frame_file

    variances, periods = [], []
    for frame in range(FIRST, LAST + 1):
        path = frames_folder() / frame_file(PARAMETERS.stem, "disp", frame)
        with OpenEXR.File(str(path), separate_channels=True) as file:
            elevation = np.array(file.channels()["B"].pixels)[::-1]  # an EXR begins with its top row
        variances.append(np.var(elevation, dtype=np.float64))
        periods.append(field_state(elevation, parameters).peak_period)
    return 4.0 * float(np.sqrt(np.mean(variances))), float(np.mean(periods))


if __name__ == "__main__":
    sys.exit(main())
