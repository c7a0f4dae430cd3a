# SPDX-License-Identifier: GPL-3.0-or-later
"""Hero waves: single wave groups placed by the artist."""
