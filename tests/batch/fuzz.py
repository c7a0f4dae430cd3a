# SPDX-License-Identifier: GPL-3.0-or-later
"""Damages files in many ways and lets what reads them read them, in a process that may use little memory.

`python -m tests.batch.fuzz KIND SCRATCH FIRST LAST` prints the number of each damage before it is tried,
so that whoever started this knows which one ended it, and at its end the most memory that was used, in kB.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import random
import resource
import shutil
import signal
import sys
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ocean_tweak.cli import main
from ocean_tweak.core import OceanParameters, ParameterError
from ocean_tweak.core.data.plain_data import parse_json
from ocean_tweak.core.data.raster import Raster
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.statistics.sea_spectrum import SeaSpectrum
from ocean_tweak.core.statistics.sea_statistics import spectrum_state
from ocean_tweak.export.cache.job import sealed
from ocean_tweak.export.cache.records import file_hash
from ocean_tweak.export.exr import ExrError, read_header, read_image
from ocean_tweak.export.images import read_raster, with_rasters
from ocean_tweak.export.spectra.reading import chosen_place, chosen_times, measured_sea, read_spectra
from ocean_tweak.export.usd import isolated
from ocean_tweak.export.usd.library import pxr
from tests.batch import mutations
from tests.batch.bakery import only_folder, write_sea
from tests.batch.bakery import run as run_command
from tests.export.spectrum_files import BUOY_FILES, F, bump, swan_text
from tests.image_files import exr, png, tiff
from tests.layers import layers_of

MEMORY = 2 * 2**30
#: of the processor; whoever started this limits the time that passes
SECONDS = 10
#: failures that are told before a process gives up
MOST_FAILURES = 20


class Fuzz:
    """Whole files in a folder of its own, and what reads a damaged one."""

    def __init__(self, scratch: Path) -> None:
        self.scratch = scratch
        scratch.mkdir(parents=True, exist_ok=True)

    def attempt(self, chance: random.Random) -> None:
        """One damage, read. Raises where that ends otherwise than it is promised."""
        raise NotImplementedError

    def command(self, *arguments: object) -> int:
        """A command's code; it must have said what is wrong in a line."""
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            code = main([str(argument) for argument in arguments])
        assert code in (0, 1, 2), code
        assert "Traceback" not in said.getvalue(), said.getvalue()
        assert "enough memory" not in said.getvalue(), said.getvalue()
        return code


class Images(Fuzz):
    """Images and arrays of one kind, as parameters name them."""

    def __init__(self, scratch: Path, suffix: str, mutated: mutations.Mutation) -> None:
        super().__init__(scratch)
        self.suffix, self.mutated = suffix, mutated
        whole = scratch / "whole"
        whole.mkdir(exist_ok=True)
        _WHOLE[suffix](whole)
        self.whole = [path.read_bytes() for path in sorted(whole.iterdir())]
        for path in whole.iterdir():
            read_raster(path, names="a" if path.stem == "layers" else "")

    def attempt(self, chance: random.Random) -> None:
        """Read as an image, a wind, or whatever it holds."""
        path = self.scratch / f"damaged{self.suffix}"
        path.write_bytes(self.mutated(chance.choice(self.whole), chance))
        names = chance.choice(("", "", "", "a", "Y")) if self.suffix == ".exr" else ""
        with contextlib.suppress(ParameterError):
            read_raster(path, chance.choice((None, 1, 2)), names)
        if self.suffix == ".exr":  # a map of a bake too
            for read in (read_header, read_image):
                with contextlib.suppress(ExrError):
                    read(path)


def _whole_pngs(folder: Path) -> None:
    noise = np.random.default_rng(1).integers(0, 256, (5, 64), dtype=np.uint8)
    for depth, colour, bytes_a_row in (
        (8, 0, 4),
        (8, 2, 12),
        (16, 0, 8),
        (16, 2, 24),
        (16, 6, 32),
        (1, 0, 1),
    ):
        rows = [row[:bytes_a_row].tobytes() for row in noise]
        png(folder / f"{depth}-{colour}.png", depth, colour, rows, 4)


def _whole_tiffs(folder: Path) -> None:
    values = np.arange(15).reshape(3, 5)
    for kind in ("u1", "u2", "u4", "i2", "i4", "f4"):
        for order in "<>" if kind != "u4" else "<":
            tiff(folder / f"{kind}{'lb'[order == '>']}.tif", values.astype(kind), order)
    tiff(folder / "rgb8.tif", np.arange(45, dtype=np.uint8).reshape(3, 5, 3))
    tiff(folder / "rgb16.tif", np.arange(45, dtype=np.uint16).reshape(3, 5, 3))
    with contextlib.suppress(ImportError):
        from PIL import Image

        for name in ("tiff_lzw", "tiff_adobe_deflate", "packbits", "jpeg"):
            grey = Image.fromarray(values.astype(np.uint8))
            grey.save(folder / f"{name}.tif", compression=name)


