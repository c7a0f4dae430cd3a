# SPDX-License-Identifier: GPL-3.0-or-later
"""Output: bakes and the choice of what is shown, and USD layers for other programs."""

import time
from datetime import datetime

import bpy
from bpy.app.translations import pgettext_iface as translated

from ...core.data.frames import format_frames
from ...core.data.printable import readable_bytes
from ...export.cache.estimate import Estimate
from ...export.usd import library
from ...nodes.names import MAP_INPUTS
from ...scene import bake_process, bake_versions, failures, stored_paths, usd
from ...scene.image_sequence import baked_frames
from ...scene.portability import neighbours_of
from ...scene.settings import OceanSettings
from ...scene.shots import scene_frames
from .. import bake_operators, sequence_operators, usd_operators
from ..active_ocean import shown_ocean
from ..usd_properties import draw_choices
from .drawing import OceanPanel, active_settings, message, progress_bar, row, split

#: lines of what needs the extension
_MOST_NEEDS = 4


class OCEAN_PT_bake(OceanPanel, bpy.types.Panel):
    """Baked frames on disk."""

    bl_idname = "OCEAN_PT_bake"
    bl_label = "Bake"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the cache, the button or the progress, and what is shown."""
        layout, settings = split(self.layout), active_settings(context)
        bake = bake_process.running(shown_ocean(context))
        if bake is not None:
            progress_bar(layout, bake, bake_operators.OCEAN_OT_stop_bake.bl_idname)
        else:
            layout.prop(settings, "cache_folder")
            layout.operator(
                bake_operators.OCEAN_OT_bake.bl_idname, text=_bake_label(context), icon="RENDER_ANIMATION"
            )
        shown = (
            "Baked files move the ocean" if settings.source == "SEQUENCE" else "The ocean is computed live"
        )
        layout.label(text=shown, icon="FILE_CACHE" if settings.source == "SEQUENCE" else "PLAY")
        if settings.source == "SEQUENCE":
            _sequence(layout, context)
        choose = "Choose Another" if settings.sequence_maps.disp else "Use Baked Sequence"
        layout.operator(sequence_operators.OCEAN_OT_use_sequence.bl_idname, text=choose, icon="FILE_FOLDER")
        _needs(layout, context)
        _disk(layout, context)


def _bake_label(context: bpy.types.Context) -> str:
    settings, count = active_settings(context), len(scene_frames(context.scene))
    if 0 < settings.bake_done < settings.bake_total:
        return translated("Resume Bake ({} of {} Frames)").format(settings.bake_done, settings.bake_total)
    return translated("Bake {} Frames").format(count)


def _sequence(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the files, what is missing of them, and the way back."""
    settings = active_settings(context)
    image = settings.sequence_maps.disp
    column = layout.column(align=True)
    if image:
        row(column, "Version", _folder_name(settings))
    row(column, "Files", stored_paths.image_file(image).name if image else "none chosen")
    if image:
        row(column, "Frames", format_frames(baked_frames(settings)))
        row(column, "Maps", ", ".join(name for name in MAP_INPUTS if getattr(settings.sequence_maps, name)))
    if settings.missing_file:
        message(layout, context, failures.missing_text(settings), alert=True)
    if settings.bake_is_elsewhere:
        layout.operator(bake_operators.OCEAN_OT_take_cache_along.bl_idname, icon="DUPLICATE")
    layout.prop(settings, "out_of_range")
    if settings.error:
        layout.operator(sequence_operators.OCEAN_OT_use_live.bl_idname, icon="PLAY")


