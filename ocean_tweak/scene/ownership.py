# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes, images and textures of an ocean are its own: a duplicate gets others before it changes them."""

from __future__ import annotations

import bpy

from . import live_image, modifiers
from .settings import all_oceans, settings_of


def own_image(item: bpy.types.Object, name: str, label: str, samples: int) -> None:
    """Give the ocean an image of its own for the setting of this name."""
    settings = settings_of(item)
    if getattr(settings, name) is None or _is_borrowed(item, name):
        setattr(settings, name, live_image.new_image(label, samples))


def own_texture(item: bpy.types.Object, name: str, label: str) -> None:
    """Give the ocean a texture of its own for the setting of this name; its Displace modifier goes along."""
    settings = settings_of(item)
    shared = getattr(settings, name)
    if shared is None:
        setattr(settings, name, modifiers.new_texture(label))
    elif _is_borrowed(item, name):
        setattr(settings, name, shared.copy())
        for modifier in item.modifiers:
            if modifier.type == "DISPLACE" and modifier.texture == shared:
                modifier.texture = getattr(settings, name)


def is_borrowed_mesh(item: bpy.types.Object) -> bool:
    """Whether a linked duplicate still has the mesh of the ocean it was made from, the older one."""
    return item.data.users > 1 and any(
        other.data == item.data and other.session_uid < item.session_uid for other in all_oceans()
    )


def has_other_users(image: bpy.types.Image | None) -> bool:
    """Whether something besides oceans and their textures reads the image: a material, say."""
    if image is None:
        return False
    holders = [settings_of(item) for item in all_oceans()]
    textures = {settings.texture for settings in holders if settings.texture is not None}
    own = sum(settings.live_image == image for settings in holders)
    own += sum(texture.image == image for texture in textures)
    return bool(image.users > own + image.use_fake_user)


def _is_borrowed(item: bpy.types.Object, name: str) -> bool:
    """Whether a duplicate still has the image or texture of the object it was made from, the older one."""
    block = getattr(settings_of(item), name)
    return any(
        getattr(settings_of(other), name) == block and other.session_uid < item.session_uid
        for other in all_oceans()
    )
