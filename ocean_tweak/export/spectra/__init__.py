# SPDX-License-Identifier: GPL-3.0-or-later
"""Files with measured and forecast spectra: NDBC's text and SWAN's."""
