# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes docs/papers: what each paper says beside what the code of today makes of it."""
