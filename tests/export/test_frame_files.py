# SPDX-License-Identifier: GPL-3.0-or-later
"""The names of baked files, as other programs hold on to them."""

from fractions import Fraction

import pytest

from ocean_tweak.core.synthesis.channels import MAPS
from ocean_tweak.export.frame_files import POINTS, SMALL_POINTS, files_start, frame_file, image_file_of


@pytest.mark.parametrize(
    ("file", "told"),
    [
        ("sea_disp.0001.exr", ("sea", "disp", 1)),
        ("sea_p2_vel.0100.exr", ("sea", "vel", 100, 2)),
        ("sea_foam.-001.exr", ("sea", "foam", -1)),
        ("sea_strain.12345.exr", ("sea", "strain", 12345)),
        ("sea_disp.0001.5.exr", ("sea", "disp", Fraction(3, 2))),
        ("a sea_p1_points.0007.ply", ("a sea", POINTS, 7, 1)),
        ("a sea_p1_small_points.0007.ply", ("a sea", SMALL_POINTS, 7, 1)),
    ],
)
def test_names_of_files(file, told):
    assert frame_file(*told) == file
    name, map_name, _, *patch = told
    assert file.startswith(files_start(name, map_name, *patch))


@pytest.mark.parametrize("frame", [-1_000_000, -1, 0, 1, 9999, 10_000])
@pytest.mark.parametrize("map_name", MAPS)
def test_names_of_images_are_read_back(map_name, frame):
    for name in ("sea", "sea_p2", "a_disp.0001", "sea_disp"):
        assert image_file_of(frame_file(name, map_name, frame)) == (name, map_name, frame)
    assert image_file_of(frame_file("sea", map_name, frame, patch=3)) == ("sea_p3", map_name, frame)


@pytest.mark.parametrize(
    "file",
    ["sea_disp.1.exr", "sea_disp.0001.png", "sea_other.0001.exr", "_disp.0001.exr", "sea_disp.0001.5.exr",
     "sea_disp.-01.exr", "sea_p1_points.0001.ply", "disp.0001.exr"],
)  # fmt: skip
def test_other_names_are_none(file):
    assert image_file_of(file) is None
