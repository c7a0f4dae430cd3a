# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas of several patches: what is refused, statistics, memory, loops, shots and documents."""

from __future__ import annotations

import dataclasses
import math
import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy import integrate

from ocean_tweak.core import (
    Ocean,
    OceanParameters,
    ParameterError,
    Patch,
    Places,
    Raster,
    Water,
    WindFieldLayer,
    WindKey,
)
from ocean_tweak.core.parameters.patch_seas import PARTS, patch_parameters
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.sea.bake import bake
from ocean_tweak.core.sea.memory import memory_need
from ocean_tweak.core.spectral.directional_spectrum import DirectionalSpectrum
from ocean_tweak.core.spectral.dispersion import angular_frequency
from ocean_tweak.core.statistics.unresolved_slopes import unresolved_slope_variance
from ocean_tweak.core.synthesis.channels import ADDING
from tests.core.patched_seas import LAYER, SEA, THREE, small
from tests.layers import layers_of, with_layers

GENERATOR = np.random.default_rng(11)


def test_json_round_trip_and_the_size_of_the_first_patch() -> None:
    again = OceanParameters.from_json(SEA.to_json())
    assert again == SEA
    assert (SEA.domain_size, SEA.resolution) == (600.0, 128)
    assert "patches" not in OceanParameters().to_dict()
    halved = SEA.replace(resolution=64)
    assert [patch.resolution for patch in halved.patches] == [64, 64, 80]
    assert halved.resolution == 64
    with pytest.raises(ParameterError, match=r"domain_size = 50\.0: is set by the first patch"):
        SEA.replace(domain_size=50.0)


def patches_between(*bands: tuple[float, float]) -> tuple[Patch, ...]:
    return tuple(Patch(100.0, 0.0, shortest, longest, 64) for shortest, longest in bands)


def test_what_patches_tell_is_not_given_otherwise() -> None:
    """The tile is the first patch's, or has as many samples as they are joined on."""
    for given, wanted in (({"resolution": 64}, "128"), ({"domain_size": 50.0}, "600")):
        with pytest.raises(ParameterError, match=rf"must be {wanted}, as the patches have it: leave it out"):
            OceanParameters(patches=THREE, **given)
    with pytest.raises(ParameterError, match=r"resolution = 128: must be 48, as the patches have it"):
        OceanParameters(patches=THREE, merged_resolution=48, resolution=128)
    same = OceanParameters(patches=THREE, resolution=128, domain_size=600.0)
    assert same == OceanParameters(patches=THREE) == OceanParameters().replace(patches=THREE)
    with pytest.raises(ParameterError, match=r"resolution = None: must be a whole number"):
        OceanParameters(resolution=None)
    # a file may still tell both, and the patches win
    assert OceanParameters.from_dict({**same.to_dict(), "resolution": 64}) == same


