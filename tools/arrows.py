# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds how a layer of `ocean_tweak` reaches one above it without an import: part of `make lint`.

Imports are the import linter's. It does not see a module that is imported by its name in a string, another
module that is started as a process, or an operator that is called.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator

from .unused import PACKAGE, ROOT, read_package

#: from the lowest; those in one row do not know each other
LAYERS = (("core",), ("nodes", "export"), ("scene",), ("ui", "cli"), ("registration",))
#: operators of these begin with the extension's own name, or are its own
_OPERATORS = re.compile(r"bpy\.ops\.(ocean\.|\w+\.ocean_tweak)")
_IMPORTERS = ("import_module", "run_module", "__import__")
#: starts a module of the package as a process
_STARTS = "module_command"

#: what looks like an arrow → why it is none
ALLOWED = {
    ("export.usd.library", "import_module"): "OpenUSD's modules, which may not be there",
}


def main() -> int:
    """Print what reaches up; return 1 where anything does."""
    found = [
        (module, line, text)
        for module, tree in read_package(ROOT / PACKAGE).items()
        for line, text in arrows(module, tree)
    ]
    for module, line, text in found:
        print(f"{PACKAGE}.{module}:{line}: {text}")
    return 1 if found else 0


def arrows(module: str, tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Line and text of each arrow that leads from a module to a layer above, or to nobody knows where."""
    above = _above(module)
    if not above:
        return
    named = re.compile(rf"(?:{PACKAGE})?\.?(?:{'|'.join(above)})(?:\.\w+)*\.?")
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            if "." in node.value and named.fullmatch(node.value):
                yield node.lineno, f"{node.value!r} names a module above: move the code, or pass it down"
        elif isinstance(node, ast.Call):
            yield from _call(module, node)


def _above(module: str) -> list[str]:
    """The layers above that of a module; none above those that may know all."""
    place = next((number for number, row in enumerate(LAYERS) if module.split(".")[0] in row), len(LAYERS))
    return [layer for row in LAYERS[place + 1 :] for layer in row]


def _call(module: str, node: ast.Call) -> Iterator[tuple[int, str]]:
    called = ast.unparse(node.func)
    name = called.rpartition(".")[2]
    if name in _IMPORTERS and (module, name) not in ALLOWED:
        yield node.lineno, f"{called} imports what no linter sees: import it, or pass it down"
    if name == _STARTS and not module.startswith("cli") and ast.unparse(node.args[0]) != "__name__":
        yield node.lineno, f"{called} starts another module than this one: let whoever knows it pass it down"
    if _OPERATORS.match(f"{called}.") and not module.startswith("ui"):
        yield node.lineno, f"{called} is an operator of the layer above: call what it calls"


if __name__ == "__main__":
    sys.exit(main())
