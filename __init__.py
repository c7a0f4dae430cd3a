# SPDX-License-Identifier: GPL-3.0-or-later
"""Door of the Blender extension: nothing is imported before Blender enables it."""


def register() -> None:
    """Enable the extension; called by Blender."""
    from .ocean_tweak import registration

    registration.register(__package__)


def unregister() -> None:
    """Disable the extension; called by Blender."""
    from .ocean_tweak import registration

    registration.unregister()
