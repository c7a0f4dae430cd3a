# SPDX-License-Identifier: GPL-3.0-or-later
"""What the Solid view of a window shows of water and foam, in its own pixels."""

import numpy as np
import pytest

LOOK = """
with over('WINDOW'):
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    bpy.ops.mesh.ocean_tweak_add()
    ocean().viewport_resolution = 128
    ocean().layers[0].wind_speed = 24.0
    area().spaces.active.overlay.show_overlays = False
    area().spaces.active.show_gizmo = False
    view = area().spaces.active.region_3d
    view.view_perspective, view.view_distance = 'ORTHO', 180.0
    view.view_rotation, view.view_location = (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
"""
SHARE = (
    "(lambda mesh: sum(mesh.materials[face.material_index].diffuse_color[0] > 0.8 for face in mesh.polygons)"
    " / len(mesh.polygons))(evaluated_ocean())"
)


@pytest.fixture
def seen(hand):
    """(rows, columns, 3) colors of the middle of the view, from above."""
    hand.ask(f"run({LOOK!r})")
    hand.wait("is_refining()", False)

    def look(name):
        picture = np.asarray(hand.keep(name), float) / 255.0
        left, top, width, height = (int(part) for part in hand.ask("box('WINDOW')"))
        whole = picture[top : top + height, left : left + width]
        rows, columns = (slice(int(0.3 * side), int(0.7 * side)) for side in whole.shape[:2])
        return whole[rows, columns]

    return look


def test_water_is_blue_and_foam_white(hand, seen):
    shading = "area().spaces.active.shading"
    before = hand.ask(f"[{shading}.type, {shading}.color_type, {shading}.light]")
    pixels = seen("solid-foam")
    blue = pixels[..., 2] - pixels[..., 0] > 0.05
    white = (np.ptp(pixels, axis=-1) < 0.06) & (pixels.mean(axis=-1) > 0.4)
    share = hand.ask(SHARE)
    assert 0.005 < share < 0.3
    assert blue.mean() > 0.5
    assert white.mean() == pytest.approx(share, abs=0.5 * share + 0.01)
    assert hand.ask(f"[{shading}.type, {shading}.color_type, {shading}.light]") == before
    hand.ask("setattr(ocean(), 'use_foam', False)")
    assert seen("solid-without-foam")[..., 2].min() > 0.1  # no black water
