# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked frames on disk: folders, jobs, records, locks and verification."""
