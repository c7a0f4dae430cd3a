# SPDX-License-Identifier: GPL-3.0-or-later
import ast
import sys

from tools.project import ROOT


def imported(path):
    """The top-level names of what a file imports, at any depth of its code, relative imports aside."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield node.module.split(".")[0]


def test_core_imports_the_standard_library_and_numpy_alone():
    files = sorted((ROOT / "ocean_tweak" / "core").rglob("*.py"))
    assert files
    foreign = {f"{file.name}: {name}" for file in files for name in imported(file)}
    allowed = {*sys.stdlib_module_names, "numpy"}
    assert {line for line in foreign if line.split(": ")[1] not in allowed} == set()


def test_extension_imports_itself_relatively():
    # installed it is bl_ext.<repository>.ocean_tweak.ocean_tweak: an absolute import finds another or none
    files = [ROOT / "__init__.py", *sorted((ROOT / "ocean_tweak").rglob("*.py"))]
    assert [str(file) for file in files if "ocean_tweak" in imported(file)] == []


def test_door_of_the_extension_imports_nothing_when_it_is_read():
    tree = ast.parse((ROOT / "__init__.py").read_text())
    assert not [node for node in tree.body if not isinstance(node, (ast.FunctionDef, ast.Expr))]


def test_every_source_file_has_its_licence():
    files = [
        *ROOT.glob("*.py"),
        *(f for d in ("ocean_tweak", "tools", "tests") for f in (ROOT / d).rglob("*.py")),
    ]
    header = "# SPDX-License-Identifier: GPL-3.0-or-later"
    assert [str(file) for file in files if header not in file.read_text()[:200]] == []
