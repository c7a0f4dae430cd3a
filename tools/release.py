# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds what is published, into build/release/, and checks what reviewers check: `make release`.

One zip for all platforms, one for each, and notes with sizes and hashes. Nothing is published from here.
`make release WEBSITE=https://…` writes the page of support into the zips' manifests: forks have their own.
"""

from __future__ import annotations

import argparse
import ast
import hashlib
import json
import re
import shutil
import sys
import tomllib
import zipfile
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from . import build, real_blender, wheels
from .project import BUILD, ROOT, ToolError

FOLDER = BUILD / "release"

#: kinds of files that the zip may hold beside the wheels: no binaries but pictures
KINDS = {".py", ".json", ".jpg", ".js", ".md", ".toml", ".typed", ""}
#: modules that reach the network
NETWORK = {"asyncio", "ftplib", "http", "imaplib", "requests", "smtplib", "socket", "ssl", "urllib", "xmlrpc"}
#: by file, what is used for something else
NO_NETWORK = {
    "cli/stopping.py": {"socket"},  # a pair within the process, which a signal wakes
}
#: never run by Blender: `python -m ocean_tweak`, outside it
_OUTSIDE_BLENDER = {"__main__.py"}

NO_WEBSITE = "without a website in the manifest, which extensions.blender.org asks for: `make release WEBSITE=https://…`"

#: letters of a tagline and of a permission's reason (extensions.blender.org)
_MOST_LETTERS = 64


def main() -> int:
    """Build and check; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tools.release")
    parser.add_argument("--website", default="", help="address of the page of support, for the manifest")
    website = parser.parse_args().website
    faults = [
        *manifest_faults(wheels.manifest()),
        *website_faults(website),
        *code_faults(ROOT / "ocean_tweak"),
    ]
    try:
        zips = _build(real_blender.find(), website)
        for path in zips:
            faults += zip_faults(path)
        notes = FOLDER / "notes.md"
        notes.write_text(release_notes(zips, wheels.manifest()["version"]), encoding="utf-8")
    except (real_blender.NoBlender, ToolError) as error:
        print(f"release failed: {error}", file=sys.stderr)
        return 1
    for fault in faults:
        print(f"release failed: {fault}", file=sys.stderr)
    if not faults:
        told = f"website {website}" if website else NO_WEBSITE
        print(f"release: {len(zips)} zips and {notes.relative_to(ROOT)}; {told}")
    return 1 if faults else 0


def _build(blender: real_blender.RealBlender, website: str) -> list[Path]:
    """The zip for all platforms, then one for each."""
    whole = build.build(blender)
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    shutil.copy2(whole, FOLDER)
    build.extension(blender, "build", "--split-platforms", "--output-dir", str(FOLDER))
    for path in FOLDER.glob("*.zip"):
        if website:
            put_website(path, website)
        build.extension(blender, "validate", str(path))
    zips = sorted(FOLDER.glob("*.zip"), key=lambda path: (path.name != whole.name, path.name))
    expected = 1 + len(wheels.manifest()["platforms"])
    if len(zips) != expected:
        raise ToolError(
            f"{len(zips)} zips were built, not {expected}: {', '.join(path.name for path in zips)}"
        )
    return zips


def manifest_faults(manifest: dict) -> Iterator[str]:
    """What of a manifest a reviewer would send back."""
    for name, text in {"tagline": manifest["tagline"], **manifest.get("permissions", {})}.items():
        if not 0 < len(text) <= _MOST_LETTERS or not text[-1].isalnum():
            reason = f"must have 1 to {_MOST_LETTERS} letters and no full stop"
            yield f"blender_manifest.toml: {name} = {text!r}: {reason}"
    if "network" in manifest.get("permissions", {}):
        yield "blender_manifest.toml: permissions.network: this extension works offline"
    if not re.fullmatch(r"\d+\.\d+\.\d+", manifest["version"]):
        yield f"blender_manifest.toml: version = {manifest['version']!r}: must be three numbers"


