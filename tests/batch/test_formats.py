# SPDX-License-Identifier: GPL-3.0-or-later
"""What a newer version of the program wrote is refused in a line, and stays as it is."""

import dataclasses
import json
import re

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import OceanParameters, ParameterError
from ocean_tweak.core.data import formats
from ocean_tweak.core.parameters.fingerprint import fingerprint, shot_fingerprint
from ocean_tweak.core.parameters.presets import built_in
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.sea.bake import bake
from ocean_tweak.export.cache.folders import open_folder, read_job
from ocean_tweak.export.cache.job import CacheError, Job, uid_of
from ocean_tweak.export.cache.records import CacheSink, FrameRecord
from ocean_tweak.export.exr import ExrError, read_header, read_image, write_image

NEWER = r"format = 2: was written by a newer Ocean Tweak, and this one reads up to 1: update the extension"
NEWER_SEA = NEWER.replace("format = 2", "format = 3").replace("up to 1", "up to 2")
SEA = OceanParameters(resolution=16)
#: what the first version without a number in its JSON made of the default sea of 16² samples
FINGERPRINT = "bef05b5eee19f69524838c47ecc4610db0e427d4334f2ebed229ceb2ca55e6c1"


def with_format(text, number):
    return json.dumps({**json.loads(text), "format": number})


def changed(path, **values):
    """Change JSON in a file, with a seal that fits."""
    data = {**json.loads(path.read_text()), **values}
    del data["sha256"]
    path.write_text(json.dumps({**data, "sha256": fingerprint(data)}))


@pytest.fixture
def folder(tmp_path):
    """A bake of one frame."""
    command = ["bake", "--set", "resolution=16", "--frames", "1", "--name", "sea", "--out"]
    assert main([*command, str(tmp_path)]) == 0
    (found,) = tmp_path.glob("*/v001-*")
    return found


@pytest.mark.parametrize("kind", [OceanParameters, Shot])
def test_json_of_seas(kind):
    sea = SEA if kind is OceanParameters else Shot(SEA, Animation(1, (("choppiness", (0.5, 1.0)),)))
    text = sea.to_json()
    assert json.loads(text)["format"] == 2
    assert "format" not in sea.to_dict()
    without = json.dumps(sea.to_dict())
    assert kind.from_json(text) == kind.from_json(without) == sea
    with pytest.raises(ParameterError, match=NEWER_SEA):
        kind.from_json(with_format(text, 3))
    for number in (0, True, "1", 1.0, None):
        with pytest.raises(ParameterError, match=r"format = .*: must be a whole number from 1"):
            kind.from_json(with_format(text, number))


def test_a_number_changes_no_fingerprint():
    numbered = Shot.from_json(Shot(SEA).to_json())
    assert shot_fingerprint(numbered) == FINGERPRINT


def test_presets():
    preset = next(iter(built_in().values()))
    assert type(preset).from_json(preset.to_json()) == preset
    with pytest.raises(ParameterError, match=NEWER_SEA):
        type(preset).from_json(with_format(preset.to_json(), 3))


def test_images(tmp_path):
    path = tmp_path / "image.exr"
    for number, refused in ((1, False), (2, True)):
        write_image(path, np.zeros((4, 4, 3)), {"format": number}, SEA.timing.fps)
        for read in (read_image, read_header):
            if refused:
                with pytest.raises(ExrError, match=rf"{re.escape(str(path))}: {NEWER}"):
                    read(path)
            else:
                read(path)


@pytest.mark.parametrize("key", ["format", "synthesis"])
def test_jobs_are_refused_and_not_written_again(folder, key, capsys):
    changed(folder / "bake.json", **{key: 2})
    before = (folder / "bake.json").read_bytes()
    with pytest.raises(CacheError, match=NEWER.replace("format", key)):
        read_job(folder)
    for image in folder.glob("*.exr"):  # they might tell the job, were it damaged
        image.unlink()
    for command in (["resume", str(folder)], ["verify", str(folder)]):
        assert main(command) == 1
        assert "update the extension" in capsys.readouterr().err
    assert (
        main(
            [
                "bake",
                "--set",
                "resolution=16",
                "--frames",
                "1",
                "--name",
                "sea",
                "--out",
                str(folder.parents[1]),
            ]
        )
        == 1
    )
    assert (folder / "bake.json").read_bytes() == before


def test_records_are_refused_and_their_frames_not_made_again(folder, capsys):
    record = folder / "records" / "0001.json"
    changed(record, format=2)
    before = {path: path.read_bytes() for path in folder.rglob("*.*") if path.is_file()}
    for command in (["resume", str(folder)], ["verify", str(folder)]):
        assert main(command) == 1
        assert re.search(rf"{re.escape(str(record))}: {NEWER}", capsys.readouterr().err)
    assert {path: path.read_bytes() for path in before} == before
    with pytest.raises(formats.NewerFormatError):
        FrameRecord.from_dict(json.loads(record.read_text()))


