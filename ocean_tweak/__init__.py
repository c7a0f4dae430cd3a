# SPDX-License-Identifier: GPL-3.0-or-later
"""Ocean Tweak: directional wave spectra with physical wave heights, for Blender and batch rendering."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .export.sea_files import read_sea, write_sea

__version__ = "1.0.0"
__all__ = ["read_sea", "write_sea"]


def __getattr__(name: str) -> object:
    """Load the package's functions on first use, because Blender imports the package at startup."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from .export import sea_files

    return getattr(sea_files, name)
