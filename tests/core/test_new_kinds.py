# SPDX-License-Identifier: GPL-3.0-or-later
"""A kind of waves is a class and a line in the table, from which all else follows, as for these two here."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import (
    Area,
    Mask,
    Ocean,
    OceanParameters,
    ParameterError,
    Patch,
    Places,
    Timing,
    WaveLayer,
)
from ocean_tweak.core.masks.weights import weights
from ocean_tweak.core.parameters.fingerprint import shot_fingerprint
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.sea.placed_waves import placed_fields, repeating
from ocean_tweak.core.spectral.dispersion import angular_frequency
from ocean_tweak.core.waves.contribution import Contribution, Gives, Names, muted
from ocean_tweak.core.waves.kinds import KINDS, shown
from ocean_tweak.export.exr import read_image
from tests.new_kinds import Hump, Ripple, registered

SIZE, SAMPLES, TIME = 100.0, 32, 1.5
HARBOUR = Mask(x=40.0, y=50.0, inner_radius=10.0, outer_radius=40.0)
X, Y = np.array([3.0, 31.0, 47.2, 77.7]), np.array([9.0, 22.0, 55.5, 93.0])


@pytest.fixture(autouse=True)
def kinds() -> Iterator[None]:
    with registered(Ripple, Hump):
        yield


def sea(*layers: Contribution, **changes: object) -> OceanParameters:
    values = {"resolution": SAMPLES, "domain_size": SIZE, "choppiness": 0.0, "timing": Timing(start_frame=0)}
    return OceanParameters(layers=(WaveLayer(muted=True), *layers), **(values | changes))


def ripple_at(x: np.ndarray, time: float, parameters: OceanParameters, layer: Ripple) -> np.ndarray:
    k = 2.0 * np.pi * layer.waves / SIZE
    omega = angular_frequency(k, parameters.dispersion, parameters.water)
    return layer.amplitude * np.cos(k * x - omega * time)


def test_json_both_ways_and_fingerprint() -> None:
    given = sea(Ripple(amplitude=0.7, mask=HARBOUR), Hump(), Ripple())
    data = given.to_dict()
    assert [layer.get("kind") for layer in data["layers"]] == [None, "RIPPLE", "HUMP", "RIPPLE"]
    assert [layer.get("id") for layer in data["layers"]] == [0, 0, None, 1]
    assert OceanParameters.from_json(given.to_json()) == given
    others = (sea(Ripple(amplitude=0.8, mask=HARBOUR), Hump(), Ripple()), sea(Hump()), sea())
    prints = {shot_fingerprint(Shot(each)) for each in (given, *others, OceanParameters.from_dict(data))}
    assert len(prints) == 4


def test_what_is_no_kind_names_the_nearest() -> None:
    for kind, near in (("RIPLE", "RIPPLE"), ("hump", "HUMP"), ("waves", "WAVES"), (3, "WAVES")):
        with pytest.raises(ParameterError) as caught:
            OceanParameters.from_dict({"layers": [{}, {"kind": kind}]})
        assert caught.value.field == "layers.1.kind"
        assert "Known kinds: WAVES, HERO_WAVE, IMAGE, WIND_FIELD, WAKE, RIPPLE, HUMP" in str(caught.value)
        assert near == "WAVES" or f"did you mean {near}?" in str(caught.value)
        assert "\n" not in str(caught.value)
    with pytest.raises(ParameterError, match=r"layers\.1\.waves = 0: must be from 1 to 1000"):
        OceanParameters.from_dict({"layers": [{}, {"kind": "RIPPLE", "waves": 0}]})
    with pytest.raises(ParameterError, match="layers = '0 entries of kind WAVES'"):
        OceanParameters.from_dict({"layers": [{"kind": "RIPPLE"}]})


@pytest.mark.parametrize("surface", ["mesh", "exact"])
@pytest.mark.parametrize("patches", [(), (Patch(SIZE, resolution=64),)])
def test_height_queries_under_a_mask(surface: str, patches: tuple[Patch, ...]) -> None:
    layers = Ripple(mask=HARBOUR), Hump(mask=HARBOUR), Hump(x=70.0, height=0.5)
    parameters = sea(*layers, resolution=64, patches=patches)
    height = Ocean(parameters, "double").height_at(X, Y, TIME, surface)
    under = weights((HARBOUR,), SIZE, X, Y).value
    bells = [
        hump.height * TIME * np.exp(-0.5 * ((X - hump.x) ** 2 + (Y - hump.y) ** 2) / hump.width**2)
        for hump in layers[1:]
    ]
    expected = under * (ripple_at(X, TIME, parameters, layers[0]) + bells[0]) + bells[1]
    np.testing.assert_allclose(height, expected, atol=3e-3 if surface == "mesh" else 1e-9)
    assert np.abs(expected).max() > 0.5


def test_the_mask_of_a_sea_lies_over_what_does_not_repeat() -> None:
    bare = sea(Ripple(), Hump(height=0.5))
    found, whole = (
        Ocean(parameters, "double").height_at(X, Y, TIME, "exact")
        for parameters in (bare.replace(mask=HARBOUR, choppiness=0.0), bare.replace(choppiness=0.0))
    )
    np.testing.assert_allclose(found, weights((HARBOUR,), SIZE, X, Y).value * whole, atol=1e-9)


def test_what_does_not_repeat_is_refused_on_a_tile_and_made_elsewhere() -> None:
    ocean = Ocean(sea(Hump()), "double")
    with pytest.raises(ParameterError, match=r"layers\.1 = 'HUMP': .* do not repeat .* an Area or Places"):
        ocean.surface(TIME)
    area = ocean.surface(TIME, ("displacement", "slope", "velocity"), Area(60.0, 12, (5.0, -10.0)))
    x, y = np.meshgrid(5.0 + 5.0 * np.arange(12), -10.0 + 5.0 * np.arange(12))
    bell = 2.0 * np.exp(-0.5 * ((x - 30.0) ** 2 + (y - 20.0) ** 2) / 100.0)
    np.testing.assert_allclose(area.displacement[..., 2], TIME * bell, atol=1e-12)
    np.testing.assert_allclose(area.slope[..., 0], -TIME * bell * (x - 30.0) / 100.0, atol=1e-12)
    np.testing.assert_allclose(area.velocity[..., 2], bell, atol=1e-12)
    far = ocean.surface(TIME, on=Places(30.0 + SIZE, 20.0)).displacement
    np.testing.assert_allclose(far, 0.0, atol=1e-12)
    with pytest.raises(
        ParameterError, match=r"loop_duration = 10: layers\.1 raises waves that do not repeat"
    ):
        sea(Hump(), loop_duration=10)


def test_statistics_know_their_height() -> None:
    wind = WaveLayer(wind_speed=6.0)
    plain = Ocean(sea().replace(layers=(wind,))).statistics()
    with_ripple = Ocean(sea().replace(layers=(wind, Ripple(amplitude=0.4)))).statistics()
    for name in ("spectrum", "resolved", "seed"):
        own, other = (getattr(told, name).m0 for told in (with_ripple, plain))
        # one seed's wave of that length is in its way
        assert own - other == pytest.approx(0.5 * 0.4**2, rel=0.1 if name == "seed" else 1e-6)
        assert own > 1.5 * other
    with_hump = Ocean(sea().replace(layers=(wind, Hump(height=0.3)))).statistics()
    for name in ("spectrum", "resolved", "seed"):
        own, other = (getattr(told, name).m0 for told in (with_hump, plain))
        assert own - other == pytest.approx(0.3**2, rel=1e-6)


def test_foam_knows_their_strains_and_wind() -> None:
    wind = WaveLayer(wind_speed=12.0)
    layers = ((wind,), (wind, Ripple(amplitude=1.0, waves=6)), (wind, Hump()))
    plain, rippled, humped = (Ocean(sea(choppiness=1.0).replace(layers=own)).foam_model for own in layers)
    assert rippled.drift[0] > 2.0 * plain.drift[0]
    assert rippled.drift == pytest.approx((0.6 * np.cos(0.5), 0.6 * np.sin(0.5)))
    assert humped.drift == plain.drift
    assert humped.threshold > 1.05 * plain.threshold
    calm = Ocean(sea(Ripple(amplitude=1.0, waves=6), choppiness=1.0)).foam_model.threshold
    assert 0.05 < calm < 1.0
    foam = Ocean(sea(*layers[2], choppiness=1.0)).surface(TIME, ("foam",), Area(SIZE, 8)).foam
    assert foam.shape == (8, 8)


def test_of_waves_that_nobody_tells_of_statistics_warn() -> None:
    @dataclass(frozen=True)
    class Silent(Contribution):
        kind = "SILENT"
        gives = Gives.COEFFICIENTS
        names = Names(92, "silent", "silent wave", "Silent", "Nobody knows", "NONE")
        muted: bool = muted()

    with registered(Silent):
        assert (
            "Silent: the height of these waves is not known" in Ocean(sea(Silent())).statistics().warnings[0]
        )
        assert not any("Silent" in text for text in Ocean(sea(Silent(muted=True))).statistics().warnings)
    assert not any("is not known" in text for text in Ocean(sea(Ripple())).statistics().warnings)


def test_images_and_layers_of_usd_hold_them(tmp_path, capsys: pytest.CaptureFixture[str]) -> None:
    Usd = pytest.importorskip("pxr.Usd")
    parameters = sea(Ripple(mask=HARBOUR))
    params = tmp_path / "sea.json"
    params.write_text(parameters.to_json())
    own = ["--params", str(params), "--frames", "36", "--out"]
    assert main(["bake", *own, str(tmp_path), "--maps", "disp", "--compression", "ZIP"]) == 0
    (image,) = tmp_path.glob("*/*/*_disp.0036.exr")
    pixels, header = read_image(image)
    assert header["parameters"]["layers"][1]["kind"] == "RIPPLE"
    assert main(["usd", *own, str(tmp_path / "sea.usd"), "--form", "points"]) == 0
    along = SIZE / SAMPLES * np.arange(SAMPLES)
    x, y = np.meshgrid(along, along)
    expected = weights((HARBOUR,), SIZE, x, y).value * ripple_at(x, TIME, parameters, Ripple())
    np.testing.assert_allclose(pixels[..., 2], expected, atol=1e-4)
    stage = Usd.Stage.Open(str(tmp_path / "sea.usd"))
    points = next(
        found
        for prim in stage.Traverse()
        if (attribute := prim.GetAttribute("points")) and (found := attribute.Get(36)) is not None
    )
    heights = np.array(points).reshape(SAMPLES + 1, SAMPLES + 1, 3)[:-1, :-1, 2]
    np.testing.assert_allclose(heights, expected, atol=1e-4)


def test_what_does_not_change_during_a_shot_says_why() -> None:
    animation = Animation(1, (("layers.1.wind_speed", (1.0, 2.0)),))
    with pytest.raises(ParameterError, match=r"layers\.1\.wind_speed.*is constant over a shot"):
        Shot(sea(Ripple()), animation)


def test_kinds_have_numbers_and_names_of_their_own() -> None:
    assert [kind.names.number for kind in shown()] == [0, 1, 2, 3, 4, 90, 91]  # what files of Blender hold
    assert [kind.kind for kind in shown()[:5]] == ["WAVES", "WIND_FIELD", "IMAGE", "HERO_WAVE", "WAKE"]
    for name in ("kind", "former_list"):
        told = [getattr(kind, name) for kind in KINDS if getattr(kind, name)]
        assert len(set(told)) == len(told)


def test_a_bake_of_what_does_not_repeat_is_refused_with_the_remedy(tmp_path, capsys) -> None:
    params = tmp_path / "sea.json"
    params.write_text(sea(Hump()).to_json())
    given = ["--params", str(params), "--frames", "1", "--out"]
    for command in (
        ["bake", *given, str(tmp_path)],
        ["usd", *given, str(tmp_path / "sea.usd"), "--form=clips"],
    ):
        assert main(command) == 2
        (line,) = (line for line in capsys.readouterr().err.splitlines() if "HUMP" in line)
        assert "layers.1 = 'HUMP': its waves do not repeat" in line
        assert "--area on the command line" in line
        assert "or mute the layer" in line
    assert not [path for path in tmp_path.glob("**/*") if path.is_file() and path != params]


AREA = ("--area", "60", "48", "5", "-10")


def bell_at(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 2.0 * np.exp(-0.5 * ((x - 30.0) ** 2 + (y - 20.0) ** 2) / 100.0)


def humped(tmp_path) -> list[str]:
    """What commands are told of a sea with a hump, whose frame 36 is 1.5 s after the start."""
    params = tmp_path / "sea.json"
    params.write_text(sea(Ripple(), Hump(), resolution=64).to_json())
    return ["--params", str(params), "--frames", "35-36"]


def test_images_of_an_area_hold_what_does_not_repeat(tmp_path, capsys) -> None:
    bake = ["bake", *humped(tmp_path), *AREA, "--out", str(tmp_path), "--workers", "1"]
    assert main([*bake, "--maps", "disp,vel,normal,foam"]) == 0
    (image,) = tmp_path.glob("*/*/sea_disp.0036.exr")
    pixels, header = read_image(image)
    assert header["domain_size"] == 60.0
    assert header["area"] == {"size": 60.0, "resolution": 48, "corner": [5.0, -10.0]}
    x, y = np.meshgrid(5.0 + 1.25 * np.arange(48), -10.0 + 1.25 * np.arange(48))
    of_ripple = ripple_at(x, TIME, sea(), Ripple())
    np.testing.assert_allclose(
        pixels[..., 2], TIME * bell_at(x, y) + of_ripple, atol=0.02
    )  # of the mesh's chords
    made = Ocean(sea(Ripple(), Hump(), resolution=64)).surface(
        TIME, ("displacement", "velocity"), Area(60.0, 48, (5.0, -10.0))
    )
    np.testing.assert_allclose(pixels, made.displacement, rtol=2.0**-15, atol=1e-6)
    velocity, _ = read_image(image.with_name("sea_vel.0036.exr"))
    # in steps of 2⁻¹⁰ of the power of two above the largest
    error = 2.0 ** (np.ceil(np.log2(np.abs(made.velocity).max())) - 11.0)
    np.testing.assert_allclose(velocity, made.velocity, rtol=0.0, atol=error)
    folder = image.parent
    capsys.readouterr()
    assert main(["verify", str(folder)]) == 0
    assert "2 frames: 2 whole" in capsys.readouterr().out

    content = image.read_bytes()
    image.unlink()
    (folder / "bake.json").unlink()  # the job is told by the other images
    assert main(["resume", str(folder), "--workers", "1"]) == 0
    assert image.read_bytes() == content
    assert main(["verify", str(folder)]) == 0


def test_verify_sees_an_area_that_is_elsewhere(tmp_path, capsys) -> None:
    bake = ["bake", *humped(tmp_path), "--out", str(tmp_path), "--workers", "1", "--area", "60", "48"]
    for corner in ((), ("5", "0")):
        assert main([*bake, *corner]) == 0
    here, elsewhere = sorted(tmp_path.glob("*/v*"))
    for path in (*elsewhere.glob("*.exr"), *elsewhere.glob("records/*")):
        path.replace(here / path.relative_to(elsewhere))
    capsys.readouterr()
    assert main(["verify", str(here)]) == 1
    assert "frame 35 is stale: it was made from other parameters" in capsys.readouterr().out


def test_layers_of_usd_show_an_area_at_its_place(tmp_path) -> None:
    Usd = pytest.importorskip("pxr.Usd")
    from ocean_tweak.export.usd.verify import verify

    layer = tmp_path / "sea.usd"
    given = ["usd", *humped(tmp_path), *AREA, "--out", str(layer), "--variants", "48,24", "--proxy", "12"]
    for form in ("points", "clips"):
        assert main([*given, "--form", form, "--force"]) == 0
        stage = Usd.Stage.Open(str(layer))
        stage.Reload()
        for mesh, quads in (("surface", 48), ("proxy", 12)):
            prim = stage.GetPrimAtPath(f"/sea/geo/sea/{mesh}")
            points = np.array(prim.GetAttribute("points").Get(36)).reshape(quads + 1, quads + 1, 3)
            along = 60.0 / quads * np.arange(quads + 1)
            x, y = np.meshgrid(5.0 + along, -10.0 + along)
            np.testing.assert_allclose(points[..., :2], np.stack([x, y], axis=-1), atol=1e-5)
            expected = TIME * bell_at(x, y) + ripple_at(x, TIME, sea(), Ripple())
            np.testing.assert_allclose(points[..., 2], expected, atol=0.02)
            extent = np.array(prim.GetAttribute("extent").Get(36))
            np.testing.assert_allclose(extent[:, :2], [[5.0, -10.0], [65.0, 50.0]], atol=1e-5)
        assert list(verify(layer, (36,))) == []


def test_images_of_an_area_move_layers_of_usd(tmp_path, capsys) -> None:
    Usd = pytest.importorskip("pxr.Usd")
    from ocean_tweak.export.usd.verify import verify

    given = humped(tmp_path)
    assert main(["bake", *given, *AREA, "--out", str(tmp_path), "--workers", "1"]) == 0
    (folder,) = tmp_path.glob("sea-*/v*")
    for name, source, size in (("own", [*given, *AREA], 60.0), ("of", ["--bake", str(folder)], 58.75)):
        layer = tmp_path / name / f"{name}.usd"
        assert main(["usd", *source, "--form", "displacement", "--out", str(layer)]) == 0
        assert list(verify(layer)) == []
        stage = Usd.Stage.Open(str(layer))
        surface = stage.GetPrimAtPath(f"/{name}/geo/sea/surface")
        points, st = (np.array(surface.GetAttribute(key).Get()) for key in ("points", "primvars:st"))
        np.testing.assert_allclose(points[[0, -1], :2], [[5.0, -10.0], [5.0 + size, size - 10.0]], atol=1e-5)
        texels = round(size / 1.25) + 1  # each vertex in the middle of its own
        np.testing.assert_allclose(st[[0, 1, -1], 0] * texels, [0.5, 1.5, texels - 0.5], atol=1e-4)
    assert main(["usd", "--bake", str(folder), *AREA, "--form=displacement", "--out", str(layer)]) == 2
    assert "--area: the bake" in capsys.readouterr().err
    assert main(["usd", *given, *AREA, "--tiles=2x1", "--form=clips", "--out", str(layer)]) == 2
    assert "tiles = (2, 1): must be 1x1 of an area" in capsys.readouterr().err


def test_a_farm_bakes_the_same_area(tmp_path, capsys) -> None:
    given = humped(tmp_path)
    area = ["--area", "60", "48", "-0.00001", "-1000"]
    assert main(["job", *given, *area, "--out", str(tmp_path / "job")]) == 0
    steps = json.loads((tmp_path / "job" / "template.json").read_text())["steps"]
    for step in steps:
        words = step["script"]["actions"]["onRun"]["args"]
        place = words.index("--area")
        assert words[place : place + 5] == area
    for words, problem in (
        (("60",), "must be SIZE SAMPLES"),
        (("60", "48", "1"), "must be SIZE SAMPLES"),
        (("0", "48"), "size = 0.0: must be a length above 0 m"),
        (("60", "1"), "resolution = 1: must be from 2 to 8192 samples"),
        (("60", "48", "nan", "0"), "corner = (nan, 0.0): must be x and y in m"),
    ):
        assert main(["bake", *given, "--area", *words, "--out", str(tmp_path)]) == 2
        assert problem in capsys.readouterr().err


def test_what_does_not_repeat_alone_ends_softly_in_an_area() -> None:
    parameters = sea(Ripple(), Hump())
    assert repeating(sea(Ripple())) == sea(Ripple())
    assert Ocean(repeating(parameters), "double").height_at(30.0, 20.0, TIME) == pytest.approx(
        Ocean(sea(Ripple()), "double").height_at(30.0, 20.0, TIME)
    )
    area = Area(202.0, 101, (-70.0, -80.0))
    fields = placed_fields(parameters, area, TIME)
    x, y = area.rest_positions()
    z = fields.displacement[..., 2]
    inner = slice(11, -11)  # beyond a tenth along each side
    np.testing.assert_allclose(z[inner, inner], TIME * bell_at(x, y)[inner, inner], atol=1e-5)
    np.testing.assert_allclose(fields.velocity[inner, inner, 2], bell_at(x, y)[inner, inner], atol=1e-5)
    for edge in (z[0], z[-1], z[:, 0], z[:, -1]):
        assert np.all(edge == 0.0)
    near = placed_fields(parameters, Area(40.1, 401, (10.0, 0.0)), TIME)  # its rim is across the hump
    inner = slice(41, -41)
    x, y = np.meshgrid(10.0 + 0.1 * np.arange(401), 0.1 * np.arange(401))
    z = near.displacement[..., 2]
    np.testing.assert_allclose(z[inner, inner], TIME * bell_at(x, y)[inner, inner], atol=1e-5)
    numbers = np.gradient(near.displacement[..., 2].astype(np.float64), 0.1)
    assert np.abs(numbers).max() > 0.2
    for along, number in ((0, numbers[1]), (1, numbers[0])):
        np.testing.assert_allclose(near.slope[1:-1, 1:-1, along], number[1:-1, 1:-1], atol=0.01)
