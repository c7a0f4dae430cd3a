# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea as OpenUSD layers. `pxr` is only imported when a layer is read or written."""