def _whole_exrs(folder: Path) -> None:
    import OpenEXR

    values = np.arange(20, dtype=np.float32).reshape(4, 5)
    exr(folder / "window.exr", {"Y": values}, (1, 1), (9, 9))
    exr(folder / "half.exr", {name: values.astype(np.float16) for name in "RGB"})
    exr(folder / "layers.exr", {"a.R": values, "a.G": values, "Z": values})
    for name in ("ZIP", "PXR24", "PIZ", "HTJ2K256", "B44", "DWAA", "RLE"):
        header = {"compression": getattr(OpenEXR, f"{name}_COMPRESSION"), "type": OpenEXR.scanlineimage}
        OpenEXR.File(header, {"Y": values}).write(str(folder / f"{name}.exr"))
    header |= {"type": OpenEXR.tiledimage, "tiles": OpenEXR.TileDescription()}
    OpenEXR.File(header, {"Y": values}).write(str(folder / "tiles.exr"))


def _whole_arrays(folder: Path) -> None:
    values = np.arange(24.0)
    for index, shape in enumerate(((4, 6), (3, 4, 2), (2, 3, 4))):
        np.save(folder / f"{index}.npy", values.reshape(shape))
    np.save(folder / "grey.npy", values.astype(np.uint16).reshape(4, 6))
    np.save(folder / "mask.npy", values.reshape(4, 6) > 5)


_WHOLE: dict[str, Callable[[Path], None]] = {
    ".png": _whole_pngs, ".tif": _whole_tiffs, ".exr": _whole_exrs, ".npy": _whole_arrays,
}  # fmt: skip


_MASK = {"source": "IMAGE", "image": {"file": "a.npy"}}
_WIND = {"values": [[[4, 0], [4, 0]], [[8, 0], [8, 2]]]}
_PATCHES = [
    {"domain_size": 90.0, "resolution": 16, "shortest_wavelength": 15.0},
    {"domain_size": 30.0, "resolution": 16, "longest_wavelength": 15.0},
]
_SEAS = (
    {"layers": [{"wind_speed": 9.0, "mask": _MASK}, {"definition": "SEA_STATE"}], "water": {"depth": 20}},
    {"wind_fields": [{"keys": [{"time": 0, "vectors": _WIND}], "columns": 2, "rows": 2}]},
    {"hero_waves": [{"wavelength": 30.0, "group_length": 2, "group_width": 30}], "loop_duration": 10},
    {"patches": _PATCHES, "foam": {"half_life": 2}},
    {"animation": {"first_frame": 1, "samples": {"choppiness": [0.5, 1.0], "ocean_time": [1, 2]}}},
)


class Parameters(Fuzz):
    """Parameters as JSON, with everything that a sea may have."""

    def __init__(self, scratch: Path) -> None:
        super().__init__(scratch)
        ramp = Raster(np.arange(64.0).reshape(8, 8))
        np.save(scratch / "a.npy", ramp.values)
        images = {"pictures": [{"image": ramp.to_plain(), "filter": "FRACTAL"}, {"noise_resolution": 16}]}
        plain = {"resolution": 16, "domain_size": 100.0}
        self.whole = [json.dumps(plain | more).encode() for more in (images, *_SEAS)]
        for content in self.whole:
            self._shot(content)

    def attempt(self, chance: random.Random) -> None:
        """Read; what is a small sea is told of too."""
        content = mutations.of_json(chance.choice(self.whole), chance)
        (self.scratch / "sea.json").write_bytes(content)
        try:
            parameters = self._shot(content).parameters
        except (ParameterError, UnicodeDecodeError):
            return
        if chance.random() < 0.05 and _is_small(parameters):
            self.command("info", "--params", self.scratch / "sea.json")

    def _shot(self, content: bytes) -> Shot:
        plain = parse_json(content.decode("utf-8"))
        return Shot.from_dict(with_rasters(OceanParameters, plain, self.scratch))


def _is_small(parameters: OceanParameters) -> bool:
    """Whether a sea is told of in less than seconds."""
    sides = [parameters.resolution, *(patch.resolution for patch in parameters.patches)]
    sides += [layer.noise_resolution for layer in layers_of(parameters, "IMAGE")]
    return max(sides) <= 64 and not layers_of(parameters, "WIND_FIELD")


