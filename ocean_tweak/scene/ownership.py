# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes, images and textures belong to one ocean: a duplicate gets its own before it changes them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import bpy

from ..nodes.names import MAP_INPUTS
from . import live_image
from .modifiers import new_texture
from .settings import all_oceans, settings_of


def remove_with_meshes(items: Iterable[bpy.types.Object]) -> None:
    """Remove objects of this file, and meshes without other users."""
    for item in [item for item in items if item.library is None]:
        mesh = item.data
        bpy.data.objects.remove(item)
        if not mesh.users:
            bpy.data.meshes.remove(mesh)


def own_image(item: bpy.types.Object, owner: str, name: str, label: str, samples: int) -> bpy.types.Image:
    """The ocean's own image of a map, created if it has none or only that of the ocean it was copied from.

    owner : the setting with the images, "live_maps" or "render_maps"
    name : a key of MAP_INPUTS
    """
    images = getattr(settings_of(item), owner)
    present = getattr(images, name)
    borrowed = present is not None and any(
        getattr(getattr(settings_of(other), owner), name) == present for other in _elders(item)
    )
    if present is None or borrowed:
        setattr(images, name, live_image.new_image(label, samples))
    return getattr(images, name)


def own_texture(item: bpy.types.Object, name: str, label: str) -> None:
    """Give the ocean its own texture for the setting of this name, and update its Displace modifier."""
    settings = settings_of(item)
    shared = getattr(settings, name)
    if shared is None:
        setattr(settings, name, new_texture(label))
    elif (shared.library is not None and item.library is None) or any(
        getattr(settings_of(other), name) == shared for other in _elders(item)
    ):
        setattr(settings, name, shared.copy())
        for modifier in item.modifiers:
            if modifier.type == "DISPLACE" and modifier.texture == shared:
                modifier.texture = getattr(settings, name)


def is_borrowed_mesh(item: bpy.types.Object) -> bool:
    """Whether a linked duplicate still has the mesh of its original, the older ocean."""
    return item.data.users > 1 and any(other.data == item.data for other in _elders(item))


def has_other_users(image: bpy.types.Image | None) -> bool:
    """Whether anything except oceans and their textures uses the image, such as a material."""
    if image is None:
        return False
    holders = [settings_of(item) for item in all_oceans()]
    textures = {settings.texture for settings in holders if settings.texture is not None}
    own = sum(getattr(settings.live_maps, name) == image for settings in holders for name in MAP_INPUTS)
    own += sum(texture.image == image for texture in textures)
    return bool(image.users > own + image.use_fake_user)


def _elders(item: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Oceans created earlier, as a duplicate is younger than its original."""
    return (other for other in all_oceans() if other.session_uid < item.session_uid)