def test_a_bake_without_newer_numbers_is_read(folder):
    job = read_job(folder)
    assert isinstance(job, Job)
    assert json.loads((folder / "bake.json").read_text())["format"] == 1


#: SHA-256 of what the program before made of the same sea, of maps without foam and with it
FORMER_JOBS = {
    ("disp", "vel"): "2ed089dfcb9afa8dc907c8591c8ac9d6464b3218ee4d2678de221955159247ce",
    ("disp", "foam"): "684eee53022efa4750ece843e0a1efb605ddb26dc142700402287cc5a5ec5ec0",
}


def test_only_bakes_with_foam_are_others_where_foam_is():
    for maps, former in FORMER_JOBS.items():
        job = Job("sea", "1", Shot(SEA), maps, encoding=1)
        assert (job.fingerprint == former) == ("foam" not in maps)
        assert Job("sea", "1", Shot(SEA), maps, foam=1, encoding=1).fingerprint == former
    assert "foam" not in Job("sea", "1", Shot(SEA), ("disp", "vel")).to_dict()
    assert Job("sea", "1", Shot(SEA), ("disp", "vel"), foam=1) == Job("sea", "1", Shot(SEA), ("disp", "vel"))


def test_a_job_that_a_killed_process_began_to_write_goes(tmp_path):
    job = Job("sea", uid_of("sea"), Shot(SEA), ("disp",), "ZIP", (1, 2))
    folder = open_folder(tmp_path, job)
    (folder / ".bake.json.0224252bd22a4c2c.part").write_text("{")
    assert open_folder(tmp_path, job) == folder
    assert [path.name for path in folder.iterdir() if path.is_file()] == ["bake.json"]


@pytest.fixture
def with_former_foam(tmp_path, monkeypatch):
    """A bake of two frames whose foam is of the first version, which no file tells."""
    monkeypatch.setattr(formats, "FOAM", 1)
    job = Job("sea", uid_of("sea"), Shot(SEA), ("disp", "foam"), "ZIP", (1, 2), foam=1)
    made = open_folder(tmp_path, job)
    assert list(bake(job.shot, (1, 2), CacheSink(made, job)))
    monkeypatch.undo()
    assert "foam" not in json.loads((made / "bake.json").read_text())
    return made


def test_former_foam_is_known_but_not_made(with_former_foam, capsys):
    folder = with_former_foam
    assert read_job(folder).foam == 1
    assert main(["verify", str(folder)]) == 0
    assert main(["resume", str(folder)]) == 0, capsys.readouterr().err
    own = ["--set", "resolution=16", "--name", "sea", "--maps", "disp,foam", "--compression", "ZIP"]
    (folder / "bake.json").unlink()
    assert main(["resume", str(folder)]) == 0  # the images tell the job
    assert read_job(folder).foam == 1
    (folder / "sea_foam.0002.exr").unlink()
    capsys.readouterr()
    assert main(["resume", str(folder), "--frames", "1-2"]) == 1
    told = capsys.readouterr().err
    assert "was baked with foam of version 1, which this program shows but no longer makes" in told
    assert not (folder / "sea_foam.0002.exr").exists()
    assert main(["bake", *own, "--frames", "1", "--out", str(folder.parents[1])]) == 0
    (beside,) = folder.parent.glob("v002-*")
    assert json.loads((beside / "bake.json").read_text())["foam"] == formats.FOAM


def test_windrows_of_before_are_told_where_the_wind_draws_foam_out():
    """From 7 Bft on, in any frame; other bakes are as they were."""
    storm = SEA.replace(layers=(dataclasses.replace(SEA.layers[0], wind_speed=25.0),))
    rising = Animation(1, (("layers.0.wind_speed", (9.0, 16.0)),))
    for shot, maps, are_told in (
        (Shot(SEA), ("disp", "foam"), False),
        (Shot(storm), ("disp", "vel"), False),
        (Shot(storm), ("disp", "foam"), True),
        (Shot(SEA, rising), ("disp", "foam"), True),
    ):
        job, former = (Job("sea", "1", shot, maps, frames=(1,), **said) for said in ({}, {"windrows": 1}))
        assert ("windrows" in job.to_dict()) == are_told
        assert (job.fingerprint != former.fingerprint) == are_told
        assert Job.from_dict(former.to_dict()) == former
    former = Job("sea", "1", Shot(storm), ("disp", "foam"), frames=(1,), windrows=1)
    with pytest.raises(CacheError, match=r"windrows of version 1, which this program shows but no longer"):
        former.check_foam()


def test_a_bake_of_newer_foam_is_refused(tmp_path, capsys):
    own = ["bake", "--set", "resolution=16", "--frames", "1", "--name", "sea", "--maps", "disp,foam"]
    assert main([*own, "--out", str(tmp_path)]) == 0
    (folder,) = tmp_path.glob("*/v001-*")
    changed(folder / "bake.json", foam=formats.FOAM + 1)
    assert main(["verify", str(folder)]) == 1
    assert "update the extension" in capsys.readouterr().err