class Records(Fuzz):
    """A bake of two frames, of which a record or the job is damaged, and mostly sealed anew."""

    def __init__(self, scratch: Path) -> None:
        super().__init__(scratch)
        self.folder = _baked(scratch, "ZIP")
        self.files = [self.folder / "bake.json", *sorted((self.folder / "records").glob("*.json"))]
        self.whole = {path: path.read_bytes() for path in self.files}

    def attempt(self, chance: random.Random) -> None:
        """Verified, which reads the job, each record and all frames that they tell."""
        path = chance.choice(self.files)
        path.write_bytes(mutations.of_json(self.whole[path], chance))
        if chance.random() < 0.8:
            vouch(self.folder, path)
        self.command("verify", self.folder)
        path.write_bytes(self.whole[path])


class Usd(Fuzz):
    """An asset of points, of whose layers one is damaged."""

    #: what ends a process in which OpenUSD breaks off, as it may: the command reads in one of its own
    BROKEN_OFF = (signal.SIGABRT, signal.SIGSEGV, signal.SIGBUS, signal.SIGFPE, signal.SIGILL)

    def __init__(self, scratch: Path) -> None:
        super().__init__(scratch)
        sea = write_sea(scratch / "sea.json", resolution=16)
        self.top = scratch / "asset" / "sea.usda"
        options = ("--frames", "1-2", "--form", "points", "--proxy", "0", "--attributes", "velocities")
        # in another process: this one forks, which OpenUSD's threads would not outlive
        made = run_command("usd", "--params", sea, "--out", self.top, *options)
        assert made.returncode == 0, made.stderr
        pxr()  # read once for all forks
        self.files = sorted(path for path in self.top.parent.iterdir() if path.is_file())
        self.whole = {path: path.read_bytes() for path in self.files}
        assert self._answered({"path": str(self.top), "verify": True}) == 0

    def attempt(self, chance: random.Random) -> None:
        """Verified, or read as parameters: now and then by the command, mostly as its process does."""
        path = chance.choice((self.top, *self.files))
        path.write_bytes(mutations.of_usd(self.whole[path], chance))
        verified = path != self.top or chance.random() < 0.5
        if chance.random() < 0.005:
            self.command(*(["usd-verify"] if verified else ["info", "--params"]), self.top)
        else:
            code = self._answered({"path": str(self.top), "verify": verified})
            assert code == 0 or -code in self.BROKEN_OFF, code
        path.write_bytes(self.whole[path])

    def _answered(self, asked: dict[str, Any]) -> int:
        """How a fork of this process ends that answers."""
        child = os.fork()
        if child:
            return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        code = 1
        try:
            words = os.fdopen(os.dup(2), "w")
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # OpenUSD says much
            signal.setitimer(signal.ITIMER_PROF, SECONDS)
            signal.setitimer(signal.ITIMER_REAL, 12 * SECONDS)
            code = 3 if any("memory" in said for said in isolated.answer(asked)) else 0
        except BaseException:  # noqa: BLE001 - whatever it is, it was not promised
            traceback.print_exc(file=words)
            words.flush()
        finally:
            os._exit(code)


class Bakes(Fuzz):
    """A bake whose files are damaged, and every command on it."""

    def __init__(self, scratch: Path) -> None:
        super().__init__(scratch)
        self.folders = [_baked(scratch / name, name) for name in ("ZIP", "PXR24", "HTJ2K")]

    def attempt(self, chance: random.Random) -> None:
        """One damage, and every command on it."""
        pristine, scratch = chance.choice(self.folders), self.scratch / "damaged"
        shutil.rmtree(scratch, ignore_errors=True)
        home = scratch / pristine.parent.name
        shutil.copytree(pristine.parent, home)
        folder = home / pristine.name
        damage(folder, chance)
        sea = scratch / "sea.json"
        text = json.dumps(json.loads((pristine / "bake.json").read_text())["shot"]).encode()
        sea.write_bytes(mutations.of_json(text, chance))
        self.command("verify", folder)
        self.command("resume", folder, "--frames", "1-2", "--workers", "1", "--take-over")
        with contextlib.suppress(ParameterError, UnicodeDecodeError):
            if _is_small(Shot.from_json(sea.read_text()).parameters):
                self.command("info", "--params", sea)
        self.command("clean", folder)


def _baked(place: Path, compression: str) -> Path:
    place.mkdir(exist_ok=True)
    sea = write_sea(place / "sea.json", resolution=16)
    arguments = ["--frames", "1-2", "--maps", "disp,vel", "--compression", compression, "--workers", "1"]
    with contextlib.redirect_stdout(io.StringIO()):
        assert main(["bake", "--params", str(sea), "--out", str(place / "cache"), *arguments]) == 0
    return only_folder(place / "cache")


