# SPDX-License-Identifier: GPL-3.0-or-later
"""What a container may have of its machine, in trees as Linux shows them."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from ocean_tweak.core.numerics import machine

GB = 2**30


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Files of another system's root, by path."""

    def grow(**files: str) -> None:
        for name, text in files.items():
            path = tmp_path / name.replace("__", "/").replace("DOT", ".")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)

    monkeypatch.setattr(machine, "_ROOT", tmp_path)
    monkeypatch.setattr(machine, "_physical_memory", lambda: 64 * GB)
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: set(range(16)))
    return grow


def group(version: int, name: str) -> dict[str, str]:
    lines = {1: f"5:cpu,cpuacct:{name}\n4:memory:{name}\n1:name=systemd:/x\n", 2: f"0::{name}\n"}
    return {"proc__self__cgroup": lines[version]}


def test_a_machine_without_limits(tree) -> None:
    tree(**group(2, "/user.slice"), sys__fs__cgroup__userDOTslice__memoryDOTmax="max\n")
    tree(sys__fs__cgroup__userDOTslice__cpuDOTmax="max 100000\n")
    assert (machine.usable_memory(), machine.usable_cores()) == (64 * GB, 16)


def test_no_control_groups_at_all(tree) -> None:
    assert (machine.usable_memory(), machine.usable_cores()) == (64 * GB, 16)


def test_a_container_that_sees_its_group_as_the_whole(tree) -> None:
    tree(
        **group(2, "/"),
        sys__fs__cgroup__memoryDOTmax=f"{4 * GB}\n",
        sys__fs__cgroup__cpuDOTmax="150000 100000\n",
    )
    assert (machine.usable_memory(), machine.usable_cores()) == (4 * GB, 2)


def test_the_least_of_nested_groups(tree) -> None:
    """A job of a farm's service: the service has less than its job was promised."""
    tree(**group(2, "/render/job"), sys__fs__cgroup__render__job__memoryDOTmax=str(8 * GB))
    tree(
        sys__fs__cgroup__render__memoryDOTmax=str(6 * GB),
        sys__fs__cgroup__render__job__cpuDOTmax="50000 100000",
    )
    assert (machine.usable_memory(), machine.usable_cores()) == (6 * GB, 1)


def test_version_1_under_the_name_that_the_machine_knows(tree) -> None:
    """Docker's: the name is the machine's, and what is mounted is the container's own group."""
    tree(
        **group(1, "/docker/0123"),
        sys__fs__cgroup__memory__memoryDOTlimit_in_bytes=str(3 * GB),
        sys__fs__cgroup__cpu__cpuDOTcfs_quota_us="300000",
        sys__fs__cgroup__cpu__cpuDOTcfs_period_us="100000",
    )
    assert (machine.usable_memory(), machine.usable_cores()) == (3 * GB, 3)


def test_version_1_without_limits(tree) -> None:
    tree(
        **group(1, "/"),
        sys__fs__cgroup__memory__memoryDOTlimit_in_bytes="9223372036854771712",
        sys__fs__cgroup__cpu__cpuDOTcfs_quota_us="-1",
        sys__fs__cgroup__cpu__cpuDOTcfs_period_us="100000",
    )
    assert (machine.usable_memory(), machine.usable_cores()) == (64 * GB, 16)
