# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of hulls in place of a wake's footprint."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.core import ParameterError
from ocean_tweak.export.meshes import read_mesh
from ocean_tweak.export.sea_files import read_sea

#: of a barge: m, from stern to bow, across, and from keel to deck; its bow is half as wide
LENGTH, BEAM, DEPTH, DRAUGHT = 40.0, 8.0, 5.0, 3.0
CORNERS = [
    (x, y * half, z)
    for z in (-DRAUGHT, DEPTH - DRAUGHT)
    for x, half in ((-0.5 * LENGTH, 0.5 * BEAM), (0.5 * LENGTH, 0.25 * BEAM))
    for y in (-1.0, 1.0)
]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 2, 6, 4), (1, 5, 7, 3), (0, 4, 5, 1), (2, 3, 7, 6)]


def obj(corners: list[tuple[float, ...]] = CORNERS) -> bytes:
    lines = ["# a barge", *(f"v {x} {y} {z}" for x, y, z in corners), "vn 0 0 1"]
    lines += ["f " + " ".join(f"{each + 1}//1" for each in face) for face in FACES[:3]]
    lines += ["f " + " ".join(str(each - len(corners)) for each in face) for face in FACES[3:]]
    return "\n".join(lines).encode()


def ply(form: str) -> bytes:
    head = [
        "ply", f"format {form} 1.0", "comment a barge", "element vertex 8", "property float x",
        "property float y", "property double z", "property uchar red", "element face 6",
        "property list uchar int vertex_indices", "end_header\n",
    ]  # fmt: skip
    if form == "ascii":
        rows = [f"{x} {y} {z} 200" for x, y, z in CORNERS]
        rows += [" ".join(map(str, (4, *face))) for face in FACES]
        return ("\n".join(head) + "\n".join(rows)).encode()
    order = "<" if "little" in form else ">"
    body = b"".join(struct.pack(order + "ffdB", *corner, 200) for corner in CORNERS)
    body += b"".join(struct.pack(order + "B4i", 4, *face) for face in FACES)
    return "\n".join(head).encode() + body


def sea_with(folder: Path, **reference: object) -> Path:
    path = folder / "sea.json"
    wake = {"kind": "WAKE", "path": [{"time": 0}, {"time": 30, "x": 200}], "area_size": 512,
            "area_resolution": 512, "footprint": reference}  # fmt: skip
    path.write_text(json.dumps({"resolution": 32, "layers": [{"wind_speed": 5}, wake]}))
    return path


def with_face(face: bytes, before: bytes = b"") -> bytes:
    """A PLY file of a triangle's three vertices and one face; before : properties of it, before its list."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4").tobytes()
    axes = b"".join(b"property float %c\n" % axis for axis in b"xyz")
    return (
        b"ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + axes + b"element face 1\n" + before
        + b"property list char int vertex_indices\nend_header\n" + vertices + face
    )  # fmt: skip


def test_a_face_may_have_other_properties_before_its_vertices(tmp_path: Path) -> None:
    corners = b"\x03" + np.array([2, 0, 1], "<i4").tobytes()
    (tmp_path / "a.ply").write_bytes(with_face(b"\x07" + corners, b"property uchar flags\n"))
    assert read_mesh(tmp_path / "a.ply").triangles.tolist() == [[2, 0, 1]]


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_ply_and_obj_hold_the_same_mesh(form: str, tmp_path: Path) -> None:
    (tmp_path / "barge.obj").write_bytes(obj())
    (tmp_path / "barge.ply").write_bytes(ply(form))
    one, other = (read_mesh(tmp_path / f"barge.{ending}") for ending in ("obj", "ply"))
    np.testing.assert_array_equal(one.vertices, CORNERS)
    np.testing.assert_allclose(other.vertices, CORNERS, atol=1e-6)
    np.testing.assert_array_equal(one.triangles, other.triangles)
    assert one.triangles.shape == (12, 3)


def test_a_hull_gives_its_size_and_shape(tmp_path: Path) -> None:
    """What the barge displaces is three quarters of its box, and its bow half as wide as its stern."""
    (tmp_path / "barge.obj").write_bytes(obj())
    wake = read_sea(sea_with(tmp_path, file="barge.obj")).parameters.layers[1]
    assert (wake.length, wake.beam, wake.draught) == pytest.approx((LENGTH, BEAM, DRAUGHT))
    shares = wake.footprint.values[..., 0]
    assert shares.mean() == pytest.approx(0.75, abs=0.02)
    assert shares[:, 0].mean() == pytest.approx(1.0, abs=0.06)
    assert shares[:, -1].mean() == pytest.approx(0.5, abs=0.06)


def test_another_waterline_unit_and_axes(tmp_path: Path) -> None:
    """In centimetres, y up, with its bow along what is then -y, and a metre deeper in the water."""
    turned = [(-100.0 * y, 100.0 * z, 100.0 * x) for x, y, z in CORNERS]
    (tmp_path / "barge.obj").write_bytes(obj(turned))
    given = {"file": "barge.obj", "scale": 0.01, "up": "y", "forward": "-y", "waterline": 100.0}
    wake = read_sea(sea_with(tmp_path, **given)).parameters.layers[1]
    assert (wake.length, wake.beam, wake.draught) == pytest.approx((LENGTH, BEAM, DRAUGHT + 1.0))
    assert wake.footprint.values[:, -1, 0].mean() == pytest.approx(0.5, abs=0.06)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"waterline": -4.0}, "1 m above the waterline"),
        ({"up": "x"}, "must be one of z, y"),
        ({"up": ["z"]}, "must be one of z, y"),
        ({"forward": "z"}, "must be one of x, y, -x, -y"),
        ({"scale": 0}, "must be a number from 1e-06"),
        ({"axes": "yx"}, "unknown key"),
        ({"file": "gone.obj"}, "cannot be read"),
    ],
)
def test_what_is_no_hull_is_told_with_its_path(change: dict[str, object], told: str, tmp_path: Path) -> None:
    (tmp_path / "barge.obj").write_bytes(obj())
    with pytest.raises(ParameterError, match=told) as error:
        read_sea(sea_with(tmp_path, **{"file": "barge.obj"} | change))
    assert error.value.field.startswith("layers.1.footprint.")


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.obj", b"v 0 0 0\nf 1 2 3\n"),
        ("a.obj", b"v 0 0\n"),
        ("a.obj", b"f a b c\n"),
        ("a.obj", b"v 0 0 0\nf 1 1 99999999999999999999\n"),
        ("a.obj", b""),
        ("a.ply", ply("ascii")[:-20]),
        ("a.ply", ply("binary_little_endian")[:-5]),
        ("a.ply", b"ply\nformat text 1.0\nend_header\n"),
        ("a.ply", ply("ascii").replace(b"float x", b"half x")),
        ("a.ply", b"solid\n"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement face 1\nend_header\n"),
        ("a.ply", with_face(b"\xff" + bytes(12))),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 99999999\nproperty float x\nend_header\n"),
    ],
)
def test_damaged_meshes_are_refused(name: str, content: bytes, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(ParameterError, match="is no mesh that can be read"):
        read_mesh(path)
