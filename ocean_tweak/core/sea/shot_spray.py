# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray of the frames of a shot, whose sea may change from frame to frame."""

from __future__ import annotations

import numpy as np

from ..data.frames import Frame
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.shot import Shot
from ..parameters.spray import Spray
from ..spray.particles import Particles
from .ocean import Ocean
from .spray import CameraSpray, TileSpray, above_bed


class ShotSpray:
    """Spray of a shot's frames; fastest for consecutive ones.

    place : centre (x, y) in m; None for the sea's tile, which must then exist
    """

    def __init__(self, shot: Shot, spray: Spray, place: tuple[float, float] | None = None) -> None:
        self._shot = shot
        self._spray = spray
        self._place = place
        self._made: tuple[OceanParameters, TileSpray | CameraSpray] | None = None

    def at(self, frame: Frame) -> Particles:
        """Particles at a frame, with velocities per second of the shot.

        Raises SprayError for more than the memory holds.
        """
        moment = self._shot.at(frame)
        source = self._source(moment.parameters)
        if isinstance(source, TileSpray):
            made = source.at(moment.time, self._spray)
        else:
            assert self._place is not None
            made = source.at(moment.time, self._spray, self._place)
            made = above_bed(made, moment.parameters) if moment.parameters.has_coast else made
        return made if moment.rate == 1.0 else made._replace(velocity=made.velocity * np.float32(moment.rate))

    def outlook(self, frame: Frame) -> float:
        """Particles in the air at a frame, about: as many as if crests had always broken as they do then.

        It takes as long as each of the moments that the first of a shot's frames looks back at.
        """
        moment = self._shot.at(frame)
        source = self._source(moment.parameters)
        if isinstance(source, TileSpray):
            return source.outlook(moment.time, self._spray)
        assert self._place is not None
        return source.outlook(moment.time, self._spray, self._place)

    def _source(self, sea: OceanParameters) -> TileSpray | CameraSpray:
        if self._made is None or self._made[0] != sea:
            around = self._place is not None
            self._made = sea, CameraSpray.of(sea) if around else TileSpray(Ocean(sea))
        return self._made[1]
