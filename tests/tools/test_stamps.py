# SPDX-License-Identifier: GPL-3.0-or-later
import pytest

from tools import stamps
from tools.project import ToolError, run_logged


def make(folder, recipe):
    with stamps.making(folder, recipe):
        folder.mkdir()
        (folder / "file").write_text(recipe)


def test_made_folder_counts_for_its_own_recipe_only(tmp_path):
    folder = tmp_path / "thing"
    assert not stamps.is_made(folder, "numpy==1")
    make(folder, "numpy==1")
    assert stamps.is_made(folder, "numpy==1")
    assert not stamps.is_made(folder, "numpy==2")


def test_moved_folder_does_not_count(tmp_path):
    make(tmp_path / "thing", "numpy==1")
    (tmp_path / "thing").rename(tmp_path / "moved")
    assert not stamps.is_made(tmp_path / "moved", "numpy==1")


def test_new_recipe_starts_from_an_empty_place(tmp_path):
    folder = tmp_path / "thing"
    make(folder, "numpy==1")
    with stamps.making(folder, "numpy==2"):
        assert not folder.exists()
        folder.mkdir()
    assert stamps.is_made(folder, "numpy==2")
    assert not (folder / "file").exists()


def test_half_made_folder_never_counts(tmp_path):
    folder = tmp_path / "thing"
    make(folder, "numpy==1")
    with pytest.raises(ToolError), stamps.making(folder, "numpy==1"):
        run_logged(["sh", "-c", f"mkdir {folder} && exit 1"], tmp_path / "log")
    assert not stamps.is_made(folder, "numpy==1")


def test_folder_with_a_mount_in_it_is_not_deleted(monkeypatch, tmp_path):
    folder = tmp_path / "root"
    make(folder, "debian")
    mounts = tmp_path / "mounts"
    mounts.write_text(f"proc {folder}/proc proc rw 0 0\n")
    monkeypatch.setattr(stamps, "MOUNTS", mounts)
    with pytest.raises(ToolError, match="umount"):
        stamps.remove(folder)
    assert stamps.is_made(folder, "debian")


def test_failing_command_shows_the_end_of_its_log(tmp_path):
    with pytest.raises(ToolError) as failure:
        run_logged(["sh", "-c", "seq 100; exit 3"], tmp_path / "logs" / "log")
    lines = str(failure.value).splitlines()
    assert "exit code 3" in lines[0]
    assert lines[-1] == "100"
    assert len(lines) < 30
