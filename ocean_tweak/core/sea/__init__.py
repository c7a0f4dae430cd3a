# SPDX-License-Identifier: GPL-3.0-or-later
"""Any sea, and what it is made of: parts, each waves on a grid of their own, that are added up."""
