# SPDX-License-Identifier: GPL-3.0-or-later
"""Valid parameters over their whole ranges and at their ends, for hypothesis."""

from __future__ import annotations

import dataclasses
import math
from fractions import Fraction
from typing import Any

import numpy as np
from hypothesis import reject
from hypothesis import strategies as st

from ocean_tweak.core import (
    Foam,
    HeroWave,
    ImageLayer,
    Mask,
    OceanParameters,
    ParameterError,
    Patch,
    Raster,
    Timing,
    Water,
    WaveLayer,
    WindFieldLayer,
    WindKey,
)
from ocean_tweak.core.data.validation import OPEN
from ocean_tweak.core.parameters.ocean_parameters import Current, Equaliser, MeasuredSpectra


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


def measured_spectra() -> st.SearchStrategy[MeasuredSpectra]:
    """A few bins at one or two times, with directions or without."""

    def spectra(
        energies: list[float], r1: float, towards: float, is_told: bool, tail: bool
    ) -> MeasuredSpectra:
        times = len(energies) // 3
        f = np.array([0.05, 0.1, 0.4])
        moments = np.tile([r1 * math.cos(towards), r1 * math.sin(towards), 0.0, r1**2], (times, 3, 1))
        return MeasuredSpectra(
            frequencies=Raster(np.stack([f, np.gradient(f)], axis=-1)[np.newaxis]),
            energy=Raster(np.reshape(energies, (times, 3, 1))),
            moments=Raster(moments) if is_told else None,
            times=Raster([[0.0, 3600.0]]) if times == 2 else None,
            tail=tail,
        )

    energies = st.sampled_from([3, 6]).flatmap(
        lambda count: st.lists(st.floats(0.0, 100.0, width=32), min_size=count, max_size=count)
    )
    return st.builds(
        spectra, energies, st.floats(0.0, 1.0), st.floats(-7.0, 7.0), st.booleans(), st.booleans()
    )


