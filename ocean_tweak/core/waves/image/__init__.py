# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas out of images: white noise or the artist's own, filtered in the plane of wave vectors.

After Gary Mastin, Peter Watterberg and John Mareda: Fourier synthesis of ocean scenes (1987).
"""
