# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the product against its targets: `python -m benchmarks [--smoke] [--rows GROUP ...]`."""
