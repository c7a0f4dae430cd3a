# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles as columns of numbers, for mesh vertices and for points in files."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .particles import Particles

#: columns of a particle, float32; its number is the last bits of its id, as many as a float32 can hold
COLUMNS = ("x", "y", "z", "velocity_x", "velocity_y", "velocity_z", "radius", "age", "kind", "number")
#: columns of a particle in a file
BYTES_IN_FILE = 4 * len(COLUMNS)
#: number of columns
NUMBERS = 2**24


def columns(particles: Particles) -> NDArray[np.float32]:
    """(particles, 10) values in m and m/s, in the order of COLUMNS."""
    result = np.empty((len(particles.age), len(COLUMNS)), np.float32)
    result[:, :3], result[:, 3:6] = particles.position, particles.velocity
    result[:, 6], result[:, 7], result[:, 8] = particles.radius, particles.age, particles.kind
    result[:, 9] = particles.id % NUMBERS
    return result
