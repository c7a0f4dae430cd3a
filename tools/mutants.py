# SPDX-License-Identifier: GPL-3.0-or-later
"""What `make mutate` changes in the core: constants, formulas, structure, and a few things by name.

A mutant is the source of one file with one change. Each is tried in a copy and a process of its own, so that
no cache holds what another, or the unchanged program, has made.
"""

from __future__ import annotations

import ast
import hashlib
import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from .project import ToolError

CORE = Path("ocean_tweak/core")
CONSTANTS = CORE / "spectral" / "constants.py"
LARGER = CORE / "larger_by_five_percent.py"
FACTOR = 1.02

#: goes into the copy: a function that it decorates gives 1.05 of what it gave
LARGER_SOURCE = """
import dataclasses, functools
import numpy as np

def scaled(value):
    if isinstance(value, (float, np.floating, np.complexfloating)):
        return value * 1.05
    if isinstance(value, np.ndarray):
        return value * value.dtype.type(1.05) if value.dtype.kind in "fc" else value
    if isinstance(value, tuple):
        parts = [scaled(part) for part in value]
        return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    if isinstance(value, dict):
        return {key: scaled(part) for key, part in value.items()}
    if dataclasses.is_dataclass(value):
        numbers = {f.name: scaled(getattr(value, f.name)) for f in dataclasses.fields(value) if f.init}
        return dataclasses.replace(value, **numbers)
    if isinstance(getattr(value, "_fields", None), dict):  # SurfaceFields
        value._fields = scaled(value._fields)
    return value

def larger(function):
    @functools.wraps(function)
    def changed(*arguments, **named):
        result = function(*arguments, **named)
        if result is not None:
            return scaled(result)
        for array in (*arguments, *named.values()):  # what was filled
            if isinstance(array, np.ndarray) and array.dtype.kind in "fc":
                array *= array.dtype.type(1.05)
    return changed
"""


@dataclass(frozen=True)
class Mutant:
    """One change.

    name : what is changed into what; the same while the code around it moves
    path : of the file, below the project
    source : the whole file with the change
    tests : of the core, which are run first: those that say they check it
    """

    name: str
    path: Path
    source: str
    tests: tuple[str, ...] = ()


@dataclass(frozen=True)
class Constant:
    """A number in the source: where it stands, and what it is."""

    name: str
    value: float
    line: int
    start: int
    end: int


def constants(source: str) -> list[Constant]:
    """Return every `NAME = number` at the top level of a module."""
    found = []
    for statement in ast.parse(source).body:
        if not isinstance(statement, ast.Assign) or not isinstance(statement.targets[0], ast.Name):
            continue
        value = ast.literal_eval(statement.value)
        node = statement.value
        if node.end_lineno != node.lineno or node.end_col_offset is None:
            raise ToolError(f"line {node.lineno}: a constant must stand on one line")
        name = statement.targets[0].id
        found.append(Constant(name, value, node.lineno, node.col_offset, node.end_col_offset))
    return found


def changed(source: str, constant: Constant) -> str:
    """Return the source with the constant times `FACTOR`."""
    return _replaced(source, constant, f"{constant.value * FACTOR:.12g}")


def _replaced(source: str, place: Constant, text: str) -> str:
    lines = source.splitlines(keepends=True)
    line = lines[place.line - 1].encode()  # ast counts bytes
    lines[place.line - 1] = (line[: place.start] + text.encode() + line[place.end :]).decode()
    return "".join(lines)


def of_constants(root: Path) -> Iterator[Mutant]:
    """Each physical constant, 2 % larger."""
    source = (root / CONSTANTS).read_text(encoding="utf-8")
    for constant in constants(source):
        name = f"constant {constant.name} {constant.value:g} -> {constant.value * FACTOR:g}"
        yield Mutant(name, CONSTANTS, changed(source, constant))


