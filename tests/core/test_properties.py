# SPDX-License-Identifier: GPL-3.0-or-later
"""Any valid parameters make a finite sea; any invalid one is refused by name."""

from __future__ import annotations

import dataclasses
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ocean_tweak.core import (
    Foam,
    Mask,
    Ocean,
    OceanParameters,
    ParameterError,
    Patch,
    Raster,
    Timing,
    Water,
    WaveLayer,
    grid_sea,
)
from ocean_tweak.core.fields import OUTPUTS
from ocean_tweak.core.propagation import propagate

QUICK = settings(
    max_examples=60, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)


def values(field: dataclasses.Field[Any]) -> st.SearchStrategy[Any]:
    """Values of a field over its whole range and its ends; many decades by their logarithm."""
    meta = field.metadata
    if "nested" in meta:
        return st.just(field.default)
    if meta["kind"] is str:
        return st.sampled_from(meta["choices"])
    if meta["kind"] is bool:
        return st.booleans()
    low, high = meta["minimum"], meta["maximum"]
    if meta["kind"] is int:
        return st.integers(low, high)
    linear = st.floats(low, high)
    if low > 0 and high / low > 100:
        logarithmic = st.floats(math.log(low), math.log(high)).map(lambda x: min(max(math.exp(x), low), high))
        return st.one_of(linear, logarithmic, st.sampled_from([low, high]))
    return st.one_of(linear, st.sampled_from([low, high, field.default]))


def instances(cls: type, **fixed: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    strategies = {
        f.name: fixed.get(f.name, values(f)) for f in dataclasses.fields(cls) if f.name not in fixed
    }
    return st.builds(cls, **strategies, **fixed)


BAND = st.tuples(st.floats(0.0, 100.0), st.floats(101.0, 1e6))
LAYERS = st.builds(
    lambda layer, band: dataclasses.replace(layer, shortest_wavelength=band[0], longest_wavelength=band[1]),
    instances(WaveLayer, shortest_wavelength=st.just(0.0), longest_wavelength=st.just(1e6), id=st.just(-1)),
    BAND,
)
COMMON = {
    "loop_duration": st.one_of(st.none(), st.integers(1, 500).map(lambda n: Fraction(n, 24))),
    "water": instances(Water),
    "foam": instances(Foam, resolution=st.sampled_from([0, 16, 24])),
    "timing": st.just(Timing()),
}
SEAS = instances(
    OceanParameters,
    resolution=st.sampled_from([16, 18, 20, 32]),
    layers=st.lists(LAYERS, min_size=1, max_size=3).map(tuple),
    joined=st.just(0),
    **COMMON,
)
MASKS = st.one_of(
    st.none(),
    instances(
        Mask,
        source=st.just("DISTANCE"),
        near=st.floats(0.0, 100.0),
        far=st.floats(101.0, 1e6),
        image=st.none(),
    ),
    instances(
        Mask,
        source=st.just("IMAGE"),
        image=st.lists(
            st.lists(st.floats(0.0, 1.0, width=32), min_size=3, max_size=3), min_size=1, max_size=4
        ).map(Raster),
    ),
)


def patched_seas() -> st.SearchStrategy[OceanParameters]:
    """Two patches that meet, apart or joined, some of them and of the layers under masks."""
    patches = st.builds(
        lambda first, second, end: (
            dataclasses.replace(first, shortest_wavelength=end),
            dataclasses.replace(second, longest_wavelength=end),
        ),
        *(
            instances(
                Patch,
                resolution=st.sampled_from([16, 24]),
                shortest_wavelength=st.just(0.0),
                longest_wavelength=st.just(1e6),
                mask=MASKS,
            )
            for _ in range(2)
        ),
        st.floats(1e-3, 1e5),
    )
    layers = st.builds(lambda layer, mask: (dataclasses.replace(layer, mask=mask),), LAYERS, MASKS)
    return instances(
        OceanParameters, patches=patches, joined=st.sampled_from([0, 16, 48]), layers=layers,
        trough_damping=st.just(0.0), **COMMON,
    )  # fmt: skip


@QUICK
@given(parameters=SEAS, time=st.floats(-1e6, 1e6))
def test_any_sea_is_finite_and_keeps_its_energy(parameters: OceanParameters, time: float) -> None:
    ocean = Ocean(parameters)
    with np.errstate(over="raise", invalid="raise", divide="raise"):
        fields = ocean.surface(time, OUTPUTS)
        statistics = ocean.statistics()
    for name in OUTPUTS:
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
    sea = grid_sea(parameters.on_one_grid(parameters.resolution))
    with np.errstate(over="raise", invalid="raise", divide="raise"):
        fields = sea.surface(time, OUTPUTS)
    for name in OUTPUTS:
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
    @settings(max_examples=15, deadline=None, derandomize=True)
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
            "orbits": "FINITE_DEPTH",
        },
        {"layers": (WaveLayer(fetch=1.0, swell=4.0),)},
        {"layers": (WaveLayer(spreading="MITSUYASU", limit_fetch=False, fetch=20e6, wind_speed=0.1),)},
        {"layers": (WaveLayer(spectrum="GENERALIZED_AB", generalized_b=1e-12),)},
        {"layers": (WaveLayer(spectrum="GENERALIZED_AB", generalized_b=1e12),)},
    ],
)
def test_extreme_seas_are_finite_and_warned_about(changes: dict) -> None:
    ocean = Ocean(OceanParameters(resolution=32).replace(**changes))
    fields = ocean.surface(100.0, OUTPUTS)
    assert all(np.all(np.isfinite(getattr(fields, name))) for name in OUTPUTS)
    assert ocean.statistics().warnings