BAND = st.tuples(st.floats(0.0, 100.0), st.floats(101.0, 1e6))
LAYERS = st.builds(
    lambda layer, band: dataclasses.replace(layer, shortest_wavelength=band[0], longest_wavelength=band[1]),
    instances(
        WaveLayer,
        shortest_wavelength=st.just(0.0),
        longest_wavelength=st.just(1e6),
        id=st.just(-1),
        measured=measured_spectra(),
        equaliser=st.one_of(st.none(), instances(Equaliser)),
    ),
    BAND,
)
COMMON = {
    "loop_duration": st.one_of(st.none(), st.integers(1, 500).map(lambda n: Fraction(n, 24))),
    "water": instances(Water),
    "foam": instances(Foam, resolution=st.sampled_from([0, 16, 24])),
    "timing": st.just(Timing()),
    "current": st.one_of(st.none(), instances(Current)),
    "equaliser": st.one_of(st.none(), instances(Equaliser)),
}
SEAS = instances(
    OceanParameters,
    resolution=st.sampled_from([16, 18, 20, 32]),
    layers=st.lists(LAYERS, min_size=1, max_size=3).map(tuple),
    merged_resolution=st.just(0),
    **COMMON,
)
IMAGES = st.integers(1, 4).flatmap(
    lambda columns: st.lists(
        st.lists(st.floats(0.0, 1.0, width=32), min_size=columns, max_size=columns), min_size=1, max_size=4
    )
)
LINES = st.lists(
    st.lists(st.floats(-0.125, 0.125, width=32), min_size=4, max_size=4), min_size=1, max_size=3
).map(lambda lines: Raster([lines]))
MASKS = st.one_of(
    st.none(),
    instances(
        Mask,
        source=st.just("DISTANCE"),
        inner_radius=st.floats(0.0, 100.0),
        outer_radius=st.floats(101.0, 1e6),
        image=st.none(),
        lines=st.one_of(st.none(), LINES),
    ),
    instances(
        Mask,
        source=st.just("IMAGE"),
        image=IMAGES.map(Raster),
        lines=st.none(),
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
        OceanParameters, patches=patches, merged_resolution=st.sampled_from([0, 16, 48]), layers=layers,
        mask=MASKS,
        trough_damping=st.just(0.0), resolution=st.just(OPEN), domain_size=st.just(OPEN), **COMMON,
    )  # fmt: skip


SHARES = st.one_of(st.floats(0.0, 1.0), st.sampled_from([0.0, 1.0]))
IMAGES = instances(
    ImageLayer,
    image=st.one_of(
        st.none(), IMAGES.filter(lambda rows: np.ptp(np.float32(rows)) > 0.0).map(Raster)
    ),
    noise_resolution=st.sampled_from([16, 32]),
    mask=MASKS,
    id=st.just(-1),
)  # fmt: skip


def wind_fields(longest: float, gravity: float) -> st.SearchStrategy[WindFieldLayer]:
    """Few waves of a wind, the same everywhere or with keys, whose lengths in m are at most the longest."""
    speed = min(100.0, 0.999 * math.sqrt(longest * gravity))
    wind = st.tuples(SHARES, SHARES).map(lambda shares: [speed * (share - 0.5) for share in shares])
    keys = st.lists(st.floats(-200.0, 200.0), max_size=2, unique=True).flatmap(
        lambda times: st.tuples(
            *(
                st.builds(WindKey, time=st.just(time), vectors=wind.map(lambda vector: Raster([[vector]])))
                for time in sorted(times)
            )
        )
    )
    return instances(
        WindFieldLayer,
        wind_speed=SHARES.map(lambda share: share * speed),
        keys=keys,
        wind_scale=SHARES,
        minimum_wind_speed=st.floats(0.1, 1.0).map(lambda share: max(0.1, share * speed)),
        start_time=st.floats(-200.0, 200.0),
        columns=st.integers(1, 3),
        rows=st.integers(1, 3),
        origins=st.integers(1, 2),
        particles=st.integers(1, 9),
        life=st.floats(0.5, 10.0),
        mask=MASKS,
        id=st.just(-1),
    )


def hero_waves(domain_size: float) -> st.SearchStrategy[HeroWave]:
    """Groups that a domain and 48 samples hold."""
    return st.builds(
        lambda wave, share: dataclasses.replace(
            wave, wavelength=0.33 * domain_size, group_length=1.0 + 2.0 * share, group_width=0.5 * domain_size
        ),
        instances(HeroWave, wavelength=st.just(1e-3)),
        SHARES,
    )


@st.composite
def any_seas(draw: st.DrawFn) -> OceanParameters:
    """Seas with whatever may be in one, on few samples: layers of every kind, patches, masks, loops."""
    sea = draw(st.one_of(SEAS, patched_seas()))
    changes: dict[str, Any] = {}
    if draw(st.booleans()):
        changes["layers"] = tuple(dataclasses.replace(layer, mask=draw(MASKS)) for layer in sea.layers)
    others = {
        "IMAGE": IMAGES,
        "WIND_FIELD": wind_fields(sea.domain_size, sea.water.gravity),
        "HERO_WAVE": hero_waves(sea.domain_size),
    }
    kinds = sorted(draw(st.sets(st.sampled_from(sorted(others)))))
    for kind in kinds:
        own = draw(st.lists(others[kind], min_size=1, max_size=2))
        changes["layers"] = (*changes.get("layers", sea.layers), *own)
    if "WIND_FIELD" in kinds:
        changes["loop_duration"] = None
    if "HERO_WAVE" in kinds and not sea.patches:
        changes["resolution"] = 48
    elif "HERO_WAVE" in kinds:
        changes["patches"] = (dataclasses.replace(sea.patches[0], resolution=48), *sea.patches[1:])
        changes["merged_resolution"] = sea.merged_resolution and 48
    if sea.patches and kinds:
        first, *rest = changes.get("patches", sea.patches)
        changes["patches"] = (dataclasses.replace(first, rotation=0.0), *rest)
    try:
        return sea.replace(**changes)
    except ParameterError:  # an image that moves on in a loop, a damped sea that is masked
        reject()
