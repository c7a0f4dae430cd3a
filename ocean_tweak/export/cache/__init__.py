# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked frames on disk: where they lie, what each one is, who is making which, and whether they are right."""
