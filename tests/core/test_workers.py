# SPDX-License-Identifier: GPL-3.0-or-later
"""Threads, arrays of the caller and memory: none of them changes what a surface is."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from ocean_tweak.core import ImageLayer, Ocean, OceanParameters, WaveLayer
from ocean_tweak.core.numerics import random
from ocean_tweak.core.numerics.memo import MEMO
from ocean_tweak.core.sea import memory
from ocean_tweak.core.sea.memory import memory_need
from ocean_tweak.core.synthesis import transforms
from ocean_tweak.core.synthesis.channels import OF_WAVES, memory_groups
from tests.layers import with_layers

SEA = OceanParameters(resolution=258, domain_size=300.0, trough_damping=0.3)


@pytest.mark.parametrize("workers", [2, 3, 7])
def test_workers_do_not_change_a_bit(workers: int) -> None:
    alone = Ocean(SEA, workers=1).surface(3.0, OF_WAVES)
    together = Ocean(SEA, workers=workers).surface(3.0, OF_WAVES)
    for name in OF_WAVES:
        assert getattr(alone, name).tobytes() == getattr(together, name).tobytes(), name


def test_outputs_do_not_change_each_other() -> None:
    ocean = Ocean(SEA)
    everything = ocean.surface(3.0, OF_WAVES)
    for name in OF_WAVES:
        assert getattr(ocean.surface(3.0, {name}), name).tobytes() == getattr(everything, name).tobytes(), (
            name
        )


def test_one_ocean_serves_several_threads() -> None:
    ocean = Ocean(SEA.replace(resolution=64))
    times = [0.1 * step for step in range(40)]
    in_turn = [ocean.surface(time).displacement.tobytes() for time in times]
    with ThreadPoolExecutor(4) as pool:
        at_once = list(pool.map(lambda time: ocean.surface(time).displacement.tobytes(), times))
    assert at_once == in_turn


def test_arrays_of_the_caller_are_filled() -> None:
    ocean = Ocean(SEA)
    wide = np.full((258, 258, 4), np.float32(7.0))
    fields = ocean.surface(1.0, out={"displacement": wide[..., :3]})
    assert fields.displacement.base is wide
    assert wide[..., :3].tobytes() == ocean.surface(1.0).displacement.tobytes()
    assert np.all(wide[..., 3] == 7.0)
    for wrong in (np.empty((258, 258, 3)), np.empty((257, 258, 3), np.float32)):
        with pytest.raises(ValueError, match="must be an array"):
            ocean.surface(1.0, out={"displacement": wrong})
    with pytest.raises(ValueError, match="workers = 0"):
        Ocean(SEA, workers=0)
    with pytest.raises(ValueError, match="precision = 'half'"):
        Ocean(SEA, precision="half")


@pytest.mark.parametrize("outputs", [{"displacement"}, {"displacement", "min_eigenvalue"}, set(OF_WAVES)])
def test_memory_beyond_the_outputs(outputs: set[str]) -> None:
    """At most 24 bytes a sample, and never more than was told before."""
    parameters = OceanParameters(resolution=1024)
    ocean = Ocean(parameters, workers=1)
    assert np.any(ocean.initial_state.h_plus)
    MEMO.drop("workspaces")
    tracemalloc.start()
    fields = ocean.surface(1.0, outputs)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    kept = sum(getattr(fields, name).nbytes for name in outputs)
    # NumPy before 2.0 transforms in double precision, and its blocks are twice as large
    assert (peak - kept) / 1024**2 <= (24.0 if np.lib.NumpyVersion(np.__version__) >= "2.0.0" else 34.0)
    assert peak < 1.4 * memory_need(parameters, outputs).surface


def test_a_sea_that_needed_more_arrays_does_not_make_the_next_one_slow(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Small blocks are slow, and a sea has as many of them whatever was made before it."""
    counts: list[int] = []
    run = transforms.run_blocks

    def counted(work: Callable[[slice], None], blocks: Iterable[slice], workers: int) -> None:
        each = list(blocks)
        counts.append(len(each))
        run(work, each, workers)

    monkeypatch.setattr(transforms, "run_blocks", counted)
    MEMO.drop()
    plain = OceanParameters(resolution=66)
    Ocean(plain).surface(1.0)
    first = counts.copy()
    Ocean(plain.replace(trough_damping=0.5)).surface(1.0, OF_WAVES)
    counts.clear()
    Ocean(plain).surface(2.0)
    assert counts == first


def test_memory_while_a_state_is_made_is_told() -> None:
    """Beyond what stays; its tables take as much at any resolution, and are there already."""
    small, large = (OceanParameters(resolution=n, domain_size=900.0, seed=4711) for n in (64, 1024))
    Ocean(small).prepare()
    tracemalloc.start()
    ocean = Ocean(large, workers=1)
    ocean.prepare()
    kept, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    told = memory_need(large).building - memory_need(small).building
    assert 0.5 * told < peak - kept < told
    assert 0.7 * memory_need(large).state < kept < 1.1 * memory_need(large).state


def test_memory_while_an_image_is_filtered_is_told() -> None:
    """Of an image of many more samples than the sea, beside which all else is small."""
    plain = OceanParameters(resolution=32, seed=4712)
    fine = with_layers(plain, IMAGE=(ImageLayer(noise_resolution=1024),))
    Ocean(with_layers(plain, IMAGE=(ImageLayer(noise_resolution=32),))).prepare()
    tracemalloc.start()
    ocean = Ocean(fine, workers=1)
    ocean.prepare()
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    told = memory_need(fine).building - memory_need(plain).building
    assert 0.6 * told < peak < told


def test_memory_with_trough_damping_is_told_too() -> None:
    parameters = OceanParameters(resolution=1024, trough_damping=0.5)
    ocean = Ocean(parameters, workers=1)
    Ocean(parameters, workers=1).surface(0.0)  # the state, which both share
    MEMO.drop("workspaces")
    tracemalloc.start()
    ocean.surface(1.0)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert 0.6 * peak < memory_need(parameters).surface
    assert peak > 1.4 * memory_need(parameters.replace(trough_damping=0.0)).surface


def test_a_sea_too_large_is_refused_before_it_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "usable_memory", lambda: 2**20)
    with pytest.raises(MemoryError, match=r"A sea of 514² samples needs 0\.1 GB .* lower the resolution"):
        Ocean(OceanParameters(resolution=514)).surface(0.0)
    monkeypatch.undo()
    assert memory.usable_memory() > 2**28


def test_changing_the_wind_draws_no_new_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    sea = OceanParameters(resolution=34, domain_size=123.0)
    drawn = []
    hash_wave_vectors = random.hash_wave_vectors

    def counted(*arguments: object) -> np.ndarray:
        drawn.append(arguments)
        return hash_wave_vectors(*arguments)

    monkeypatch.setattr(random, "hash_wave_vectors", counted)
    first = Ocean(sea).initial_state.h_plus
    assert drawn
    drawn.clear()
    assert not np.array_equal(
        Ocean(sea.replace(layers=(WaveLayer(wind_speed=20.0),))).initial_state.h_plus, first
    )
    assert not drawn
    assert Ocean(sea.replace(seed=8)).initial_state is not None
    assert drawn


def test_groups_hold_every_output_once() -> None:
    groups = memory_groups(OF_WAVES)
    assert sorted(name for group in groups for name in group) == sorted(OF_WAVES)
    assert groups[1] == ["velocity"]
    assert memory_groups([]) == []