def of_formulas(root: Path) -> Iterator[Mutant]:
    """Each function that docs/equations.md names, with 1.05 of what it returns; its tests stand there too."""
    tests: dict[str, list[str]] = {}
    for line in (root / "docs" / "equations.md").read_text(encoding="utf-8").splitlines():
        cells = [re.findall(r"`([^`]+)`", cell) for cell in line.strip("|").split("|")]
        if line.startswith("|") and len(cells) == 5:
            for function in cells[2]:
                tests.setdefault(function, []).extend(test for test in cells[3] if "/" not in test)
    for function, named in tests.items():
        found = _definition(root, function)
        if found is not None and _gives_numbers(found[1]):
            path, node, source = found
            lines = source.splitlines(keepends=True)
            module = ".".join(LARGER.with_suffix("").parts)
            lines.insert(
                node.lineno - 1, f'{" " * node.col_offset}@__import__("{module}", fromlist=["*"]).larger\n'
            )
            yield Mutant(f"formula {function} x 1.05", path, "".join(lines), tuple(dict.fromkeys(named)))


def _gives_numbers(function: ast.FunctionDef) -> bool:
    """Whether it returns something, or fills an array that it is given."""
    if function.returns is None or ast.unparse(function.returns) != "None":
        return True
    annotations = [ast.unparse(a.annotation) for a in function.args.args if a.annotation is not None]
    return any(re.fullmatch(r"\w*Array(\[.*\])?", annotation) for annotation in annotations)


def _definition(root: Path, name: str) -> tuple[Path, ast.FunctionDef, str] | None:
    """The file, the function and the source of a dotted name below the core; None for what is no function."""
    parts, path = name.split("."), CORE
    while len(parts) > 1 and (root / path / parts[0]).is_dir():
        path /= parts.pop(0)
    path /= f"{parts.pop(0)}.py"
    if not (root / path).exists():
        return None
    source = (root / path).read_text(encoding="utf-8")
    body: list[ast.stmt] = ast.parse(source).body
    for part in parts:
        node = next(
            (n for n in body if isinstance(n, ast.FunctionDef | ast.ClassDef) and n.name == part), None
        )
        if isinstance(node, ast.FunctionDef):
            return path, node, source
        body = node.body if node is not None else []
    return None


#: operators that are taken for each other
_SWAPS: dict[type, tuple[type, str, str]] = {
    ast.Add: (ast.Sub, "+", "-"), ast.Sub: (ast.Add, "-", "+"),
    ast.Mult: (ast.Div, "*", "/"), ast.Div: (ast.Mult, "/", "*"),
    ast.Lt: (ast.LtE, "<", "<="), ast.LtE: (ast.Lt, "<=", "<"),
    ast.Gt: (ast.GtE, ">", ">="), ast.GtE: (ast.Gt, ">=", ">"),
}  # fmt: skip
_NAMES = {"maximum": "minimum", "minimum": "maximum", "max": "min", "min": "max", "cos": "sin", "sin": "cos"}


def of_structure(root: Path, count: int, seed: int) -> Iterator[Mutant]:
    """A sample of operators, bounds and functions of the core that are taken for their neighbours.

    It is drawn by a hash of each change's name: where code stays, the sample does too.
    """
    files = sorted(path for path in (root / CORE).rglob("*.py") if path != root / CONSTANTS)
    found = [mutant for path in files for mutant in _changes(path.relative_to(root), path.read_text("utf-8"))]
    found.sort(key=lambda mutant: hashlib.sha256(f"{seed} {mutant.name}".encode()).digest())
    for mutant in found[:count]:
        yield replace(mutant, tests=_tests_of(root, mutant.path))


def _tests_of(root: Path, path: Path) -> tuple[str, ...]:
    """The test files that import a module of the core by its name."""
    imports = re.compile(rf"import [^\n]*\b{path.stem}\b|core(\.\w+)*\.{path.stem} import")
    files = sorted((root / "tests" / "core").glob("test_*.py"))
    return tuple(file.name for file in files if imports.search(file.read_text(encoding="utf-8")))


def _changes(path: Path, source: str) -> Iterator[Mutant]:
    module = ".".join(path.relative_to(CORE).with_suffix("").parts)
    for function in (node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef)):
        for node in ast.walk(ast.Module(function.body, [])):
            for place, text in _swapped(source, node):
                before = ast.get_source_segment(source, node) or ""
                where = f"{module}.{function.name}: {' '.join(before.split())[:60]}"
                yield Mutant(
                    f"structure {where}: {place.name} -> {text}", path, _replaced(source, place, text)
                )