def website_faults(website: str) -> Iterator[str]:
    """What is wrong with the address of a website; nothing where there is none."""
    if website and not re.fullmatch(r"https://[^\s/.]+\.\S+", website):
        yield f"WEBSITE = {website!r}: must be an address that begins with https://"


def put_website(path: Path, website: str) -> None:
    """Write a website into the manifest of a zip, whose other files stay as they are.

    Raises ToolError for a manifest that has one.
    """
    new = path.with_suffix(".new")
    with zipfile.ZipFile(path) as source, zipfile.ZipFile(new, "w") as target:
        for info in source.infolist():
            content = source.read(info)
            if info.filename == "blender_manifest.toml":
                text = content.decode("utf-8")
                if "website" in tomllib.loads(text):
                    raise ToolError(f"{path.name} has a website in its manifest already: leave WEBSITE away")
                content = f"website = {json.dumps(website)}\n{text}".encode()
            target.writestr(info, content)
    new.replace(path)


def code_faults(package: Path) -> Iterator[str]:
    """What the package's code does that no extension may: reach the network, or change where Python looks."""
    for path in sorted(package.rglob("*.py")):
        name = path.relative_to(package).as_posix()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            for module in sorted(_imported(node) & NETWORK - NO_NETWORK.get(name, set())):
                yield f"ocean_tweak/{name}:{node.lineno}: imports {module}, which reaches the network"
            if name not in _OUTSIDE_BLENDER and _changes_path(node):
                yield f"ocean_tweak/{name}:{node.lineno}: changes sys.path"


def _imported(node: ast.AST) -> set[str]:
    """Top-level names of the modules that a statement imports."""
    if isinstance(node, ast.Import):
        return {alias.name.partition(".")[0] for alias in node.names}
    if isinstance(node, ast.ImportFrom) and node.level == 0:
        return {(node.module or "").partition(".")[0]}
    return set()


def _changes_path(node: ast.AST) -> bool:
    """Whether `sys.path` is assigned, deleted from, or changed by one of its methods."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        return ast.unparse(node.func.value) == "sys.path"
    targets = [*getattr(node, "targets", []), getattr(node, "target", None)]
    return any(
        isinstance(target, ast.expr) and ast.unparse(target).startswith("sys.path")
        for target in targets
        if not isinstance(node, (ast.comprehension, ast.For))
    )


def zip_faults(path: Path) -> Iterator[str]:
    """What a zip holds that it must not."""
    notices = (ROOT / "NOTICES.md").read_text(encoding="utf-8")
    listed = re.findall(r"^\| `([^`]+)`", notices, re.MULTILINE)
    with zipfile.ZipFile(path) as file:
        names = [PurePosixPath(name) for name in file.namelist() if not name.endswith("/")]
    for name in names:
        if name.parts[0] == "wheels" and name.suffix == ".whl":
            continue
        if name.suffix not in KINDS:
            yield f"{path.name} holds {name}: no file of that kind belongs into it"
        if name.suffix == ".jpg" and not any(name.match(pattern) for pattern in listed):
            yield f"{path.name} holds {name}, which NOTICES.md does not list"
    for wanted in ("LICENSE", "NOTICES.md", "blender_manifest.toml"):
        if PurePosixPath(wanted) not in names:
            yield f"{path.name} lacks {wanted}"


def release_notes(zips: list[Path], version: str) -> str:
    """What CHANGELOG.md tells of a version, and the files. Raises ToolError where it tells nothing."""
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    section = re.search(
        rf"^## \[{re.escape(version)}\].*?\n(.*?)(?=^## |\Z)", changelog, re.MULTILINE | re.DOTALL
    )
    if section is None:
        raise ToolError(
            f"CHANGELOG.md has no section [{version}]: write it, or correct the manifest's version"
        )
    rows = [f"| `{path.name}` | {path.stat().st_size / 1e6:.1f} MB | `{_sha256(path)}` |" for path in zips]
    table = "\n".join(["| file | size | SHA-256 |", "|---|---|---|", *rows])
    return f"# Ocean Tweak {version}\n\n{table}\n\n{section[1].strip()}\n"


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


if __name__ == "__main__":
    sys.exit(main())
