# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the .blend file of a tiny shot: make_blend.py -- KIND FILE.blend SEA.json."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))

from light import NOTHING, PER_METRE, PIXELS

ROOT = Path(__file__).parents[2]


def main():
    kind, path, params = sys.argv[sys.argv.index("--") + 1 :]
    if kind in ("live", "baked"):
        sys.path.insert(0, str(ROOT / "examples"))
        from extension import enable

        extension = enable()
        bpy.ops.wm.read_homefile(use_empty=True)
        parameters = extension.module("core").OceanParameters.from_json(Path(params).read_text())
        add = extension.module("scene.ocean_object").add
        if kind == "live":
            add(bpy.context.scene, parameters, name="Ocean")
        else:
            sequence = bake(extension, parameters, Path(path).parent / "elsewhere", (-1, 2))
            item = add(bpy.context.scene, parameters, source="SEQUENCE", sequence=sequence, name="Ocean")
            attribute = light(item.data).new("ShaderNodeAttribute")
            attribute.attribute_name = "displacement"
            shine(item.data, attribute.outputs["Vector"])
            bpy.context.scene.render.frame_map_new = 200
        look_at(bpy.context.scene, parameters.domain_size)
    else:
        bpy.ops.wm.read_homefile(use_empty=True)
        plane()
        look_at(bpy.context.scene, 1.0)
    bpy.ops.wm.save_as_mainfile(filepath=path)


def plane():
    """A plane from 0 to 1 that shines as the image sequence storm_disp says, which is nowhere yet."""
    mesh = bpy.data.meshes.new("Plane")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    layer = mesh.uv_layers.new()
    layer.data.foreach_set("uv", (0, 0, 1, 0, 1, 1, 0, 1))
    image = bpy.data.images.new("storm_disp", 1, 1, float_buffer=True, is_data=True)
    image.source = "SEQUENCE"
    image.filepath = "//elsewhere/storm_disp.0001.exr"
    image.colorspace_settings.is_data = True
    texture = light(mesh).new("ShaderNodeTexImage")
    texture.image, texture.interpolation = image, "Closest"
    user = texture.image_user
    user.frame_start, user.frame_duration, user.use_auto_refresh = 1, 3, True
    shine(mesh, texture.outputs["Color"])
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Plane", mesh))


def bake(extension, parameters, folder, frames):
    """The displacement of some frames, as the sequence storm."""
    folder.mkdir()
    sink = extension.module("export.exr").ExrSequence(folder, "storm", parameters, "ZIP", ("disp",))
    sea = extension.module("core").Ocean(parameters)
    for frame in frames:
        sink.write(frame, sea.frame(frame, sink.outputs))
    return extension.module("scene.image_sequence").ImageSequence(folder, "storm", frames)


def light(mesh):
    """The nodes of a new material on a mesh."""
    material = bpy.data.materials.new("Light")
    material.use_nodes = True
    material.node_tree.nodes.clear()
    mesh.materials.append(material)
    return material.node_tree.nodes


def shine(mesh, metres):
    """Let a mesh shine as a socket of its material says."""
    tree = mesh.materials[0].node_tree
    scale = tree.nodes.new("ShaderNodeVectorMath")
    scale.operation = "MULTIPLY_ADD"
    scale.inputs[1].default_value = (PER_METRE,) * 3
    scale.inputs[2].default_value = (NOTHING,) * 3
    emission = tree.nodes.new("ShaderNodeEmission")
    out = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(metres, scale.inputs[0])
    tree.links.new(scale.outputs["Vector"], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], out.inputs["Surface"])


def look_at(scene, size):
    """From above, at the lower left quarter of a square: a pixel is a texel."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    camera.location = (size / 4, size / 4, size)
    camera.data.type, camera.data.ortho_scale = "ORTHO", size / 2
    camera.data.clip_end = 10 * size
    scene.camera = camera
    scene.render.resolution_x = scene.render.resolution_y = PIXELS
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", 1, False
    scene.cycles.pixel_filter_type = "BOX"
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGB"
    scene.frame_start, scene.frame_end = 1, 3


if __name__ == "__main__":
    main()
