# SPDX-License-Identifier: GPL-3.0-or-later
"""The gallery's harbour from above shows Kelvin's angle."""

import importlib.util
import math
import sys

import numpy as np
import pytest

from tools.project import ROOT


def test_the_ferrys_wake_ends_at_kelvins_angle(monkeypatch):
    """asin 1/3, measured on the published picture."""
    images = pytest.importorskip("PIL.Image")
    monkeypatch.setattr(sys, "path", [str(ROOT / "examples"), *sys.path])
    place = ROOT / "examples" / "wake_angle.py"
    spec = importlib.util.spec_from_file_location("wake_angle", place)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    grey = np.asarray(images.open(module.PICTURE).convert("L"), np.float64)
    assert module.measured_angle(grey) == pytest.approx(math.degrees(math.asin(1.0 / 3.0)), abs=0.5)
