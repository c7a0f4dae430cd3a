# SPDX-License-Identifier: GPL-3.0-or-later
"""The gallery's moving pictures close without a jump."""

import importlib.util

import numpy as np
import pytest

from tools.project import ROOT

pytest.importorskip("PIL.Image")


@pytest.fixture(scope="module")
def cross_fade():
    spec = importlib.util.spec_from_file_location("cross_fade", ROOT / "examples" / "cross_fade.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def frames():
    """Waves of five lengths that run at speeds of their own, none of which closes in 24 frames."""
    x, y = np.meshgrid(np.arange(96.0), np.arange(40.0))
    moving = []
    for number in range(30):
        seconds = number / 12.0
        water = sum(
            np.cos(2.0 * np.pi * ((x + 0.3 * step * y) / length - seconds * (1.25 / length**0.5)) + step)
            for step, length in enumerate((7.0, 11.0, 17.0, 29.0, 47.0))
        )
        moving.append(np.clip(127.0 + 25.0 * water, 0, 255))
    return np.repeat(np.array(moving, np.uint8)[..., np.newaxis], 3, axis=-1)


def test_the_seam_is_no_larger_a_step_than_those_between_other_frames(cross_fade, frames):
    loop = cross_fade.closed(frames, 6)
    assert loop.shape == (24, 40, 96, 3)
    seam, *others = cross_fade.steps(loop)
    assert seam <= max(others)
    # nor is any step of the blend a cut
    assert max(others) < 0.6 * cross_fade.steps(frames[:24])[0]


def test_what_is_not_blended_is_as_it_was_rendered(cross_fade, frames):
    loop = cross_fade.closed(frames, 6)
    np.testing.assert_array_equal(loop[:18], frames[6:24])
    # halfway through a fade over five frames
    expected = (frames[2].astype(float) + frames[27]) / 2.0
    np.testing.assert_allclose(cross_fade.closed(frames, 5)[22], expected, atol=0.51)


def test_a_fade_longer_than_the_loop_is_refused(cross_fade, frames):
    with pytest.raises(ValueError, match="30 frames, 15 of them to fade"):
        cross_fade.closed(frames, 15)


def test_the_file_plays_for_ever_and_stays_below_its_limit(cross_fade, frames, tmp_path):
    from PIL import Image

    path = tmp_path / "loop.webp"
    loop = cross_fade.closed(frames, 6)
    best = cross_fade.save_webp(loop, path, 12.0, 1_000_000)
    whole = path.stat().st_size
    assert cross_fade.save_webp(loop, path, 12.0, whole) < best
    assert path.stat().st_size < whole
    with Image.open(path) as image:
        assert (image.n_frames, image.info["loop"], image.size) == (24, 0, (96, 40))
        durations = []
        for number in range(24):
            image.seek(number)
            image.load()
            durations.append(image.info["duration"])
    assert sum(durations) == 2000
    with pytest.raises(RuntimeError, match="stays above 100 bytes"):
        cross_fade.save_webp(loop, path, 12.0, 100)