def damage(folder: Path, chance: random.Random) -> None:
    """Change one file; often its record vouches for it, so that its contents are looked at."""
    files = sorted(path for path in folder.rglob("*") if path.suffix in (".exr", ".json"))
    images = [path for path in files if path.suffix == ".exr"]
    path = chance.choice(images if chance.random() < 0.5 else files)
    mutated = mutations.of_exr if path.suffix == ".exr" else mutations.of_json
    path.write_bytes(mutated(path.read_bytes(), chance))
    if chance.random() < 0.8:
        vouch(folder, path)
    if chance.random() < 0.1:
        (folder / "bake.json").unlink(missing_ok=True)


def vouch(folder: Path, changed: Path) -> None:
    """Seal a record or job that was changed, and let records tell what images are now."""
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


class Spectra(Fuzz):
    """Files of measured spectra: a buoy's five, and one of a wave model with several places and times."""

    def __init__(self, scratch: Path) -> None:
        super().__init__(scratch)
        self.whole = [path.read_bytes()[:3000].rpartition(b"\n")[0] + b"\n" for path in BUOY_FILES]
        directions = np.arange(5.0, 360.0, 30.0)
        waves = bump(directions, 40.0, True)
        spectra = [waves, "NODATA", "ZERO", waves]
        times = ("20200101.000000", "20200101.060000")
        swan = swan_text(spectra, [(1, 2), (3, 4)], directions=directions, times=times)
        narrow = np.stack([waves.sum(axis=1), np.full(len(F), 200.0), np.full(len(F), 20.0)], axis=1)
        self.whole += [text.encode() for text in (swan, swan_text([narrow], directions=None))]
        read_spectra(self._written(self.whole[:5]))

    def _written(self, contents: Sequence[bytes]) -> list[Path]:
        names = [path.name for path in BUOY_FILES] if len(contents) > 1 else ["sea.spec"]
        paths = [self.scratch / name for name in names]
        for path, content in zip(paths, contents, strict=True):
            path.write_bytes(content)
        return paths

    def attempt(self, chance: random.Random) -> None:
        """Read, and made a sea of: what is read must be one."""
        index = chance.randrange(len(self.whole))
        damaged = mutations.of_text(self.whole[index], chance)
        contents = [*self.whole[:index], damaged, *self.whole[index + 1 : 5]] if index < 5 else [damaged]
        paths = self._written(contents)
        try:
            records = read_spectra(paths)
            sea = measured_sea(chosen_times(chosen_place(records, None), chance.choice((None, "all"))))
        except ParameterError as error:
            if "\n" in str(error):
                raise AssertionError(f"more than a line: {error}") from None
            return
        assert OceanParameters.from_json(sea.to_json()) == sea
        state = spectrum_state(SeaSpectrum(sea))
        assert np.isfinite(state.significant_wave_height), state
        list(sea.layers[0].warnings(sea))


KINDS: dict[str, Callable[[Path], Fuzz]] = {
    "spectra": Spectra,
    "json": Parameters,
    "records": Records,
    "exr": lambda scratch: Images(scratch, ".exr", mutations.of_exr),
    "usd": Usd,
    "png": lambda scratch: Images(scratch, ".png", mutations.of_png),
    "tiff": lambda scratch: Images(scratch, ".tif", mutations.of_tiff),
    "npy": lambda scratch: Images(scratch, ".npy", mutations.of_npy),
    "bake": Bakes,
}


def run(kind: str, scratch: Path, seeds: range) -> int:
    """Try every damage; how many ended otherwise than they must."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    fuzz, failures = KINDS[kind](scratch), 0
    for seed in seeds:
        print(seed, flush=True)
        signal.setitimer(signal.ITIMER_PROF, SECONDS)  # ends the process where something goes on and on
        try:
            fuzz.attempt(random.Random(f"{kind} {seed}"))
        except Exception:  # noqa: BLE001 - whatever it is, it was not promised
            failures += 1
            print(f"{kind}, damage {seed}:\n{traceback.format_exc()[-3000:]}", file=sys.stderr, flush=True)
        if failures >= MOST_FAILURES:
            break
    signal.setitimer(signal.ITIMER_PROF, 0)
    print("done", resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, flush=True)
    return failures


if __name__ == "__main__":
    sys.exit(min(run(sys.argv[1], Path(sys.argv[2]), range(*map(int, sys.argv[3:5]))), 1))
