# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of channels: what it says of a field is so."""

from dataclasses import replace

import numpy as np
import pytest

from ocean_tweak.core import Ocean, OceanParameters, WaveLayer
from ocean_tweak.core.synthesis.channels import (
    CHANNELS,
    MAPS,
    channels_of,
    image_of,
    is_put_together,
    unit_of,
)

SEA = OceanParameters(resolution=16, domain_size=60.0, layers=(WaveLayer(wind_speed=12.0, fetch=20e3),))
#: on a flat sea all directions are compressed alike
WITHOUT_REST = {"min_eigenvector"}


@pytest.fixture(scope="module")
def fields():
    return Ocean(SEA, precision="double").surface(2.0, CHANNELS)


@pytest.mark.parametrize("name", CHANNELS.keys() - WITHOUT_REST)
def test_a_flat_sea_has_the_numbers_at_rest(name):
    calm = SEA.replace(layers=(replace(SEA.layers[0], muted=True),))
    field = Ocean(calm).surface(2.0, {name})[name]
    np.testing.assert_array_equal(field, np.broadcast_to(CHANNELS[name].rest, field.shape))


@pytest.mark.parametrize("name", CHANNELS)
def test_shapes_are_those_of_the_table(fields, name):
    channel = CHANNELS[name]
    assert fields[name].shape == channel.shape(16)
    assert len(channel.columns) == max(channel.components, 1)


def test_metres_and_seconds_are_those_of_displacement_velocity_and_height():
    told = {name: (channel.scales, channel.is_rate) for name, channel in CHANNELS.items()}
    assert {name for name, (scales, _) in told.items() if scales} == {
        "displacement",
        "velocity",
        "significant_height",
    }
    assert {name for name, (_, is_rate) in told.items() if is_rate} == {"velocity"}


def test_columns_are_named_as_what_they_turn_as():
    assert CHANNELS["velocity"].columns == ("velocity_x", "velocity_y", "velocity_z")
    assert CHANNELS["slope"].columns == ("slope_x", "slope_y")
    assert CHANNELS["strain"].columns == ("strain_xx", "strain_yy", "strain_xy")
    assert CHANNELS["cusp"].columns == ("cusp",)


@pytest.mark.parametrize("name", MAPS)
def test_the_channels_of_a_map_fill_its_colours_in_order(fields, name):
    image = image_of(name, fields)
    assert image.shape == (16, 16, 3)
    parts = [np.atleast_3d(fields[each]) for each in MAPS[name]]
    filled = sum(part.shape[-1] for part in parts)
    np.testing.assert_array_equal(image[..., :filled], np.concatenate(parts, axis=-1))
    assert not image[..., filled:].any()
    assert is_put_together(name) is not any(image is fields[each] for each in MAPS[name])
    assert {CHANNELS[each].unit for each in MAPS[name]} == {unit_of(name)}


def test_maps_ask_for_their_channels():
    assert channels_of(("foam", "vel")) == {"foam", "cusp", "breaking", "velocity"}
    assert channels_of(()) == set()


def test_a_field_that_was_not_asked_for_is_not_there(fields):
    alone = Ocean(SEA).surface(2.0, {"slope"})
    with pytest.raises(KeyError):
        alone["foam"]
    with pytest.raises(AttributeError, match=r"foam was not computed \(only slope\)"):
        _ = alone.foam
