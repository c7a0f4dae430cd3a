# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea as OpenUSD layers. `pxr` is imported when the first layer is read or written, never before."""
