# SPDX-License-Identifier: GPL-3.0-or-later
"""The only place that changes Blender's data: mesh, images, modifiers and handlers."""
