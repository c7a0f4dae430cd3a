# SPDX-License-Identifier: GPL-3.0-or-later
"""Points over a bed in a file: what it says of itself, its size, and files that are not of this bed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.core import Ocean
from ocean_tweak.core.sea.over_bed import OVER_BED_CHANNELS, mesh_over_bed
from ocean_tweak.core.synthesis.channels import CHANNELS, SurfaceFields
from ocean_tweak.export.coast_points import COLUMNS, CoastSequence
from ocean_tweak.export.ply import PlyError, told_by_ply, write_ply
from tests.coasts import SMALL_SEA


def test_a_file_tells_its_places_and_time_and_another_is_refused(tmp_path: Path) -> None:
    sequence = CoastSequence(tmp_path, "sea", mesh_over_bed(Ocean(SMALL_SEA)))
    count = sequence.mesh.x.size
    fields = {
        name: np.zeros((count, 3) if name in CHANNELS and CHANNELS[name].components else count, np.float32)
        for name in OVER_BED_CHANNELS
    }
    path = sequence.write(7, SurfaceFields(2.5, fields))
    sequence.check(7)
    told = told_by_ply(path, (COLUMNS,))
    assert told is not None
    assert told["places"] == sequence.mesh.tag != ""
    assert told["time"] == 2.5
    assert 4 * count * len(COLUMNS) < path.stat().st_size <= sequence.bytes
    values = sequence.values(SurfaceFields(2.5, fields))
    write_ply(path, COLUMNS, values[:-1], {})
    with pytest.raises(PlyError, match=f"has not {count} points"):
        sequence.check(7)