def _swapped(source: str, node: ast.AST) -> Iterator[tuple[Constant, str]]:
    """Where and by what a node's operator or function is replaced; on one line, where it can be found."""
    if isinstance(node, ast.BinOp) and type(node.op) in _SWAPS:
        yield from _between(source, node.left, node.right, _SWAPS[type(node.op)])
    elif isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _SWAPS:
        yield from _between(source, node.left, node.comparators[0], _SWAPS[type(node.ops[0])])
    elif isinstance(node, ast.Call):
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        end = node.func.end_col_offset
        if name in _NAMES and node.func.lineno == node.func.end_lineno and end is not None:
            yield Constant(name, 0.0, node.func.lineno, end - len(name), end), _NAMES[name]


def _between(
    source: str, left: ast.expr, right: ast.expr, swap: tuple[type, str, str]
) -> Iterator[tuple[Constant, str]]:
    _, operator, other = swap
    if left.end_lineno != right.lineno or left.end_col_offset is None:
        return
    line = source.splitlines()[right.lineno - 1].encode()
    between = line[left.end_col_offset : right.col_offset].decode()
    if between.count(operator) == 1:
        start = left.end_col_offset + len(between[: between.index(operator)].encode())
        yield Constant(operator, 0.0, right.lineno, start, start + len(operator.encode())), other


#: file, what stands there, what takes its place: each of them went unnoticed once
NAMED = (
    ("spectral/spectra.py", "PM_BETA, omega_p, 1.0, U", "PM_BETA * 1.05, omega_p, 1.0, U"),
    ("spectral/spectra.py", "layer.generalized_a / g**2", "1.05 * layer.generalized_a / g**2"),
    ("spectral/spectra.py", "(layer.generalized_b /", "(1.05 * layer.generalized_b /"),
    ("spectral/spectra.py", "peak_enhancement, U * omega_p", "peak_enhancement, 1.1 * U * omega_p"),
    ("spectral/spectra.py", "PM_ALPHA, omega_p, 1.0, U", "PM_ALPHA, omega_p, 1.0, 1.1 * U"),
    ("spectral/spectra.py", "PM_BETA, omega_p, 1.0, U", "PM_BETA, omega_p, 1.0, 1.1 * U"),
    ("spectral/spectra.py", "/ g**2, omega_p, 1.0, U", "/ g**2, omega_p, 1.0, 1.1 * U"),
    ("waves/spectral.py", "Wind(wind_at_10_m(self.wind_speed, self.wind_height)", "Wind(self.wind_speed"),
    ("spectral/spectra.py", "_over(constants.DEVELOPMENT**-", "_over(1.05 * constants.DEVELOPMENT**-"),
    ("statistics/sea_statistics.py", "_LARGEST_SPEED_CHANGE = 0.1", "_LARGEST_SPEED_CHANGE = 0.105"),
    ("sea/query.py", "_STEPS = 40", "_STEPS = 8"),
    ("sea/memory.py", "_TEMPORARY_ARRAYS = 5", "_TEMPORARY_ARRAYS = 1"),
)


def of_names(root: Path) -> Iterator[Mutant]:
    """Those in NAMED. Raises ToolError where one is not in its file any more."""
    for file, before, after in NAMED:
        source = (root / CORE / file).read_text(encoding="utf-8")
        if source.count(before) != 1:
            raise ToolError(f"{CORE / file} does not hold {before!r} once: mend NAMED in tools/mutants.py")
        mutated = source.replace(before, after)
        tests = _tests_of(root, CORE / file)
        yield Mutant(f"named {file}: {before} -> {after}", CORE / file, mutated, tests)


def chosen(root: Path, kinds: Collection[str], sample: int, seed: int) -> list[Mutant]:
    """All mutants of the kinds that are asked for."""
    makers = {
        "constants": lambda: of_constants(root),
        "formulas": lambda: of_formulas(root),
        "named": lambda: of_names(root),
        "structure": lambda: of_structure(root, sample, seed),
    }
    return [mutant for kind, make in makers.items() if kind in kinds for mutant in make()]
