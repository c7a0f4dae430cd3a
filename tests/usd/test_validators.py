# SPDX-License-Identifier: GPL-3.0-or-later
"""Two validators that were made by others."""

from __future__ import annotations

import pytest
from pxr import Usd, UsdValidation
from usd_validation_nvidia import ValidationEngine

OPTIONS = [
    {"form": "points"},
    {"form": "clips"},
    {"form": "displacement"},
    {"form": "points", "up_axis": "Y", "metres_per_unit": 0.01},
    {"form": "clips", "up_axis": "Y", "metres_per_unit": 0.01},
    {"form": "displacement", "up_axis": "Y", "metres_per_unit": 0.01},
    {"form": "clips", "tiles": (2, 2), "proxy": 8, "variants": (32, 16)},
    {"form": "points", "tiles": (2, 2), "proxy": 8, "half": True, "frames": "1001-1002x0.5"},
    {"form": "displacement", "tiles": (2, 2), "proxy": 8, "variants": (32, 16)},
]  # fmt: skip

#: the package usd-core is built without MaterialX and knows none of its shaders; Blender's own OpenUSD is,
#: and checks them in test_in_blender.py
MATERIALX = "shaderId 'ND_"
#: rule → why its warning, never its failure, is no fault here
EXPLAINED = {
    "IndexedPrimvarChecker": "foam is the same in many places, but elsewhere in the next frame: an index for "
    "each vertex of each frame would take as much again",
}


@pytest.mark.parametrize("options", OPTIONS, ids=lambda options: " ".join(map(str, options.values())))
def test_pixars_validators(exported, options):
    stage = Usd.Stage.Open(str(exported(**options)))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 20
    errors = UsdValidation.ValidationContext(validators).Validate(stage)
    assert [text for error in errors if MATERIALX not in (text := error.GetMessage())] == []


@pytest.mark.parametrize("options", OPTIONS, ids=lambda options: " ".join(map(str, options.values())))
def test_nvidias_validator(exported, options):
    issues = ValidationEngine().validate(str(exported(**options))).issues()
    left = [
        (issue.rule.__name__, issue.message)
        for issue in issues
        if MATERIALX not in issue.message
        and not (issue.severity.name == "WARNING" and issue.rule.__name__ in EXPLAINED)
    ]
    assert left == []


def test_a_fault_is_found(exported):
    """The validators do look: a mesh without counts is one."""
    stage = Usd.Stage.Open(str(exported(form="points")))
    stage.GetRootLayer().ClearDefaultPrim()
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    try:
        assert UsdValidation.ValidationContext(validators).Validate(stage)
    finally:
        stage.Reload()
