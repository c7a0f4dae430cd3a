# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas from images: white noise or an artist's image, filtered in the Fourier domain.

After Gary Mastin, Peter Watterberg and John Mareda: Fourier synthesis of ocean scenes (1987).
"""
