# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the waves of a layer, a patch or a whole sea are."""
