# SPDX-License-Identifier: GPL-3.0-or-later
"""What a shot reads of an ocean's mesh, and what the core says it must read."""

from fractions import Fraction
from functools import lru_cache

import numpy as np

#: name → type, domain, numbers each, as the documentation promises them
CONTRACT = {
    "displacement": ("FLOAT_VECTOR", "POINT", 3),
    "velocity": ("FLOAT_VECTOR", "POINT", 3),
    "foam": ("FLOAT", "POINT", 1),
    "cusp": ("FLOAT", "POINT", 1),
    "breaking": ("FLOAT", "POINT", 1),
    "foam_age": ("FLOAT", "POINT", 1),
    "st": ("FLOAT2", "CORNER", 2),
}
OUTPUTS = {"displacement", "velocity", "normal", "foam", "cusp", "breaking", "foam_age"}
ALL_MAPS = ("disp", "foam", "normal", "vel", "foam_age")


def read(mesh, rows, columns):
    """What is on a mesh: each attribute of the contract that it has, positions and custom normals.

    Arrays are (rows, columns, n), n numbers a vertex; of `st`, those of one corner of each vertex.
    """
    result = {"position": _numbers(mesh.attributes["position"].data, "vector", 3)}
    for name, (data_type, domain, count) in CONTRACT.items():
        attribute = mesh.attributes.get(name)
        if attribute is None:
            continue
        assert (attribute.data_type, attribute.domain) == (data_type, domain)
        result[name] = _numbers(attribute.data, "vector" if count > 1 else "value", count)
    if "st" in result:
        corners = np.empty(len(mesh.loops), np.int32)
        mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
        of_vertex = np.zeros((len(mesh.vertices), 2))
        of_vertex[corners] = result["st"]
        np.testing.assert_array_equal(of_vertex[corners], result["st"])  # all corners of a vertex agree
        result["st"] = of_vertex
    if mesh.has_custom_normals:
        result["normal"] = _numbers(mesh.corner_normals, "vector", 3)
        corners = np.empty(len(mesh.loops), np.int32)
        mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
        of_vertex = np.zeros((len(mesh.vertices), 3))
        of_vertex[corners] = result["normal"]
        result["normal"] = of_vertex
    return {name: values.reshape(rows, columns, -1) for name, values in result.items()}


def _numbers(data, name, count):
    flat = np.empty(len(data) * count, np.float32)
    data.foreach_get(name, flat)
    return flat.reshape(-1, count).astype(np.float64)


def wanted(core, parameters, frame, metres=1.0, repeats=(1, 1)):
    """What `read` must give for a mesh with a vertex a sample, from the core and arithmetic alone."""
    time = (Fraction(frame) - parameters.timing.start_frame) / parameters.timing.fps
    fields = _surface(core.Ocean, parameters, time)
    samples, size = parameters.resolution, parameters.domain_size / metres
    column, row = (np.arange(count * samples + 1) for count in repeats)

    def over_all(field):
        return field.reshape(samples, samples, -1)[np.ix_(row % samples, column % samples)].astype(np.float64)

    flat = np.zeros((len(row), len(column), 3))
    flat[..., 0], flat[..., 1] = column * size / samples, row[:, np.newaxis] * size / samples
    displacement = over_all(fields.displacement) / metres
    st = np.zeros((len(row), len(column), 2))
    st[..., 0], st[..., 1] = (column + 0.5) / samples, (row[:, np.newaxis] + 0.5) / samples
    return {
        "position": flat + displacement,
        "displacement": displacement,
        "velocity": over_all(fields.velocity) / metres,
        "foam": over_all(fields.foam),
        "cusp": over_all(fields.cusp),
        "breaking": over_all(fields.breaking),
        "foam_age": over_all(fields.foam_age),
        "normal": over_all(fields.normal),
        "st": st,
    }


@lru_cache(maxsize=64)
def _surface(sea, parameters, time):
    return sea(parameters).surface(time, OUTPUTS)


def assert_alike(found, expected, metres=1.0, tolerance=1e-4):
    """All that is expected is found, to a tenth of a millimetre; normals and ages to a thousandth."""
    assert set(found) == set(expected)
    for name, values in expected.items():
        scale = metres if name in ("position", "displacement", "velocity") else 1.0
        limit = 1e-3 if name in ("normal", "foam_age") else tolerance
        difference = np.abs(found[name] - values).max() * scale
        assert difference < limit, f"{name} differs by {difference}"
