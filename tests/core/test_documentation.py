# SPDX-License-Identifier: GPL-3.0-or-later
"""The documents say what is there: the functions, tests, parameters, numbers and commands they name."""

from __future__ import annotations

import ast
import re
import shutil
from functools import lru_cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak import cli
from ocean_tweak.core import Ocean, OceanParameters, Water, WaveLayer
from ocean_tweak.core.data.validation import Validated
from ocean_tweak.core.numerics.grid import WaveVectorGrid
from ocean_tweak.core.spectral.directional_spectrum import DirectionalSpectrum
from ocean_tweak.core.synthesis.coefficients import initial_state
from ocean_tweak.core.waves.contribution import Contribution
from ocean_tweak.core.waves.kinds import KINDS
from tools import parameters_doc

ROOT = Path(__file__).resolve().parents[2]
PAPERS = {
    "Horvath (2015)": 62,
    "Chen, Jin and Yin (2014)": 33,
    "Lantz": 4,
    "Mastin, Watterberg and Mareda (1987)": 10,
    "Li and Wang (2016)": 25,
    "Hero waves": 0,
    "Wakes": 0,
    "Foam": 0,
    "Masks": 0,
    "Spray": 0,
    "Riding": 0,
    "Coast": 0,
    "Measured seas": 0,
}


# docs/equations.md


def equations() -> dict[str, list[dict[str, str]]]:
    """Rows of the table under each heading, by column."""
    text = (ROOT / "docs" / "equations.md").read_text(encoding="utf-8")
    tables = {}
    for section in text.split("\n## ")[1:]:
        lines = [line for line in section.splitlines() if line.startswith("|")]
        head, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in lines)
        assert all(len(row) == len(head) for row in rows), "a cell holds a |"
        tables[section.splitlines()[0]] = [dict(zip(head, row, strict=True)) for row in rows]
    return tables


def names(cell: str) -> list[str]:
    return re.findall(r"`([^`]+)`", cell)


@lru_cache
def definitions(path: Path) -> frozenset[str]:
    """Dotted names of what a file defines at its top level and inside its classes."""
    found = set()

    def collect(body: list[ast.stmt], inside: str) -> None:
        for node in body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                found.add(inside + node.name)
            if isinstance(node, ast.ClassDef):
                collect(node.body, f"{inside}{node.name}.")
            for target in [*getattr(node, "targets", []), getattr(node, "target", None)]:
                if isinstance(target, ast.Name):
                    found.add(inside + target.id)

    collect(ast.parse(path.read_text(encoding="utf-8")).body, "")
    return frozenset(found)


def function_exists(name: str) -> bool:
    """Whether a name stands in the core, or with its folders in the package."""
    for place in (ROOT / "ocean_tweak" / "core", ROOT / "ocean_tweak"):
        rest = name.split(".")
        while len(rest) > 1 and (place / rest[0]).is_dir():
            place /= rest.pop(0)
        if (place / f"{rest[0]}.py").exists():
            return ".".join(rest[1:]) in definitions(place / f"{rest[0]}.py")
    return False


def check_exists(name: str) -> bool:
    file, _, function = name.partition("::")
    folder = ROOT / "tests" if "/" in file else ROOT / "tests" / "core"
    return (folder / file).exists() and function in definitions(folder / file)


ROWS = [
    pytest.param(row, id=f"{paper.split()[0]} {row['eq.']} {row['what it is']}")
    for paper, rows in equations().items()
    for row in rows
]


@pytest.mark.parametrize(("paper", "count"), PAPERS.items())
def test_every_numbered_equation_is_listed(paper: str, count: int) -> None:
    numbers = [int(row["eq."]) for row in equations()[paper] if row["eq."].isdecimal()]
    assert sorted(numbers) == list(range(1, count + 1))
    assert set(equations()) == set(PAPERS)


@pytest.mark.parametrize("row", ROWS)
def test_equation_names_what_is_there(row: dict[str, str]) -> None:
    functions, tests, note = names(row["function"]), names(row["test"]), row["as printed?"]
    assert functions or (row["function"] == "–" and note.startswith("left out"))
    assert not (functions and note.startswith("left out"))
    assert note
    assert tests
    assert [name for name in functions if not function_exists(name)] == []
    assert [name for name in tests if not check_exists(name)] == []


