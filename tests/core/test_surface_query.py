# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface above a place, against forward evaluation, brute force and a single wave."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize

from ocean_tweak.core import Ocean, OceanParameters, WaveLayer
from ocean_tweak.core.sea.query import inside_quad, newton
from ocean_tweak.core.sea.surfaces import Values

SEA = OceanParameters(resolution=128, domain_size=200.0, seed=3)
GENERATOR = np.random.default_rng(5)


def test_samples_are_found_where_they_went() -> None:
    """Forward: sample (i, j) is at (x + Dx, y + Dy) with height h; asking there gives h back."""
    ocean = Ocean(SEA)
    fields = ocean.surface(4.0, {"displacement", "min_eigenvalue", "velocity"})
    i, j = GENERATOR.integers(0, 128, (2, 500))
    spacing = 200.0 / 128
    moved = fields.displacement[i, j].astype(float)
    points = ocean.points_at(j * spacing + moved[:, 0], i * spacing + moved[:, 1], 4.0, velocity=True)
    assert np.min(fields.min_eigenvalue) > 0.2
    assert np.all(points.found)
    np.testing.assert_allclose(points.height, moved[:, 2], atol=1e-3)
    np.testing.assert_allclose(points.velocity, fields.velocity[i, j], atol=1e-3)
    np.testing.assert_allclose(points.rest, np.stack([j, i], -1) * spacing, atol=1e-3)


def test_mesh_surface_against_brute_force() -> None:
    """Each quad of the mesh sampled finely: the nearest of those points has the height that is asked for."""
    ocean = Ocean(SEA.replace(resolution=32))
    spacing = 200.0 / 32
    d = ocean.surface(1.0).displacement.astype(float)
    d = np.concatenate([d, d[:1]], 0)
    d = np.concatenate([d, d[:, :1]], 1)
    fine = np.linspace(0.0, 32.0, 32 * 24, endpoint=False)
    cell = fine.astype(int)
    u = (fine - cell)[:, np.newaxis]
    along_y = d[cell] * (1 - u[..., np.newaxis]) + d[cell + 1] * u[..., np.newaxis]
    surface = along_y[:, cell] * (1 - u) + along_y[:, cell + 1] * u
    X, Y = np.meshgrid(fine * spacing, fine * spacing)
    x, y = GENERATOR.uniform(40.0, 160.0, (2, 60))
    heights = ocean.height_at(x, y, 1.0)
    for place_x, place_y, height in zip(x, y, heights, strict=True):
        distance = np.hypot(X + surface[..., 0] - place_x, Y + surface[..., 1] - place_y)
        nearest = np.argmin(distance)
        assert height == pytest.approx(
            surface[..., 2].ravel()[nearest], abs=1.5 * distance.ravel()[nearest] + 1e-3
        )


def test_places_repeat_with_the_domain() -> None:
    ocean = Ocean(SEA)
    x, y = GENERATOR.uniform(0.0, 200.0, (2, 50))
    np.testing.assert_allclose(
        ocean.height_at(x + 400.0, y - 200.0, 2.0), ocean.height_at(x, y, 2.0), atol=1e-4
    )
    assert ocean.height_at(3.0, 4.0, 2.0).shape == ()
    assert ocean.height_at(x.reshape(5, 10), y.reshape(5, 10), 2.0).shape == (5, 10)


def test_normal_is_that_of_the_surface_seen_from_above() -> None:
    ocean = Ocean(SEA)
    x, y = GENERATOR.uniform(0.0, 200.0, (2, 200))
    points = ocean.points_at(x, y, 2.0, surface="exact")
    step = 1e-3
    slope_x, slope_y = (
        (ocean.height_at(x + dx, y + dy, 2.0, "exact") - ocean.height_at(x - dx, y - dy, 2.0, "exact"))
        / (2 * step)
        for dx, dy in ((step, 0.0), (0.0, step))
    )
    np.testing.assert_allclose(-points.normal[:, 0] / points.normal[:, 2], slope_x, atol=2e-4)
    np.testing.assert_allclose(-points.normal[:, 1] / points.normal[:, 2], slope_y, atol=2e-4)
    np.testing.assert_allclose(np.linalg.norm(points.normal, axis=-1), 1.0)


