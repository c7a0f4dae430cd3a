# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays in files: whole, cut off, changed, of others, and more than there is room for."""

from __future__ import annotations

import json
import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from ocean_tweak.core import ParameterError
from ocean_tweak.core.numerics.memo import MEMO
from ocean_tweak.export.python_process import environment
from ocean_tweak.export.shelf import ArrayFiles, nothing_kept, use_cache, use_environment, use_folder

ROOT = Path(__file__).parents[2]
ARRAYS = (
    np.arange(5),
    (np.arange(12) + 1j * np.arange(12)[::-1]).astype(np.complex64).reshape(3, 4),
    np.zeros((0, 4), np.complex64),
)


#: as it is told of an array of no numbers
NOTHING = {"shape": [0], "kind": "<i8", "sum": 0}


@pytest.fixture
def shelf(tmp_path: Path) -> ArrayFiles:
    kept = ArrayFiles(tmp_path / "made with the first")
    kept.keep("name", ARRAYS)
    return kept


def file_of(shelf: ArrayFiles) -> Path:
    (path,) = shelf.folder.iterdir()
    return path


def test_what_is_kept_is_found_by_its_name_alone(shelf: ArrayFiles) -> None:
    found = shelf.find("name")
    assert found is not None
    for array, expected in zip(found, ARRAYS, strict=True):
        assert array.dtype == expected.dtype
        assert_array_equal(array, expected)
    assert shelf.find("another name") is None


def changed(content: bytes, place: int) -> bytes:
    return content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda content: content[:-1], "135 bytes instead of 136 bytes"),
        (lambda content: content + b"0", "137 bytes instead of 136 bytes"),
        (lambda content: content[:40], "does not say what it holds"),
        (lambda content: b"", "is no file of Ocean Tweak's arrays"),
        (lambda content: pickle.dumps(ARRAYS), "is no file of Ocean Tweak's arrays"),
        (lambda content: changed(content, len(content) - 3), "other numbers than were written"),
        (lambda content: content.replace(b"<i8", b"|O8"), "holds what no waves are"),
        (lambda content: content.replace(b"[5]", b"[-5]"), "holds what no waves are"),
        (lambda content: content.replace(b"[5]", b"[500000000000]"), "instead of 4"),
        (lambda content: content.replace(b"[5]", b'["5"'), "does not say what it holds"),
        (
            lambda content: content[:21] + json.dumps([NOTHING] * 17).encode() + b"\n",
            "holds what no waves are",
        ),
    ],
)
def test_a_file_that_is_not_whole_or_not_ours_is_told_and_not_read(
    shelf: ArrayFiles,
    change: Callable[[bytes], bytes],
    words: str,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    path = file_of(shelf)
    path.write_bytes(change(path.read_bytes()))
    monkeypatch.setattr(pickle, "loads", lambda *_: pytest.fail("it was executed"))
    assert shelf.find("name") is None
    assert words in caplog.text
    assert caplog.text.rstrip().endswith("the waves are computed again")
    shelf.keep("name", ARRAYS)
    assert shelf.find("name") is not None


def test_a_pipe_in_the_place_of_a_file_is_told(shelf: ArrayFiles, caplog: pytest.LogCaptureFixture) -> None:
    if not hasattr(os, "mkfifo"):
        pytest.skip("this system has no pipes")
    path = file_of(shelf)
    path.unlink()
    os.mkfifo(path)
    assert shelf.find("name") is None
    assert "is no file" in caplog.text


def test_what_was_not_used_for_longest_goes_where_there_is_no_room(tmp_path: Path) -> None:
    one = (np.zeros(1000, np.complex64),)
    shelf = ArrayFiles(tmp_path, most=2 * 8200)
    for age, name in ((30, "old"), (20, "new")):
        shelf.keep(name, one)
        path = tmp_path / f"{name}.arrays"
        os.utime(path, (path.stat().st_atime - age, path.stat().st_mtime - age))
    assert shelf.find("old") is not None  # from now on it is the one that was used last
    (tmp_path / "of another program").write_bytes(bytes(100_000))
    shelf.keep("newest", one)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "newest.arrays", "of another program", "old.arrays",
    ]  # fmt: skip


def test_what_a_killed_process_began_is_not_found_and_goes(tmp_path: Path) -> None:
    script = (
        "import os, sys, numpy as np\n"
        "from pathlib import Path\n"
        "from ocean_tweak.export import shelf\n"
        "os.fsync = lambda _: os.kill(os.getpid(), 9)\n"  # all is written, and not yet in its place
        "shelf.ArrayFiles(Path(sys.argv[1])).keep('name', (np.zeros(1000, np.complex64),))"
    )
    if os.name == "nt":
        pytest.skip("this system ends processes otherwise")
    process = subprocess.run([sys.executable, "-c", script, str(tmp_path)], cwd=ROOT, check=False)
    assert process.returncode == -9
    (begun,) = tmp_path.iterdir()
    assert begun.stat().st_size > 8000
    shelf = ArrayFiles(tmp_path)
    assert shelf.find("name") is None
    shelf.keep("name", ARRAYS)
    assert begun.exists()  # perhaps another process still writes it
    os.utime(begun, (begun.stat().st_atime - 7200, begun.stat().st_mtime - 7200))
    shelf.keep("name", ARRAYS)
    assert [path.name for path in tmp_path.iterdir()] == ["name.arrays"]


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    (tmp_path / "file").touch()
    ArrayFiles(tmp_path / "file" / "folder").keep("name", ARRAYS)
    assert "will be computed again" in caplog.text


def test_the_environment_names_the_folder_and_processes_inherit_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(MEMO, "shelf", None)
    monkeypatch.delenv("OCEAN_TWEAK_COASTS", raising=False)
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    use_environment()
    assert MEMO.shelf is None
    assert "OCEAN_TWEAK_COASTS" not in environment()
    use_folder(tmp_path)
    assert environment()["OCEAN_TWEAK_COASTS"] == str(tmp_path)
    monkeypatch.setenv("OCEAN_TWEAK_CACHE", str(tmp_path / "cache"))
    use_environment()
    assert environment()["OCEAN_TWEAK_COASTS"] == str(tmp_path / "cache" / "coasts")
    monkeypatch.setenv("OCEAN_TWEAK_COASTS", str(tmp_path / "own"))
    use_environment(tmp_path / "of Blender")
    assert environment()["OCEAN_TWEAK_COASTS"] == str(tmp_path / "own")
    use_cache(tmp_path / "of a bake")
    assert environment()["OCEAN_TWEAK_COASTS"] == str(tmp_path / "own")
    use_folder(None)
    use_cache(tmp_path / "of a bake")
    assert environment()["OCEAN_TWEAK_COASTS"] == str(tmp_path / "of a bake" / "coasts")
    if os.name != "nt":
        monkeypatch.setenv("OCEAN_TWEAK_COASTS", "C:\\coasts")
        with pytest.raises(ParameterError, match="OCEAN_TWEAK_COASTS"):
            use_environment()


def test_a_trial_finds_nothing_and_what_was_used_is_used_again(
    shelf: ArrayFiles, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(MEMO, "shelf", shelf)
    with nothing_kept():
        assert MEMO.shelf is None
    assert MEMO.shelf is shelf
    with pytest.raises(KeyboardInterrupt), nothing_kept():
        raise KeyboardInterrupt
    assert MEMO.shelf is shelf
