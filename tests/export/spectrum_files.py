# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of spectra as tests write them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

BUOY = Path(__file__).resolve().parents[2] / "examples" / "buoy"
BUOY_FILES = [BUOY / f"41010.{kind}" for kind in ("data_spec", "swdir", "swdir2", "swr1", "swr2")]

F = np.geomspace(0.05, 0.5, 20)


def swan_text(
    spectra: Sequence[object],
    places: Sequence[tuple[float, float]] = ((0.0, 0.0),),
    f: np.ndarray = F,
    directions: np.ndarray | None = None,
    times: Sequence[str] = ("20200101.000000",),
    nautical: bool = True,
    frequencies: str = "AFREQ",
    unit: str = "m2/Hz/degr",
    location: str = "LOCATIONS",
) -> str:
    """A file of SWAN: a spectrum (frequencies, directions) in its unit, "ZERO" or "NODATA" for each place of
    each time; of S(f) with direction and spread (frequencies, 3) where there are no directions.
    """
    lines = ["SWAN   1", "$ written by a test"]
    lines += ["TIME", "  1"] if times else []
    lines += [location, f" {len(places)}", *(f" {x} {y}" for x, y in places)]
    lines += [frequencies, f" {len(f)}", *(f" {each:.6f}" for each in f)]
    heading = "NDIR" if nautical else "CDIR"
    if directions is not None:
        lines += [heading, f" {len(directions)}", *(f" {each:.4f}" for each in directions)]
        lines += ["QUANT", " 1", "VaDens", unit, " -0.9900E+02"]
    else:
        lines += ["QUANT", " 3", "VaDens", unit, " -99", heading, "degr", " -999", "DSPRDEGR", "degr", " -9"]
    rest = iter(spectra)
    for time in times or ("",):
        lines += [time] if time else []
        for number, _ in enumerate(places, 1):
            spectrum = next(rest)
            if isinstance(spectrum, str):
                lines.append(spectrum)
                continue
            values = np.asarray(spectrum)
            if directions is None:
                lines += [f"LOCATION {number}", *(" ".join(f"{v:.6g}" for v in row) for row in values)]
                continue
            factor = max(values.max(), 1e-12) / 99999
            whole = np.rint(values / factor).astype(int)
            lines += ["FACTOR", f" {factor:.9e}", *(" ".join(map(str, row)) for row in whole)]
    return "\n".join(lines) + "\n"


def bump(
    directions: np.ndarray, towards: float, nautical: bool, height: float = 2.0, s: float = 12.0
) -> np.ndarray:
    """(frequencies, directions) m²/Hz/degr with a height Hs in m, around a direction in degrees towards,
    counter-clockwise from east.
    """
    theta = 270.0 - directions if nautical else directions
    spread = np.cos(np.radians(theta - towards) / 2.0) ** (2.0 * s)
    shape = np.exp(-((np.log(F / 0.12) / 0.35) ** 2))[:, np.newaxis] * spread
    step = 360.0 / len(directions)
    return shape * (height / 4.0) ** 2 / (np.sum(np.gradient(F)[:, np.newaxis] * shape) * step)


def historical(kind: str, rows: Sequence[tuple[str, np.ndarray]], f: np.ndarray = F) -> str:
    """One of NDBC's historical files; r in hundredths."""
    head = "#YY  MM DD hh mm " + " ".join(f"{each:.4f}" for each in f)
    scale = 100.0 if kind in "jk" else 1.0
    lines = [f"{time} " + " ".join(f"{value * scale:.2f}" for value in values) for time, values in rows]
    return "\n".join([head, *lines]) + "\n"


def write_buoy(folder: Path, station: str = "41001", missing: str = "", scale: float = 1.0) -> list[Path]:
    """Five historical files of two hours, the later first. Waves come from 300°, and from 120° later on.

    missing : letters of files that are left out
    """
    energy = scale * np.exp(-((np.log(F / 0.12) / 0.35) ** 2))
    ones = np.ones(len(F))
    rows = {
        "w": [("2020 01 01 01 00", 4.0 * energy), ("2020 01 01 00 00", energy)],
        "d": [("2020 01 01 01 00", 120.0 * ones), ("2020 01 01 00 00", 300.0 * ones)],
        "i": [("2020 01 01 01 00", 120.0 * ones), ("2020 01 01 00 00", 300.0 * ones)],
        "j": [("2020 01 01 01 00", 0.8 * ones), ("2020 01 01 00 00", 0.9 * ones)],
        "k": [("2020 01 01 01 00", 0.5 * ones), ("2020 01 01 00 00", 0.7 * ones)],
    }
    paths = []
    for kind, own in rows.items():
        if kind not in missing:
            paths.append(folder / f"{station}{kind}2020.txt")
            paths[-1].write_text(historical(kind, own))
    return paths
