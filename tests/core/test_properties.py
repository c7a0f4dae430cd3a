# SPDX-License-Identifier: GPL-3.0-or-later
"""Any valid parameters make a finite sea; any invalid one is refused by name."""

from __future__ import annotations

import dataclasses
import math
import os
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ocean_tweak.core import Foam, Ocean, OceanParameters, ParameterError, Patch, Timing, Water, WaveLayer
from ocean_tweak.core.synthesis.channels import OF_WAVES
from ocean_tweak.core.synthesis.coefficients import propagate
from tests.core.random_seas import SEAS, patched_seas

#: many more of both with `make test-long`
LONG = "OCEAN_TWEAK_LONG_TESTS" in os.environ
QUICK = settings(
    max_examples=300 if LONG else 30,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow],
)


@QUICK
@given(parameters=SEAS, time=st.floats(-1e6, 1e6))
def test_any_sea_is_finite_and_keeps_its_energy(parameters: OceanParameters, time: float) -> None:
    ocean = Ocean(parameters)
    with np.errstate(over="raise", invalid="raise", divide="raise"):
        fields = ocean.surface(time, OF_WAVES)
        statistics = ocean.statistics()
    for name in OF_WAVES:
        assert np.all(np.isfinite(getattr(fields, name))), name
    assert statistics.resolved.m0 <= statistics.spectrum.m0 * 1.05 + 1e-12
    if parameters.trough_damping == 0.0:
        coefficients = propagate(ocean.initial_state, time).elevation.astype(np.complex128)
        energy = np.sum(np.abs(coefficients) ** 2 * ocean.initial_state.grid.multiplicity)
        variance = np.var(fields.displacement[..., 2].astype(np.float64))
        assert variance == pytest.approx(energy, rel=1e-5, abs=1e-30)


@QUICK
@given(parameters=patched_seas(), time=st.floats(-1e6, 1e6))
def test_any_sum_is_finite(parameters: OceanParameters, time: float) -> None:
    sea = Ocean(parameters.on_one_grid(parameters.resolution))
    with np.errstate(over="raise", invalid="raise", divide="raise"):
        fields = sea.surface(time, OF_WAVES)
    for name in OF_WAVES:
        assert np.all(np.isfinite(getattr(fields, name))), name


@QUICK
@given(parameters=st.one_of(SEAS, patched_seas()))
def test_json_round_trip(parameters: OceanParameters) -> None:
    assert OceanParameters.from_json(parameters.to_json()) == parameters


def outside(field: dataclasses.Field[Any]) -> st.SearchStrategy[Any]:
    meta = field.metadata
    if meta["kind"] is str:
        return st.one_of(
            st.text(max_size=8).filter(lambda t: t not in meta["choices"]), st.none(), st.integers()
        )
    if meta["kind"] is bool:
        return st.one_of(st.integers(), st.none(), st.text(max_size=3))
    bad = [math.nan, math.inf, -math.inf, "3x", [], {}, True]
    if not meta.get("optional"):
        bad.append(None)
    low, high = meta["minimum"], meta["maximum"]
    beyond = [
        st.floats(max_value=math.nextafter(low, -math.inf)),
        st.floats(min_value=math.nextafter(high, math.inf)),
    ]
    if meta["kind"] is int:
        beyond = [st.integers(max_value=low - 1), st.integers(min_value=high + 1)]
        bad.append(low + 0.5)
    return st.one_of(st.sampled_from(bad), *beyond)


REFUSED = [
    (cls, field)
    for cls in (OceanParameters, WaveLayer, Water, Foam, Timing, Patch)
    for field in dataclasses.fields(cls)
    if "kind" in field.metadata
]


@pytest.mark.parametrize(("cls", "field"), REFUSED, ids=[f"{c.__name__}.{f.name}" for c, f in REFUSED])
def test_any_invalid_value_is_refused_by_name(cls: type, field: dataclasses.Field[Any]) -> None:
    @settings(max_examples=100 if LONG else 10, deadline=None, derandomize=True)
    @given(value=outside(field))
    def refuses(value: object) -> None:
        with pytest.raises(ParameterError, match=f"^{field.name} = "):
            cls(**{field.name: value})

    refuses()


@pytest.mark.parametrize(
    "changes",
    [
        {"domain_size": 100e3, "layers": (WaveLayer(wind_speed=0.1),)},
        {"domain_size": 0.1, "layers": (WaveLayer(wind_speed=100.0, fetch=20e6),)},
        {
            "water": Water(depth=0.1),
            "layers": (WaveLayer(wind_speed=100.0, fetch=20e6),),
            "orbital_motion": "FINITE_DEPTH",
        },
        {"layers": (WaveLayer(fetch=1.0, swell=4.0),)},
        {"layers": (WaveLayer(spreading="MITSUYASU", limit_fetch=False, fetch=20e6, wind_speed=0.1),)},
        {"layers": (WaveLayer(spectrum="GENERALIZED_AB", generalized_b=1e-12),)},
        {"layers": (WaveLayer(spectrum="GENERALIZED_AB", generalized_b=1e12),)},
    ],
)
def test_extreme_seas_are_finite_and_warned_about(changes: dict) -> None:
    ocean = Ocean(OceanParameters(resolution=32).replace(**changes))
    fields = ocean.surface(100.0, OF_WAVES)
    assert all(np.all(np.isfinite(getattr(fields, name))) for name in OF_WAVES)
    assert ocean.statistics().warnings