def test_what_is_not_there_is_not_found() -> None:
    assert function_exists("spectral.spectra.jonswap")
    assert function_exists("numerics.grid.WaveVectorGrid.kx")
    assert function_exists("scene.grid_mesh.Grid")
    for name in (
        "spectral.spectra.jonswop",
        "spectral.spektra.jonswap",
        "numerics.grid.WaveVectorGrid.kz",
        "scene.grid_mesh.Mesh",
        "spectral.spectra",
    ):
        assert not function_exists(name), name
    assert check_exists("test_spectra.py::test_reference_seas")
    for name in ("test_spectra.py::test_nothing", "test_spektra.py::test_reference_seas", "test_spectra.py"):
        assert not check_exists(name), name


# docs/parameters.md and docs/channels.md


@pytest.mark.parametrize("name", parameters_doc.DOCUMENTS)
def test_tables_are_current(name: str) -> None:
    document = (ROOT / "docs" / name).read_text(encoding="utf-8")
    made = parameters_doc.DOCUMENTS[name]()
    assert parameters_doc.updated(document, made) == document, "out of date: run make docs"


def test_the_table_of_channels_says_where_each_goes() -> None:
    table = parameters_doc.channels()
    assert "| 1 | 1 | `foam` G | `cusp` | `primvars:cusp` |  |" in table
    assert "| 3 | m/s | `vel` RGB | `velocity` | `velocities` | yes |" in table
    assert "| 2 | 1 | `slope` RG | `slope` of patches |  | yes |" in table


def test_every_parameter_stands_in_a_table() -> None:
    document = (ROOT / "docs" / "parameters.md").read_text(encoding="utf-8")
    for field in ("`resolution`", "`surface_tension`", "`peak_enhancement`", "`start_frame`"):
        assert f"| {field} |" in document


def test_every_kind_of_parameters_has_a_table() -> None:
    kinds = {*Validated.__subclasses__(), *KINDS} - {Contribution}
    ours = {kind for kind in kinds if kind.__module__.startswith("ocean_tweak.")}
    assert set(parameters_doc.CLASSES) == ours


def test_tables_are_made_from_the_fields() -> None:
    table = parameters_doc.parameters()
    assert "| `depth` | m | 200 | 0.1 … 11000 | from a puddle to the deepest trench |" in table
    assert "| `fetch` | m | 150000 | 0 … 2e7 |" in table
    assert "| `depth_factor` |  | `KITAIGORODSKII` | `KITAIGORODSKII`, `THOMPSON_VINCENT` |" in table
    assert "| `loop_duration` | s | `null` | 0.01 … 1e6, or `null` |" in table
    with pytest.raises(ValueError, match="marks"):
        parameters_doc.updated("no marks", "")


def sea(**layer: object) -> OceanParameters:
    return OceanParameters(resolution=16, water=Water(depth=11e3), layers=(WaveLayer(**layer),))  # type: ignore[arg-type]


def wave_height(**layer: object) -> float:
    return Ocean(sea(**layer)).statistics().significant_wave_height


def test_heights_told_in_the_parameters() -> None:
    """Hs 2.14 m where Wilson has 1.49, 2.13 and 0.73 m for 5 m/s without and with the end of growth."""
    assert wave_height(wind_speed=10.0, fetch=100e3) == pytest.approx(2.14, abs=0.005)
    X = 9.81 * 100e3 / 10.0**2
    # Wilson (1965): g Hs / U² = 0.30 (1 - (1 + 0.004 √X)⁻²)
    assert 0.30 * 10.0**2 / 9.81 * (1 - (1 + 0.004 * np.sqrt(X)) ** -2) == pytest.approx(1.49, abs=0.005)
    assert 4 * np.sqrt(1.6e-7 * X) * 10.0**2 / 9.81 == pytest.approx(1.62, abs=0.005)
    assert wave_height(wind_speed=5.0, fetch=300e3, limit_fetch=False) == pytest.approx(2.13, abs=0.005)
    assert wave_height(wind_speed=5.0, fetch=300e3) == pytest.approx(0.73, abs=0.005)
    for wind, end in ((5.0, 43e3), (10.0, 174e3), (20.0, 695e3)):
        before, at, after = (wave_height(wind_speed=wind, fetch=f * end) for f in (0.95, 1.02, 3.0))
        assert before < 0.99 * at
        assert at == after


