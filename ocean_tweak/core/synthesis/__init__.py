# SPDX-License-Identifier: GPL-3.0-or-later
"""Wave synthesis: coefficients, their propagation in time, transforms, and the channels derived from them."""