def test_exact_surface_is_what_finer_meshes_tend_to() -> None:
    """The band-limited surface between samples: a sea of the same waves with eight times the samples."""
    band = WaveLayer(shortest_wavelength=14.0)
    coarse = Ocean(SEA.replace(resolution=64, layers=(band,)))
    fine = Ocean(SEA.replace(resolution=1024, layers=(band,)))
    x, y = GENERATOR.uniform(0.0, 200.0, (2, 100))
    exact = coarse.points_at(x, y, 3.0, "exact", velocity=True)
    reference = fine.points_at(x, y, 3.0, velocity=True)
    np.testing.assert_allclose(exact.height, reference.height, atol=2e-3)
    np.testing.assert_allclose(exact.velocity, reference.velocity, atol=5e-3)
    assert np.max(np.abs(coarse.height_at(x, y, 3.0) - exact.height)) > 5e-3


def test_the_highest_sheet_of_a_fold() -> None:
    ocean = Ocean(SEA.replace(choppiness=4.0))
    fields = ocean.surface(1.0, {"displacement", "min_eigenvalue"})
    assert np.min(fields.min_eigenvalue) < -0.2
    i, j = np.nonzero(fields.min_eigenvalue < 0.0)
    spacing = 200.0 / 128
    moved = fields.displacement[i, j].astype(float)
    heights = ocean.height_at(j * spacing + moved[:, 0], i * spacing + moved[:, 1], 1.0)
    assert np.mean(heights >= moved[:, 2] - 1e-3) > 0.99
    assert np.any(heights > moved[:, 2] + 1e-3)


def test_what_cannot_be_asked_is_said() -> None:
    with pytest.raises(ValueError, match="surface = 'nurbs'"):
        Ocean(SEA).height_at(0.0, 0.0, 1.0, "nurbs")
    with pytest.raises(ValueError, match="trough damping"):
        Ocean(SEA.replace(trough_damping=0.5)).height_at(0.0, 0.0, 1.0, "exact")
    assert np.all(np.isfinite(Ocean(SEA.replace(trough_damping=0.5)).height_at([0.0, 5.0], 1.0, 1.0)))


@pytest.mark.parametrize("steepness", [0.5, 0.9, 0.97])
def test_crests_that_are_nearly_folded_are_met(steepness: float) -> None:
    """One trochoidal wave: above x is the water whose angle E at rest solves Kepler's E - e sin E = kx."""
    k, places = 2.0 * np.pi / 20.0, np.linspace(0.0, 20.0, 401)

    def trochoid(x: np.ndarray, _y: np.ndarray, _velocity: bool) -> tuple[Values, None]:
        sine, cosine, zero = np.sin(k * x), np.cos(k * x), np.zeros_like(x)
        amplitude = steepness / k
        value = np.stack((-amplitude * sine, zero, amplitude * cosine), axis=1)
        by_x = np.stack((-steepness * cosine, zero, -steepness * sine), axis=1)
        return Values(value, by_x, np.zeros_like(value)), None

    def rest(place: float) -> float:
        return optimize.brentq(lambda E: E - steepness * np.sin(E) - k * place, -0.1, 6.4, xtol=1e-13) / k

    expected = [rest(place) for place in places]
    for spacing in (1.0, 0.1, 0.03):
        found_x, _, met = newton(places, np.zeros(401), places, np.zeros(401), trochoid, spacing)
        assert met.all()
        moved = found_x - steepness / k * np.sin(k * found_x)
        np.testing.assert_allclose(moved, places, atol=1e-5 * spacing)
        # where the surface is steep a small step above is a large one at rest
        np.testing.assert_allclose(found_x, expected, atol=2e-5 * spacing / (1.0 - steepness))


def test_places_inside_bilinear_quads() -> None:
    """Quads, hardly one a parallelogram, whose place (u, v) between the corners is the origin."""
    generator = np.random.default_rng(11)
    square = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])[:, np.newaxis]
    corners = square + generator.uniform(-0.2, 0.2, (4, 500, 2))
    u, v = generator.uniform(-0.3, 1.3, (2, 500))
    weights = np.array([(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v])
    corners -= np.einsum("cp,cpx->px", weights, corners)
    found_u, found_v, hit = inside_quad(corners)
    inside = (u > 0.0) & (u < 1.0) & (v > 0.0) & (v < 1.0)
    np.testing.assert_array_equal(hit, inside)
    np.testing.assert_allclose(found_u[inside], u[inside], atol=1e-9)
    np.testing.assert_allclose(found_v[inside], v[inside], atol=1e-9)