def test_cells_told_in_the_parameters() -> None:
    """17 m/s over 300 km on 200 m: sampled 1.70 and 0.83 of the energy, averaged 0.995 and 0.992."""
    grid = WaveVectorGrid(256, 200.0)
    row, column = np.nonzero(grid.usable)
    kx, ky = grid.kx[0, column], grid.ky[row, 0]
    for direction, sampled, averaged in ((0.0, 1.70, 0.995), (np.pi / 4, 0.83, 0.992)):
        layer = WaveLayer(wind_speed=17.0, fetch=300e3, swell=0.0, wind_direction=direction)
        m0 = Ocean(OceanParameters(resolution=16, layers=(layer,))).statistics().m0
        spectrum = DirectionalSpectrum(layer, Water(), "CAPILLARY")
        samples = 0.5 * (spectrum.density(kx, ky) + spectrum.density(-kx, -ky)) * grid.multiplicity[0, column]
        means = 0.5 * np.add(*spectrum.cell_means(grid)) * grid.multiplicity
        assert np.sum(samples) * grid.cell_area / m0 == pytest.approx(sampled, abs=0.005)
        assert np.sum(means) * grid.cell_area / m0 == pytest.approx(averaged, abs=0.001)


@pytest.mark.parametrize(("wavelengths", "scatter"), [(1, 0.34), (3, 0.16), (10, 0.05)])
def test_scatter_told_in_the_parameters(wavelengths: int, scatter: float) -> None:
    """Hs of a hundred seeds: their relative scatter is known to 7 % of itself."""
    base = OceanParameters(resolution=max(32, 8 * wavelengths))
    domain = wavelengths * Ocean(base).statistics().peak_wavelength
    heights = []
    for seed in range(100):
        state = initial_state(base.replace(domain_size=domain, seed=seed))
        energy = (np.abs(state.h_plus) ** 2 + np.abs(state.h_minus) ** 2) * state.grid.multiplicity
        heights.append(np.sqrt(np.sum(energy)))
    assert np.std(heights) / np.mean(heights) == pytest.approx(scatter, rel=0.2)


# README.md, CONTRIBUTING.md and docs/command-line.md


README = (ROOT / "README.md").read_text(encoding="utf-8")
CONTRIBUTING = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
COMMAND_LINE = (ROOT / "docs" / "command-line.md").read_text(encoding="utf-8")


def blocks(language: str, text: str = README) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def test_the_readme_is_short() -> None:
    assert len(README.splitlines()) <= 120


def test_python_of_the_readme_runs(capsys: pytest.CaptureFixture[str]) -> None:
    (block,) = blocks("python")
    exec(compile(block, "README.md", "exec"), {})
    height, shape = capsys.readouterr().out.splitlines()
    assert re.fullmatch(r"Hs \d\.\d\d m", height)
    assert shape == "(256, 256, 3)"


COMMANDS = [
    line.split()[3:]
    for block in [*blocks("sh"), *blocks("sh", COMMAND_LINE)]
    for line in block.splitlines()
    if "-m ocean_tweak" in line
]


def few(frames: str) -> str:
    """Frames as a command has them, of each range the first four."""
    return re.sub(r"(\d+)-\d+", lambda found: f"{found[1]}-{int(found[1]) + 3}", frames)


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_commands_run(command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copytree(ROOT / "examples", tmp_path / "examples", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.chdir(tmp_path)
    told = [few(word) if before == "--frames" else word for before, word in pairwise(["", *command])]
    assert cli.main([*told, "--set", "resolution=16"]) == 0
    if command[0] == "bake":
        assert list((tmp_path / "sea").glob("*/v*/*_disp.*.exr"))


def test_links_of_the_readme_lead_somewhere() -> None:
    links = [link for link in re.findall(r"\]\(([^)]+)\)", README + CONTRIBUTING) if "://" not in link]
    assert len(links) > 3
    assert [link for link in links if not (ROOT / link).exists()] == []


def test_every_make_target_is_listed() -> None:
    targets = set(
        re.findall(r"^([a-z-]+):.*##", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
    )
    assert targets == set(re.findall(r"^\| `make ([a-z-]+)`", CONTRIBUTING, re.MULTILINE))


def test_what_docstrings_name_by_its_room_is_there() -> None:
    package = ROOT / "ocean_tweak"
    pattern = re.compile(r"`((?:core|export|nodes|scene|ui|cli)\.[a-z_.]+[A-Za-z_]*)`")
    named = [
        name for path in package.rglob("*.py") for name in pattern.findall(path.read_text(encoding="utf-8"))
    ]
    assert len(named) > 10
    modules = {name for name in named if package.joinpath(*name.split(".")).with_suffix(".py").exists()}
    assert [name for name in named if name not in modules and not function_exists(name)] == []
