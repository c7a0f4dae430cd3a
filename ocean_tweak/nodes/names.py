# SPDX-License-Identifier: GPL-3.0-or-later
"""Names on which shots, materials and other tools depend: mesh attributes and group inputs."""

from __future__ import annotations

from ..core.synthesis.channels import CHANNELS

#: point attributes of the evaluated mesh: Blender units, Blender units per second of scene time, 0…1, how
#: far the surface is compressed, how strongly it breaks now, 0…1, and seconds since the foam was born; NORMAL
#: is the one that Blender takes for the mesh's free custom normals
DISPLACEMENT, VELOCITY, FOAM, CUSP, BREAKING, FOAM_AGE, NORMAL = (
    CHANNELS[name].attribute
    for name in ("displacement", "velocity", "foam", "cusp", "breaking", "foam_age", "normal")
)

#: point attribute of a surface around the camera: mean square slope of the waves that it leaves out
SLOPE_VARIANCE = "slope_variance"

#: point attribute of such a surface: length of the shortest waves that it holds where it is, Blender units
SHORTEST_WAVE = "shortest_wave"

#: point attributes of the mesh of one patch of a sea of several, in its own axes, besides displacement and
#: velocity: slope along x and y, and Dx by x, Dy by y and their shear
SLOPE, STRAIN = CHANNELS["slope"].attribute, CHANNELS["strain"].attribute

#: point attribute of such a mesh whose averages come after its own points: of point n, of average n the
#: points along x and y and the number of the first one. The first tells the same of the mesh itself, but that
#: its last number is how many there are with it, less than 0
AVERAGES_TABLE = "ocean_tweak_averages"

#: point attributes of what is averaged: slopes along x and y and the sum of their squares; foam, cusp and
#: breaking of an ocean, strain of a patch: three numbers are read at once
SLOPES, OTHERS = "ocean_tweak_slopes", "ocean_tweak_others"

#: point attributes of an ocean's mesh by which patches 1, 2, … are multiplied; 1 where there is none
WEIGHT = "ocean_tweak_weight_{}"

#: point attributes of an ocean's geometry over a bed: share of the open sea, and how it changes along x and
#: y per Blender unit; foam, breaking and age of waves that the bed breaks
OPEN_SHARE, BED_FOAM = "ocean_tweak_open_share", "ocean_tweak_bed_foam"

#: point attribute of what touches the water: 1 at the surface, 0 at the top of the wet band, linear
WET = "wet"
#: and how much white water laps at it there, 0…1
SLOP = "slop"

#: point attribute of the mesh over a bed: depth of still water there, m; 0 where there is none
COAST_DEPTH = "depth"

#: corner attribute: position / domain size + ½ / samples, going on over the repeats
TEXTURE_COORDINATES = "st"

#: the maps that Blender reads, by their names in files, and the input that takes the image of each
MAP_INPUTS = {
    "disp": "Displacement",
    "foam": "Foam",
    "normal": "Normal",
    "vel": "Velocity",
    "foam_age": "Foam Age",
}
