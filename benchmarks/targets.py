# SPDX-License-Identifier: GPL-3.0-or-later
"""What the product promises. A row of measurements names the target that it is judged by."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Target:
    """A limit, and what it is a limit of.

    at_least : whether the value must reach the limit rather than stay below it
    needs_two_cores : judged only where a probe in the same run found two free cores
    what_limits : what profiles say stands in the way where it is not met
    tried : what did not get it there
    """

    work: str
    limit: float
    unit: str
    at_least: bool = False
    needs_two_cores: bool = False
    what_limits: str = ""
    tried: str = ""

    def met(self, value: float) -> bool:
        """Whether a value is good enough."""
        return value >= self.limit if self.at_least else value <= self.limit

    def worst(self, values: list[float]) -> float:
        """The value that is furthest from what is wanted."""
        return min(values) if self.at_least else max(values)

    def __str__(self) -> str:
        return f"{'≥' if self.at_least else '≤'} {self.limit:g} {self.unit}".rstrip()


#: cores that a probe must find free before two workers are judged
TWO_CORES = 1.7

TARGETS = {
    "3 fields": Target(
        "3 fields (elevation, Dx, Dy), one thread, N ≥ 512", 1.2, "× three irfft2",
        what_limits="phases, sines and products with the coefficients read from memory; at 512² the bare "
        "transforms stay in a second-level cache, and a sea does not fit",
        tried="wider blocks with padded rows, and fewer passes over the phases: both kept",
    ),
    "6 fields": Target("6 fields + minimum eigenvalue, one thread, 1024²", 1.45, "× six irfft2"),
    "6 fields, large": Target(
        "6 fields + minimum eigenvalue, one thread, ≥ 2048²", 1.0, "× six irfft2",
        what_limits="the transposed store between the passes",
    ),
    "two workers": Target(
        "two threads against one, N ≥ 1024", 1.5, "×", at_least=True, needs_two_cores=True,
        what_limits="the memory that both threads share: most in the transposed store, and with all outputs",
        tried="smaller blocks for threads to pull, which lose",
    ),
    "initial state": Target(
        "initial state at 512² after one spectral parameter changed", 8.0, "× one six-field frame"
    ),
    "Blender": Target(
        "frame change → evaluated mesh at 1024², live, nodes", 6.0, "× faster than Generate", at_least=True
    ),
    "Blender, foam": Target(
        "the same with foam", 15.0, "× faster than Generate with foam", at_least=True,
        what_limits="old foam, which fades, is drawn out and drifts in every frame; the modifier's foam is "
        "the folding of the present frame",
        tried="one pass by rows instead of one by arrays, no branches, no power of two: together two "
        "thirds of the time that it took before; fewer arrays gained nothing",
    ),
    "Blender, all maps": Target(
        "the same with foam, normals and velocity", 12.0, "× faster than Generate with foam", at_least=True,
        what_limits="eleven fields instead of three: transforms take half of that time, products, normals "
        "and eigenvalues the rest, each a pass over a million numbers",
        tried="larger blocks, and fields in groups that need fewer arrays: less than a twentieth",
    ),
    "maps": Target(
        "frame change → evaluated mesh at 512², foam, normals and velocity", 2.2, "× the same without maps",
        what_limits="eleven fields instead of three, and old foam, which threads share; blocks that are as "
        "small as 24 bytes a sample let them be cost the fields a sixth",
        tried="groups that need fewer arrays: less than half of that sixth back at 512², and a twentieth "
        "lost at 1024²",
    ),
    "horizon frame": Target(
        "frame → mesh of To the Horizon, consecutive frames", 10.0, "× a plain sea of 512² without maps",
        what_limits="eleven fields of each of four patches and the strains under foam of six sizes of cells, "
        "which take longer than the nodes; fewer vertices show other waves than a render",
        tried="32,000 vertices in the viewport, averages in NumPy (43 ms instead of 124), foam on 72² "
        "places, foam's relief only where there is foam: all kept; one transform of the largest patch for "
        "both displacement and strains saves a fifth and changes the foam: not kept",
    ),
    "horizon render": Target("a vertex of its render", 2.0, "× one of its viewport"),
    "horizon drag": Target(
        "Wind dragged there until the first mesh", 8.0, "× a plain sea",
        what_limits="waves of five seas are drawn anew: of each patch, and of the ocean's own mesh",
    ),
    "horizon click": Target(
        "from the click on To the Horizon to a free window", 1.5, "s",
        what_limits="Blender's calls for a thousand nodes, each of which looks through its whole tree, and "
        "the sea, without whose highest wave the camera has no place",
        tried="groups, since a tree's time grows with its square (800 nodes take 1.43 s, four times 200 take "
        "0.25 s), images in a second thread, nodes placed in one call: all kept",
    ),
    "baked": Target(
        "a baked sea of 512² played, displacement alone", 1.0, "× the same live",
        what_limits="Blender's Image Texture node, which reads the image for each vertex: more than half of "
        "the frame",
        tried="all files in Blender's cache already: nine tenths as long",
    ),
    "baked memory": Target("memory that grows while more is played than Blender's cache holds", 10.0, "MB"),
    "baked horizon": Target(
        "To the Horizon baked and played", 1.2, "× the same live",
        what_limits="its patches' points, which Blender reads from files of 12 to 26 MB in each frame",
    ),
    "bake": Target(
        "bake of `disp` at 1024², two workers", 1.15, "× (compute + encode)/2", needs_two_cores=True
    ),
    "bake memory": Target("memory of that bake", 400.0, "MB a worker"),
    "bake of maps, seconds": Target(
        "bake of disp, foam, normal and vel at 1024², one worker", 2.2, "× disp alone",
        what_limits="three more maps to encode, of 16 bits, for 0.3 to 0.4 of a displacement's time each",
        tried="ZIP and PXR24, which take longer than PIZ and more bytes; RLE: half as long and 1.4 to 1.8 "
        "times the bytes",
    ),
    "bake of maps, bytes": Target(
        "bytes of disp, foam, normal and vel at 1024²", 2.3, "× disp alone",
        what_limits="what 2⁻¹¹ of the largest number still says of eleven bits a texel",
    ),
    "wind fields": Target(
        "20,000 wave particles, displacement, slopes and Jacobian, 1024²", 3.0, "× one six-field frame"
    ),
    "wake alone": Target(
        "six fields of a wake at 512², 60 s of path alone", 40.0, "× one six-field frame",
        what_limits="120 pieces of the path, each of which turns two numbers of every wave vector and adds "
        "the integral over the piece to both",
        tried="phases as products of one exponential along each axis, and turns shared by pieces that last "
        "equally long: both kept",
    ),
    "wake sequence": Target("six fields of a wake at 512², the next frame", 3.0, "× one six-field frame"),
    "coast pictures": Target(
        "pictures of 600 waves over a bed of 512², two cores", 20.0, "s",
        what_limits="512 rows one after another, each with a series of third order along the shore for every "
        "wave, in double precision",
        tried="waves marched in blocks, which all cores share: kept; single precision, without gain",
    ),
    "coast frame": Target("displacement over a bed of about 512²", 5.0, "× one six-field frame"),
    "coast velocity": Target("displacement and velocity over a bed of 512²", 10.0, "× one six-field frame"),
    "cascades": Target("three 512² patches, 6 fields + minimum eigenvalue each", 3.2, "× one 512² patch"),
    "foam alone": Target(
        "foam of a frame by itself, 512² to 2048², one thread", 25.0, "× one six-field frame",
        what_limits="looks at the past, each two thirds of a six-field frame: 26 to 46, as many as the "
        "frequencies of strains ask for; phases are a seventh of a look",
        tried="looks a tenth further apart, a band of the sea's own "
        "spectrum and more looks around a moment (a correlation of 0.976 with the foam of all moments in "
        "fine storms), a frame that moves with the waves (a seventh fewer at best), strains interpolated "
        "one by one (a fifth fewer looks, as much more to interpolate)",
    ),
    "foam of places alone": Target(
        "foam of a cascade at 200,000 places by itself", 30.0, "looks at them",
        what_limits="47 looks, as many as the strains of the shortest patch ask for, each read at the places "
        "that old foam is drawn from, and a quarter of them at those that it is drawn to as well; transforms "
        "alone take 14",
        tried="reading in parts of the places, for which patches fall out of the caches",
    ),
    "joined": Target(
        "three patches joined on 1024², displacement, one thread", 2.5, "× one patch of 1024²",
        what_limits="the patches' own transforms, twice those of one patch, and then reading two of them "
        "between their samples: four of each component at a million places, in an order that caches do not "
        "foresee",
        tried="records of all components, with weights kept for each: a tenth, for three times the memory",
    ),
    "growth": Target("time per sample, 4096² against 512²", 1.6, "×"),
    "memory": Target("memory of `surface()` beyond its outputs", 24.0, "bytes a sample"),
    "usd time": Target(
        "a sea as USD points or clips, one thread", 1.5, "× (compute + its arrays to a plain file)"
    ),
    "usd size": Target("bytes of those layers", 1.02, "× those of their arrays"),
    "precision": Target("rms relative error against float64 at t = 10⁴ s, every field", 5e-7, ""),
}  # fmt: skip
