# SPDX-License-Identifier: GPL-3.0-or-later
"""EXR images: what is written is what is read, precise, whole or absent."""

from __future__ import annotations

import threading
from fractions import Fraction
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from ocean_tweak.core import Ocean, OceanParameters, Timing, WaveLayer
from ocean_tweak.core.synthesis.channels import MAPS, channels_of, image_of
from ocean_tweak.export import files
from ocean_tweak.export.exr import COMPRESSION_ERROR, ExrError, ExrSequence, read_image, silenced, write_image

FPS = Fraction(24000, 1001)


@pytest.fixture
def image() -> np.ndarray:
    return np.random.default_rng(0).normal(scale=5.0, size=(32, 32, 3)).astype(np.float32)


@pytest.mark.parametrize("compression", COMPRESSION_ERROR)
def test_round_trip_within_the_documented_error(tmp_path: Path, image: np.ndarray, compression: str) -> None:
    path = tmp_path / "sea_disp.0001.exr"
    write_image(path, image, {"frame": 1}, FPS, compression)
    again, metadata = read_image(path)
    assert metadata == {"frame": 1}
    assert again.dtype == np.float32
    np.testing.assert_allclose(again, image, rtol=COMPRESSION_ERROR[compression])


def test_rows_are_top_down_in_the_file(tmp_path: Path, image: np.ndarray) -> None:
    path = tmp_path / "a.exr"
    write_image(path, image[:, ::-1], {}, FPS, "ZIP")  # a view with a negative stride
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels, header = file.channels(), dict(file.header())
        names, red = sorted(channels), channels["R"].pixels
    np.testing.assert_array_equal(red, image[::-1, ::-1, 0])
    assert names == ["B", "G", "R"]
    assert header["framesPerSecond"] == FPS
    assert header["colorInteropID"] == "data"


def test_sequence_names_frames_and_keeps_parameters(tmp_path: Path) -> None:
    parameters = OceanParameters(resolution=16, timing=Timing(start_frame=1001))
    sink = ExrSequence(tmp_path, "sea", parameters)
    (path,) = sink.write(1013, Ocean(parameters).frame(1013))
    assert path == tmp_path / "sea_disp.1013.exr"
    pixels, metadata = read_image(path)
    assert OceanParameters.from_dict(metadata["parameters"]) == parameters
    assert metadata["time"] == 0.5
    np.testing.assert_allclose(pixels, Ocean(parameters).surface(0.5).displacement, rtol=2.0**-16)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_a_failed_write_leaves_the_old_file(
    tmp_path: Path, image: np.ndarray, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.exr"
    write_image(path, image, {}, FPS)
    before = path.read_bytes()

    def full_disk(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files.os, "fsync", full_disk)
    with pytest.raises(OSError, match="No space"):
        write_image(path, 2 * image, {}, FPS)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a.exr"]


@pytest.mark.parametrize("compression", COMPRESSION_ERROR)
def test_bytes_that_the_disk_refuses_are_missed(tmp_path: Path, image: np.ndarray, compression: str) -> None:
    """Wherever writing ends, also among the last bytes, which wait in a buffer."""
    resource = pytest.importorskip("resource")
    path = tmp_path / "a.exr"
    write_image(path, image, {}, FPS, compression)
    whole = path.stat().st_size
    path.unlink()
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    for most in (0, 1, 4096, whole // 2, whole - 4096, whole - 100, whole - 1):
        try:
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, before[1]))
            with pytest.raises(OSError, match="too large") as raised:
                write_image(path, image, {}, FPS, compression)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)
        assert raised.value.filename == str(path)
        assert list(tmp_path.iterdir()) == []


def test_another_shape_is_not_read(tmp_path: Path, image: np.ndarray) -> None:
    path = tmp_path / "a.exr"
    write_image(path, image, {}, FPS)
    assert read_image(path, (32, 32))[0].shape == (32, 32, 3)
    with pytest.raises(ExrError, match="32 x 32 texels, not 32 x 64"):
        read_image(path, (64, 32))


def test_values_that_are_not_finite_are_refused(tmp_path: Path, image: np.ndarray) -> None:
    image[3, 4, 1] = np.nan
    with pytest.raises(ExrError, match="not finite"):
        write_image(tmp_path / "a.exr", image, {}, FPS)
    assert not list(tmp_path.iterdir())


def test_damaged_and_foreign_files_are_named(tmp_path: Path, image: np.ndarray) -> None:
    whole = tmp_path / "whole.exr"
    write_image(whole, image, {}, FPS)
    truncated = tmp_path / "truncated.exr"
    truncated.write_bytes(whole.read_bytes()[:-2000])
    foreign = tmp_path / "foreign.exr"
    OpenEXR.File({}, {"Y": np.zeros((4, 4), np.float32)}).write(str(foreign))
    for path in (truncated, foreign, tmp_path / "absent.exr"):
        with pytest.raises(ExrError, match=path.name):
            read_image(path)