def _needs(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw what a render needs the extension for."""
    needs = neighbours_of(shown_ocean(context)).needs
    if not needs:
        return
    column = layout.column(align=True)
    column.label(text="Renders Need Ocean Tweak")
    for need in needs[:_MOST_NEEDS]:
        message(column, context, need.text)
    if len(needs) > _MOST_NEEDS:
        column.label(text=translated("And {} more").format(len(needs) - _MOST_NEEDS))


def _folder_name(settings: OceanSettings) -> str:
    """Of the folder that the shown files are in; the disk is not asked."""
    image = settings.sequence_maps.disp
    return "" if image is None else stored_paths.image_file(image).parent.name


def _disk(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the estimate of the next bake and the versions on disk, as last listed."""
    listing = bake_versions.known(shown_ocean(context))
    look = bake_operators.OCEAN_OT_look_at_bakes.bl_idname
    if listing is None:
        layout.operator(look, icon="DISK_DRIVE")
        return
    column = layout.box().column(align=True)
    if listing.to_come is not None:
        row(column, "To Come", _takes(listing.to_come, len(scene_frames(context.scene))))
        row(column, "Disk", translated("{} free").format(readable_bytes(listing.to_come.free)))
    total = readable_bytes(sum(version.bytes for version in listing.versions))
    row(column, "On Disk", translated("{} bakes, {}").format(len(listing.versions), total))
    shown = _folder_name(active_settings(context))
    for version in reversed(listing.versions):
        _version(column, version, is_shown=version.folder.name == shown)
    buttons = layout.row(align=True)
    buttons.operator(look, text="Look Again", icon="FILE_REFRESH")
    if any(version.folder.name != shown for version in listing.versions):
        delete = buttons.operator(
            bake_operators.OCEAN_OT_delete_bake.bl_idname, text="Delete Others", icon="TRASH"
        )
        delete.version = ""


def _takes(to_come: Estimate, frames: int) -> str:
    """Bytes and minutes of so many frames."""
    share = frames / max(to_come.frames, 1)
    seconds = round(to_come.seconds * share)
    return f"about {readable_bytes(to_come.bytes * share)}, {seconds // 60}:{seconds % 60:02d}"


def _version(layout: bpy.types.UILayout, version: bake_versions.Version, is_shown: bool) -> None:
    line = layout.row(align=True)
    # as the artist's clock shows it
    changed, now = (datetime.fromtimestamp(moment) for moment in (version.time, time.time()))
    day = changed.strftime("%m-%d %H:%M" if changed.year == now.year else "%Y-%m-%d")
    text = f"{version.folder.name.partition('-')[0]}  {readable_bytes(version.bytes)}, {day}"
    line.label(text=text, icon="CHECKMARK" if is_shown else "BLANK1", translate=False)
    if not is_shown:
        delete = line.operator(bake_operators.OCEAN_OT_delete_bake.bl_idname, text="", icon="TRASH")
        delete.version = version.folder.name


class OCEAN_PT_usd(OceanPanel, bpy.types.Panel):
    """The sea as USD."""

    bl_idname = "OCEAN_PT_usd"
    bl_label = "USD"
    bl_parent_id = "OCEAN_PT_bake"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw where the layers go, what they hold, and the buttons or the progress."""
        layout, item = split(self.layout), shown_ocean(context)
        settings, process = active_settings(context).usd, usd.running(item)
        if not library.is_installed():
            message(layout, context, library.MISSING_IN_BLENDER, alert=True)
        layout.prop(settings, "file", placeholder=usd.default_file(item))
        draw_choices(layout, settings, neighbours_of(item).has_bake)
        if process is not None:
            progress_bar(layout, process, usd_operators.OCEAN_OT_stop_usd.bl_idname)
        else:
            text = translated("Export {} Frames").format(len(scene_frames(context.scene)))
            layout.operator(usd_operators.OCEAN_OT_export_usd.bl_idname, text=text, icon="EXPORT")
        layout.operator(usd_operators.OCEAN_OT_verify_usd.bl_idname, icon="CHECKMARK")
        layout.operator(usd_operators.OCEAN_OT_import_usd.bl_idname, icon="IMPORT")


CLASSES = (OCEAN_PT_bake, OCEAN_PT_usd)
