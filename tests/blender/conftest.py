# SPDX-License-Identifier: GPL-3.0-or-later
from tests.blender_fixtures import empty_scene, extension, package  # noqa: F401 - fixtures for every test here
