# SPDX-License-Identifier: GPL-3.0-or-later
"""How much is measured: everything, or just enough to see that everything runs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from ocean_tweak.core import OceanParameters

ROOT = Path(__file__).resolve().parent.parent
SCRATCH = ROOT / "build" / "benchmarks"

_STORM = OceanParameters.from_json((ROOT / "examples" / "storm.json").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class Plan:
    """Sizes and repeats.

    rounds : how often every side of a comparison is timed
    sizes : samples along a side, for the transforms
    growth : the small and the large size that are compared
    state, memory, precision : sizes for those rows
    bake, bake_frames : size and number of frames of each timed bake
    scene : sizes in Blender
    latency : size at which a parameter is changed in Blender
    plan_transforms : let FFTW measure for the best plan
    left_out : targets that it has no rows for
    """

    rounds: int = 7
    sizes: tuple[int, ...] = (256, 512, 1024, 2048, 4096)
    growth: tuple[int, int] = (512, 4096)
    state: tuple[int, ...] = (512, 1024, 2048)
    memory: tuple[int, ...] = (512, 1024, 2048)
    precision: tuple[int, ...] = (1024,)
    bake: int = 1024
    bake_frames: int = 6
    scene: tuple[int, ...] = (256, 512, 1024)
    latency: int = 512
    plan_transforms: bool = True
    smoke: bool = False
    left_out: frozenset[str] = frozenset()


FULL = Plan()
SMOKE = Plan(
    rounds=2,
    sizes=(64, 128),
    growth=(64, 128),
    state=(64,),
    memory=(64,),
    precision=(64,),
    bake=64,
    bake_frames=2,
    scene=(64,),
    latency=64,
    plan_transforms=False,
    smoke=True,
    left_out=frozenset({"baked horizon"}),  # its bake takes minutes at any size
)


def sea(resolution: int) -> OceanParameters:
    """The storm of the examples, with this many samples along each side."""
    return _STORM.replace(resolution=resolution)


def with_wind(parameters: OceanParameters, wind_speed: float) -> OceanParameters:
    """The sea in another wind: one spectral parameter changed."""
    first, *others = parameters.layers
    return parameters.replace(layers=(replace(first, wind_speed=wind_speed), *others))