@pytest.mark.parametrize(
    ("bands", "said"),
    [
        (((20.0, 1e6), (2.0, 25.0)), "patches.0 ends at 20 m and patches.1 begins at 25 m: .* twice"),
        (((20.0, 1e6), (2.0, 15.0)), "patches.0 ends at 20 m and patches.1 begins at 15 m: .* lost"),
        (((20.0, 1e6), (5.0, 20.0), (1.0, 4.0)), "patches.2 begins at 4 m: .* one value"),
        (((2.0, 20.0), (20.0, 1e6)), "order the patches from long waves to short"),
    ],
)
def test_bands_that_do_not_join_are_refused(bands: tuple[tuple[float, float], ...], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        OceanParameters(patches=patches_between(*bands))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"trough_damping": 0.5}, "trough_damping = 0.5: must be 0 in a sea of several patches"),
        ({"patches": THREE + THREE}, "patches = '6 entries': must have from 0 to 4 entries"),
        ({"patches": "many"}, "must be a sequence of Patch"),
    ],
)
def test_what_patches_cannot_have(changes: dict[str, object], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        SEA.replace(**changes)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"resolution": 31}, "resolution = 31: must be an even number"),
        ({"shortest_wavelength": 9.0, "longest_wavelength": 9.0}, "must be below longest_wavelength = 9 m"),
        ({"domain_size": 0.0}, "domain_size = 0.0: must be from 0.1"),
        ({"rotation": math.nan}, "rotation = nan: must be a finite number"),
    ],
)
def test_bad_patches_are_refused(values: dict[str, object], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        Patch(**values)  # type: ignore[arg-type]


def wind_field() -> WindFieldLayer:
    return WindFieldLayer(keys=(WindKey(0.0, Raster(np.full((4, 4, 2), 4.0))),))


def test_wind_fields_are_on_the_first_patch() -> None:
    sea = with_layers(SEA, WIND_FIELD=(wind_field(),))
    assert [len(layers_of(patch, "WIND_FIELD")) for patch in patch_parameters(sea)] == [1, 0, 0]
    turned = (dataclasses.replace(THREE[0], rotation=0.1), *THREE[1:])
    with pytest.raises(
        ParameterError, match=r"patches\.0\.rotation = 0\.1: must be 0 in a sea with wind_fields"
    ):
        sea.replace(patches=turned)


def test_separate_patches_have_no_one_tile() -> None:
    for patches in (THREE, (Patch(100.0, 0.2, resolution=64),)):
        apart = Ocean(SEA.replace(patches=patches))
        with pytest.raises(ValueError, match=r"^on = Tile\(\): .* here [31], .* `parameters\.on_one_grid"):
            apart.surface(0.0, {"slope"})
        with pytest.raises(ValueError, match=r"^on = Tile\(\)"):
            apart.foam_history  # noqa: B018
        assert [patch.surface(0.0).displacement.shape[0] for patch in apart.patches] == [
            patch.resolution for patch in patches
        ]
    cascade = Ocean(SEA)
    with pytest.raises(ValueError, match="surface = 'nurbs'"):
        cascade.height_at(0.0, 0.0, 1.0, "nurbs")
    with pytest.raises(ValueError, match="outputs = 'curl'"):
        cascade.surface(1.0, {"curl"}, on=Places(0.0, 0.0))
    with pytest.raises(ValueError, match="time = nan"):
        cascade.surface(math.nan, on=Places(0.0, 0.0))
    with pytest.raises(ValueError, match="finite places"):
        cascade.surface(1.0, on=Places([0.0, math.inf], 0.0))
    with pytest.raises(TypeError, match="Ocean wants OceanParameters"):
        Ocean({})  # type: ignore[arg-type]


def test_a_loop_ends_where_it_began() -> None:
    cascade = Ocean(small(loop_duration=Fraction(10)), precision="double")
    x, y = GENERATOR.uniform(0.0, 500.0, (2, 100))
    first, last = (cascade.surface(time, on=Places(x, y)).displacement for time in (0.0, 10.0))
    np.testing.assert_allclose(first, last, atol=1e-9)


def test_a_shot_animates_layers_and_not_patches() -> None:
    shot = Shot(SEA, Animation(1, (("layers.0.wind_direction", (0.4, 0.5)),)))
    assert shot.at(2).parameters.patches == THREE
    with pytest.raises(ParameterError, match="is constant over a shot"):
        Animation(1, (("patches.0.rotation", (0.4, 0.5)),))


# statistics and memory


def test_statistics_of_the_sum_and_of_its_patches() -> None:
    found = Ocean(SEA).statistics()
    whole = Ocean(SEA.replace(patches=())).statistics()
    assert found.spectrum == whole.spectrum
    assert found.resolved.m0 == pytest.approx(sum(p.statistics.resolved.m0 for p in found.patches))
    assert sum(patch.share for patch in found.patches) == pytest.approx(1.0)
    assert found.resolved.mean_direction == pytest.approx(0.4, abs=0.01)
    assert found.resolved.mean_square_slope == pytest.approx(
        sum(p.statistics.resolved.mean_square_slope for p in found.patches)
    )
    assert found.sample_spacing == pytest.approx(33.0 / 160)
    told = found.to_dict()["patches"]
    assert [patch["domain_size"] for patch in told] == [600.0, 151.0, 33.0]  # type: ignore[attr-defined]
    assert told[2]["samples_a_wave"] == pytest.approx(0.9 * 160 / 33.0)  # type: ignore[index]
    assert found.warnings == ()


def test_statistics_of_one_patch_are_those_of_its_sea() -> None:
    whole = SEA.replace(patches=(), resolution=32, domain_size=200.0)
    for sea in (
        whole,
        whole.replace(seed=8),
        whole.replace(layers=(dataclasses.replace(LAYER, muted=True),)),
    ):
        one_patch = sea.replace(patches=(Patch(sea.domain_size, resolution=sea.resolution),))
        told = Ocean(one_patch).statistics().to_dict()
        assert [patch["share"] for patch in told.pop("patches")] == [1.0 if sea.active() else 0.0]  # type: ignore[attr-defined]
        assert told == Ocean(sea).statistics().to_dict()


def test_statistics_warn_of_patches_that_are_too_small_or_too_coarse() -> None:
    first, second, third = THREE
    coarse = Ocean(SEA.replace(patches=(first, second, dataclasses.replace(third, resolution=64))))
    (warning,) = coarse.statistics().warnings
    assert (
        "Patch 3: its shortest wave, 0.9 m, has only 1.7 samples. Give the patch 148 samples, or" in warning
    )
    assert "or end its band at 2.06 m" in warning  # four samples of 33 m / 64
    near = Ocean(SEA.replace(patches=(first, dataclasses.replace(second, domain_size=80.0), third)))
    assert any("Patch 2: its longest wave, 20 m, fits only 4 times" in w for w in near.statistics().warnings)
    early = (
        dataclasses.replace(first, shortest_wavelength=60.0),
        dataclasses.replace(second, longest_wavelength=60.0),
    )
    shown = Ocean(SEA.replace(patches=early)).statistics().warnings
    assert any("Patch 2: it repeats every 151 m with" in warning for warning in shown)


def test_memory_is_that_of_all_patches() -> None:
    whole = memory_need(SEA)
    parts = [memory_need(patch) for patch in patch_parameters(SEA)]
    assert whole.state == sum(part.state for part in parts)
    assert whole.surface == sum(part.surface for part in parts)


def test_unresolved_slopes_begin_where_the_last_patch_ends() -> None:
    """Ripples shorter than 0.9 m: ∫k²S dω, up to the shortest gravity waves."""
    limit = np.sqrt(1000.0 * 9.80665 / 0.074)
    shortest = 2.0 * np.pi / 0.9
    spectrum = DirectionalSpectrum(LAYER, Water(), "CAPILLARY")

    def density(log_k: float) -> float:
        k = math.exp(log_k)
        step = 1e-5
        omega, above = (float(angular_frequency(k * f, "CAPILLARY", Water())) for f in (1.0, 1.0 + step))
        return k**2 * float(spectrum.frequency_spectrum(omega)) * (above - omega) / step

    expected, _ = integrate.quad(density, math.log(shortest), math.log(limit))
    assert unresolved_slope_variance(SEA) == pytest.approx(expected, rel=0.02)


# documents and examples

ROOT = Path(__file__).resolve().parents[2]


def test_the_example_is_a_plan_without_warnings() -> None:
    sea = OceanParameters.from_json((ROOT / "examples" / "horizon.json").read_text(encoding="utf-8"))
    found = Ocean(sea).statistics()
    assert len(sea.patches) == 4
    assert found.warnings == ()
    assert found.resolved_share == pytest.approx(1.0, abs=0.01)
    assert sea.patches[-1].shortest_wavelength == 0.1


def test_the_document_shows_a_sea() -> None:
    text = (ROOT / "docs" / "cascades.md").read_text(encoding="utf-8")
    (patches,) = re.findall(r"^```json\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    sea = OceanParameters.from_json(f"{{{patches}}}")
    assert Ocean(sea).statistics().warnings == ()


def test_patches_that_miss_much_tell_down_to_which_wave_they_go() -> None:
    """Two samples of the last one: 2 · 200 m / 64."""
    breeze = dataclasses.replace(SEA.layers[0], wind_speed=4.0)
    patches = (Patch(600.0, 0.0, 20.0, 1e6, 128), Patch(200.0, 0.0, 0.0, 20.0, 64))
    warnings = Ocean(SEA.replace(layers=(breeze,), patches=patches)).statistics().warnings
    assert any(
        re.search(r"resolve \d\d % .* down to waves of 6\.25 m\. Plan them", each) for each in warnings
    )


def test_a_bake_of_patches_may_have_all_that_adds_up() -> None:
    class Kept:
        outputs = frozenset({*ADDING, PARTS})

        def write(self, _frame: object, *fields: object) -> tuple[Path, ...]:
            assert len(fields) == 2 * len(SEA.patches)
            return ()

    shot = Shot(SEA.replace(patches=tuple(dataclasses.replace(p, resolution=64) for p in THREE)))
    (made,) = bake(shot, (1,), Kept())
    assert made.frame == 1