def test_maps_hold_what_they_say(tmp_path: Path) -> None:
    parameters = OceanParameters(resolution=32, domain_size=100.0, layers=(WaveLayer(wind_speed=25.0),))
    sink = ExrSequence(tmp_path, "sea", parameters, "ZIP", tuple(MAPS))
    fields = Ocean(parameters).frame(30, sink.outputs)
    paths = sink.write(30, fields)
    assert fields.breaking.max() > 0.1
    assert fields.foam_age.max() > 1.0
    names = "disp foam normal vel slope strain foam_age hs qb direction"
    assert [path.name for path in paths] == [f"sea_{name}.0030.exr" for name in names.split()]
    images = {name: read_image(sink.path(30, name)) for name in MAPS}
    np.testing.assert_array_equal(images["disp"][0], fields.displacement)
    np.testing.assert_array_equal(images["normal"][0], fields.normal)
    np.testing.assert_array_equal(images["vel"][0], fields.velocity)
    np.testing.assert_array_equal(images["foam"][0][..., 0], fields.foam)
    np.testing.assert_array_equal(images["foam"][0][..., 1], fields.cusp)
    np.testing.assert_array_equal(images["foam"][0][..., 2], fields.breaking)
    np.testing.assert_array_equal(images["foam_age"][0][..., 0], fields.foam_age)
    assert not np.any(images["foam_age"][0][..., 1:])
    np.testing.assert_array_equal(images["slope"][0][..., :2], fields.slope)
    assert not np.any(images["slope"][0][..., 2])
    np.testing.assert_array_equal(images["hs"][0][..., 0], fields.significant_height)
    np.testing.assert_array_equal(images["qb"][0][..., 0], fields.broken_share)
    np.testing.assert_array_equal(images["direction"][0][..., :2], fields.mean_direction)
    np.testing.assert_array_equal(images["strain"][0], fields.strain)
    assert {name: metadata["unit"] for name, (_, metadata) in images.items()} == {
        "disp": "m", "foam": "1", "normal": "1", "vel": "m/s", "slope": "1", "strain": "1",
        "foam_age": "s", "hs": "m", "qb": "1", "direction": "1",
    }  # fmt: skip
    assert images["vel"][1]["map"] == "vel"


def test_what_is_printed_is_found_again_after_threads_that_read_at_once(
    capsys: pytest.CaptureFixture[str],
) -> None:
    entered, may_leave = [threading.Event(), threading.Event()], [threading.Event(), threading.Event()]

    def read(number: int) -> None:
        with silenced():
            entered[number].set()
            may_leave[number].wait(60.0)

    threads = [threading.Thread(target=read, args=(number,)) for number in range(2)]
    for thread, inside in zip(threads, entered, strict=True):
        thread.start()
        assert inside.wait(60.0)
    for thread, leave in zip(threads, may_leave, strict=True):  # the first to come is the first to go
        leave.set()
        thread.join()
    print("heard")
    assert capsys.readouterr().out == "heard\n"
    with silenced():
        print("of a library")
    assert capsys.readouterr().out == ""


def test_maps_of_which_less_is_enough_have_16_bits_and_err_by_no_more_than_told(tmp_path: Path) -> None:
    parameters = OceanParameters(resolution=64, layers=(WaveLayer(wind_speed=20.0),))
    maps = ("disp", "foam", "normal", "vel", "slope")
    fields = Ocean(parameters).surface(2.0, channels_of(maps))
    for encoding, compression in ((2, "PXR24"), (1, "PXR24"), (2, "ZIP")):
        sink = ExrSequence(tmp_path, "sea", parameters, compression, maps, encoding=encoding)
        sink.write(1, fields)
        for name in maps:
            halved = (encoding, compression) == (2, "PXR24") and name not in ("disp", "slope")
            with OpenEXR.File(str(sink.path(1, name)), separate_channels=True) as file:
                assert file.channels()["R"].pixels.dtype == (np.float16 if halved else np.float32), name
            pixels, _ = read_image(sink.path(1, name))
            wanted = image_of(name, fields).astype(np.float64)
            largest = np.abs(wanted).max(axis=(0, 1), keepdims=True)
            # 2^-11 of the power of two above the largest number, which is less than twice as large
            allowed = 2.0**-10 * largest if halved else 2.0**-16 * np.abs(wanted)
            assert np.all(np.abs(pixels - wanted) <= allowed), name
    normals = read_image(sink.path(1, "normal"))[0]
    np.testing.assert_array_equal(normals, fields.normal)  # ZIP loses nothing


def test_what_16_bits_cannot_hold_is_refused(tmp_path: Path) -> None:
    parameters = OceanParameters(resolution=16)
    sink = ExrSequence(tmp_path, "sea", parameters, maps=("vel",))
    fields = Ocean(parameters).surface(0.0, {"velocity"})
    fields.velocity[3, 4, 1] = 7e4
    with pytest.raises(ExrError, match="the image holds 70000, and 16 bits hold at most 65504"):
        sink.write(1, fields)
    for number in (65504.0, 0.0, 1e-30):  # the largest that they hold, and two that are nothing in them
        fields.velocity[...] = number
        sink.write(1, fields)
        assert (read_image(sink.path(1, "vel"))[0] == round(number)).all()
