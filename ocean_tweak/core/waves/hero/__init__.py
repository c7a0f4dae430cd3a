# SPDX-License-Identifier: GPL-3.0-or-later
"""Hero waves: single groups of waves that an artist places in the sea."""
