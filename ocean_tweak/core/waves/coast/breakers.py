# SPDX-License-Identifier: GPL-3.0-or-later
"""Individual waves over a bed: their shape before breaking, peaked and pitched forward, and where they break.

The sum of a coast's pictures is an analytic signal A, whose real part is the elevation: |A| is the envelope
of the waves at a place and time, and the angle of A the phase within the wave, 0 at its crest and growing
towards the shore.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...numerics.interpolation import smoothstep
from ..contribution import OwnSpray
from .march import BREAKER_INDEX

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]

#: Ruessink, Ramaekers and van Rijn (2012), p1 to p6 of eq. 9 and 10
_NONLINEARITY = (0.0, 0.857, -0.471, 0.297)
_FORWARD = (0.815, 0.672)
#: kh above which water counts as deep
_DEEP = np.pi
#: rad of a wave's phase over which its front is white: none, all, all, none
_FRONT = (-0.3, 0.05, 0.5, 1.2)
#: height in m of a breaker that throws up as much as a wind of 17 m/s tears off a crest that breaks, and how
#: fast it throws it up, over √(gH): from the height of the front to half as high again
_AS_A_CREST, _UP = 2.0, 0.7
#: of the height of waves, to which whitecaps are in proportion
WHITECAPS_BY_HEIGHT = 6.0
#: envelope over that from which waves are broken: none is white below, all of the front is above
_SOFT = (0.9, 1.1)


def whitecaps_left(share: Array) -> Array:
    """What is left of the open sea's whitecaps where its waves have this share of their height.

    Waves lose by whitecapping in proportion to B³, B in proportion to the square of their height (Phillips
    1985, J. Fluid Mech. 156): in the lee of a mole low waves hardly break.
    """
    left: Array = share**WHITECAPS_BY_HEIGHT
    return left


def broken_share(rms_height: Array, depth: Array) -> Array:
    """Q_b, the fraction of broken waves, min(1, (H_rms/γh)⁴): Thornton and Guza (1983).

    rms_height, depth : m, of one shape; where depth is 0 or less, there are none
    """
    wet = depth > 0.0
    ratio = np.divide(rms_height, BREAKER_INDEX * depth, out=np.zeros(depth.shape), where=wet)
    result: Array = np.minimum(ratio**4, 1.0)
    return result


def least_broken(rms_height: Array, share: Array) -> Array:
    """Envelope in m above which waves are broken, for a given fraction of broken waves: H_rms √(-ln Q_b)/2.

    For Rayleigh-distributed heights, of which the highest break.
    """
    least = np.sqrt(-np.log(np.clip(share, 1e-300, 1.0)))
    result: Array = 0.5 * rms_height * least
    return result


def whiteness(signal: ComplexArray, least: RealArray) -> RealArray:
    """Strength of breaking, 0…1, on the fronts of waves above the threshold envelope."""
    phase, envelope = np.angle(signal), np.abs(signal)
    begin, full, still, end = _FRONT
    front = smoothstep((phase - begin) / (full - begin)) * (1.0 - smoothstep((phase - still) / (end - still)))
    low, high = _SOFT
    broken = smoothstep((envelope - low * least) / np.maximum((high - low) * least, 1e-3))
    result: RealArray = front * broken * (envelope > 0.0)
    return result


class Shape(NamedTuple):
    """What single waves are instead of sinusoids, at places: r and φ of Abreu and others (2010).

    height : √(1 - r²), which keeps the height from crest to trough
    raised : r sin φ/(1 + √(1 - r²)), without which they would have a mean
    across, along : r cos φ and r sin φ
    """

    height: RealArray
    raised: RealArray
    across: RealArray
    along: RealArray

    def elevation(self, signal: ComplexArray) -> RealArray:
        """m, of an analytic signal: eq. 7, sines and cosines of its angle being its parts over its length."""
        envelope = np.abs(signal)
        low = envelope - self.across * signal.imag
        low += self.along * signal.real
        high = self.raised * envelope
        high += signal.real
        high *= self.height
        high *= envelope
        result: RealArray = np.divide(high, low, out=np.zeros_like(high), where=low > 0.0)
        return result


def shape_of(amplitude: Array, k: Array, depth: Array, share: Array) -> Shape:
    """The shape of waves, peaked and pitched forward as far as water is shallow for them, float32.

    amplitude : m, half the significant height; k : rad/m, of the mean frequency; depth : m; share : 0…1, how
        much of the shape is wanted

    Skewness and asymmetry by Ruessink, Ramaekers and van Rijn (2012) from the Ursell number ¾ a k/(kh)³, the
    wave by Abreu, Silva, Sancho and Temperville (2010): as high from crest to trough as the sinusoid, and
    without a mean.
    """
    kh = np.maximum(k * depth, 1e-3)
    ursell = np.maximum(0.75 * amplitude * k / kh**3, 1e-6)
    low, high, middle, width = _NONLINEARITY
    amount = low + (high - low) / (1.0 + np.exp((middle - np.log10(ursell)) / width))
    amount *= share * (1.0 - smoothstep(4.0 * kh / _DEEP - 3.0))
    lean = 0.5 * np.pi * (np.tanh(_FORWARD[0] / ursell ** _FORWARD[1]) - 1.0)
    # the index of skewness (Malarkey and Davies 2012, eq. 26), and the waveform's angle
    b = np.sqrt(2.0) * amount / np.sqrt(9.0 + 2.0 * amount * amount)
    r, phi = 2.0 * b / (1.0 + b * b), -lean - 0.5 * np.pi
    f = np.sqrt(1.0 - r * r)
    along = r * np.sin(phi)
    parts = (f, along / (1.0 + f), r * np.cos(phi), along)
    return Shape(*(part.astype(np.float32) for part in parts))


def breaker_spray(white: Array, height: Array, depth: Array, velocity: Array, gravity: float) -> OwnSpray:
    """What breakers throw up, at places.

    A bore loses in proportion to H³c/h (Thornton and Guza 1983, 11): with the height that the depth allows
    and the speed of long waves, H^(5/2). Its water goes at least as fast as the front.

    white : (places,) whiteness of their fronts, 0…1
    height, depth : (places,) of each wave and of still water, m
    velocity : (places, 3) of the water without breaking, m/s: on a front it goes where the wave goes
    gravity : m/s²
    """
    strength = white * (np.maximum(height, 0.0) / _AS_A_CREST) ** 2.5
    level = velocity * (1.0, 1.0, 0.0)
    speed = np.linalg.norm(level, axis=1)
    front = np.sqrt(gravity * np.maximum(depth + height, 0.0))
    faster = np.maximum(front, speed) / np.maximum(speed, 1e-3)
    thrown = level * faster[:, np.newaxis]
    thrown[:, 2] = np.maximum(velocity[:, 2], 0.0) + _UP * np.sqrt(gravity * np.maximum(height, 0.0))
    return OwnSpray(strength, thrown)
