# SPDX-License-Identifier: GPL-3.0-or-later
"""A node group that samples the maps of one patch at a place and a frame."""

from __future__ import annotations

import bpy

from .building import Builder, Plug, Socket, output
from .names import MAP_INPUTS
from .versioned import GroupKind

#: the images' inputs: name, socket type, default, description
IMAGE_INPUTS = (
    Plug("Displacement", "NodeSocketImage", None, "Displacement in metres: red x, green y, blue z"),
    Plug(
        "Foam",
        "NodeSocketImage",
        None,
        "Red foam from 0 to 1, green how far the surface is compressed, blue how strongly it breaks now",
    ),
    Plug("Normal", "NodeSocketImage", None, "Normals of the surface in object space"),
    Plug("Velocity", "NodeSocketImage", None, "Velocity in metres per second"),
    Plug("Foam Age", "NodeSocketImage", None, "Red seconds since the foam was born"),
)

#: images of frames before 0, as Blender counts the files of a sequence upwards from 0
EARLY_IMAGE_INPUTS = tuple(
    plug._replace(
        name=f"{plug.name} Before 0",
        description="The same at frames before 0: its files end in -001.exr, -002.exr …",
        hidden=True,
    )
    for plug in IMAGE_INPUTS
)

#: inputs that convert metres to Blender units
SCALE_INPUTS = (
    Plug("Scale", "NodeSocketFloat", 1.0, "Blender units in a metre"),
    Plug(
        "Velocity Scale", "NodeSocketFloat", 1.0,
        "Blender units per second of the scene in a metre per second of the velocity image",
    ),
)  # fmt: skip

_OUTPUTS = (
    Plug("Displacement", "NodeSocketVector", None, "Blender units"),
    Plug("Velocity", "NodeSocketVector", None, "Blender units per second"),
    Plug("Normal", "NodeSocketVector", None, "Unit length; upwards where there is no image"),
    Plug("Foam", "NodeSocketFloat", None, "From 0 to 1"),
    Plug("Cusp", "NodeSocketFloat", None, "How far the surface is compressed"),
    Plug("Breaking", "NodeSocketFloat", None, "How strongly it breaks now, from 0 to 1"),
    Plug("Foam Age", "NodeSocketFloat", None, "Seconds since the foam was born"),
    *(
        Plug(f"Has {name}", "NodeSocketBool", None, "Whether the image has a file for the frame")
        for name in MAP_INPUTS.values()
    ),
)


def _build(tree: bpy.types.NodeTree) -> None:
    inputs = (
        *IMAGE_INPUTS,
        *EARLY_IMAGE_INPUTS,
        Plug("Coordinates", "NodeSocketVector", None, "Texture coordinates: 0 to 1 is one patch"),
        Plug("Frame", "NodeSocketInt", 1, "File of the image sequences"),
        Plug("Seconds", "NodeSocketFloat", 0.0, "Of the scene, for which velocity moves the water on"),
        *SCALE_INPUTS,
    )
    build = Builder(tree, inputs, _OUTPUTS)
    frame = build.given("Frame")
    is_early = build.compare("LESS_THAN", frame, 0)
    number = build.integer("MAXIMUM", frame, build.integer("SUBTRACT", 0, frame))
    images = {
        name: build.switch("IMAGE", is_early, build.given(name), build.given(f"{name} Before 0"))
        for name in MAP_INPUTS.values()
    }
    texels = {name: _texel(build, image, number) for name, image in images.items()}
    has = {name: _has_texels(build, image, number) for name, image in images.items()}
    foam = build.add("ShaderNodeSeparateXYZ", {"Vector": texels["Foam"]})
    age = build.add("ShaderNodeSeparateXYZ", {"Vector": texels["Foam Age"]})
    unit = build.add("ShaderNodeVectorMath", {"Vector": texels["Normal"]}, operation="NORMALIZE")
    displacement = build.scaled(texels["Displacement"], build.given("Scale"))
    velocity = build.scaled(texels["Velocity"], build.given("Velocity Scale"))
    build.finish_with(
        {
            "Displacement": moved_on(build, displacement, velocity, build.given("Seconds")),
            "Velocity": velocity,
            "Normal": build.switch("VECTOR", has["Normal"], (0.0, 0.0, 1.0), output(unit, "Vector")),
            "Foam": output(foam, "X"),
            "Cusp": output(foam, "Y"),
            "Breaking": output(foam, "Z"),
            "Foam Age": output(age, "X"),
            **{f"Has {name}": value for name, value in has.items()},
        }
    )


def moved_on(build: Builder, displacement: Socket, velocity: Socket, seconds: Socket) -> Socket:
    """The displacement some seconds later or earlier, for a constant velocity."""
    is_between = build.compare("NOT_EQUAL", seconds, 0.0, "FLOAT")
    later = build.vector("ADD", displacement, build.scaled(velocity, seconds))
    return build.switch("VECTOR", is_between, displacement, later)


def _texel(build: Builder, image: Socket, number: Socket) -> Socket:
    """The image, bilinear between texel centres; zero without an image."""
    texture = build.add(
        "GeometryNodeImageTexture",
        {
            "Image": image,
            "Vector": build.given("Coordinates"),
            "Frame": number,
        },
        interpolation="Linear",
        extension="REPEAT",
    )
    return output(texture, "Color")


def _has_texels(build: Builder, image: Socket, number: Socket) -> Socket:
    """Whether there is an image with a readable file, which otherwise has no width."""
    information = build.add("GeometryNodeImageInfo", {"Image": image, "Frame": number})
    width = output(information, "Width")
    return build.compare("GREATER_THAN", width, 0)


PATCH = GroupKind("Ocean Tweak Patch", 4, _build)
