# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers of wave vectors: pinned, well distributed, uncorrelated, the same at every resolution."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from ocean_tweak.core import OceanParameters
from ocean_tweak.core.numerics import random
from ocean_tweak.core.numerics.grid import WaveVectorGrid
from ocean_tweak.core.synthesis.coefficients import initial_state, random_phasors

PINNED = {
    "combine(0)": 16294208416658607535,
    "combine(1, 2)": 13608149317741381227,
    "keys": [
        11258207220464237729,
        6025155461660098886,
        4778307216003222477,
        8513513797023270822,
    ],
}


@pytest.fixture(scope="module")
def key() -> np.ndarray:
    k = 2 * np.pi / 400.0 * np.arange(-128, 128)
    return random.hash_wave_vectors(k[np.newaxis, :], k[:, np.newaxis], seed=3)


def test_no_number_is_zero(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its logarithm is taken: the least is 2⁻⁵⁴."""
    monkeypatch.setattr(random, "mix", np.zeros_like)
    assert random.uniform(np.arange(3, dtype=np.uint64), 0).tolist() == [2.0**-54] * 3
    assert np.all(np.isfinite(random.normal(np.arange(3, dtype=np.uint64), 0)))


def test_integers_never_change() -> None:
    # pinned: a sea of today looks the same on every platform and in every later version
    assert random.combine(0) == PINNED["combine(0)"]
    assert random.combine(1, 2) == PINNED["combine(1, 2)"]
    keys = random.hash_wave_vectors([0.0, 0.1, -0.1, 0.1], [0.0, 0.2, 0.2, -0.2], seed=42)
    assert [int(k) for k in keys] == PINNED["keys"]


def test_first_mixing_step_is_splitmix64() -> None:
    # the published sequence of SplitMix64 from seed 0: mix(golden · n), Steele, Lea & Flood (2014)
    golden = np.uint64(0x9E3779B97F4A7C15)
    assert int(random.mix(np.array([golden]))[0]) == 0xE220A8397B1DCDAF


def test_uniform_and_normal(key: np.ndarray) -> None:
    for stream in (0, 1, 2):
        assert stats.kstest(random.uniform(key, stream).ravel(), "uniform").pvalue > 0.001
    numbers = random.normal(key, 0).ravel()
    assert stats.kstest(numbers, "norm").pvalue > 0.001
    assert stats.kurtosis(numbers) == pytest.approx(0.0, abs=0.1)
    assert len(np.unique(key)) == key.size


def test_neighbours_are_uncorrelated(key: np.ndarray) -> None:
    limit = 4.0 / np.sqrt(key.size)
    u = random.uniform(key, 0) - 0.5
    for other in (
        np.roll(u, 1, 0), np.roll(u, 1, 1), u.T, u[::-1, ::-1], u[:, ::-1], random.uniform(key, 1) - 0.5,
    ):  # fmt: skip
        assert abs(np.mean(u * other)) * 12.0 < limit


def test_opposite_waves_are_uncorrelated() -> None:
    along, against = random_phasors(WaveVectorGrid(128, 500.0), 5, "RANDOM")
    limit = 4.0 / np.sqrt(along.size)
    assert abs(np.mean(along * against)) < limit
    assert abs(np.mean(along * np.conj(against))) < limit


def test_seeds_differ() -> None:
    k = np.linspace(0.01, 1.0, 10_000)
    first, second = (random.uniform(random.hash_wave_vectors(k, -k, seed), 0) for seed in (1, 2))
    assert abs(np.corrcoef(first, second)[0, 1]) < 0.04


def test_resolution_refines_the_same_sea() -> None:
    coarse = initial_state(OceanParameters(resolution=256, seed=9))
    fine = initial_state(OceanParameters(resolution=512, seed=9))
    low = np.r_[0:128, 129:256]  # without the coarse grid's Nyquist row
    high = np.where(low < 128, low, low + 256)
    for name in ("h_plus", "h_minus", "expected_plus", "expected_minus", "omega"):
        np.testing.assert_array_equal(
            getattr(coarse, name)[low, :128], getattr(fine, name)[high, :128], err_msg=name
        )
    assert np.count_nonzero(coarse.h_plus) > 32_000


def test_domain_extends_the_same_random_numbers() -> None:
    small, _ = random_phasors(WaveVectorGrid(64, 300.0), 9, "RANDOM")
    large, _ = random_phasors(WaveVectorGrid(128, 600.0), 9, "RANDOM")
    np.testing.assert_array_equal(small[:32, :32], large[:64:2, :64:2])
