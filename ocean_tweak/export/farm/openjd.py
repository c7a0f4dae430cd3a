# SPDX-License-Identifier: GPL-3.0-or-later
"""A shot as an Open Job Description bundle: `template.json`, `parameter_values.json` and the seas.

Template schema "jobtemplate-2023-09" of https://github.com/OpenJobDescription/openjd-specifications; the
bundle's layout is that of AWS Deadline Cloud.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ... import __version__
from ...core.data.frames import format_frames
from ..cache.job import Job
from ..files import write_texts
from .shot_job import (
    LONGEST_VALUE,
    RENDER_SCRIPT,
    SEAS,
    ShotJob,
    bake_arguments,
    chunks,
    render_arguments,
    sea_files,
    verify_arguments,
)

TEMPLATE, VALUES = "template.json", "parameter_values.json"

#: the schema's own limit
_MOST_RANGES = 1024
#: s that a cancelled bake has to finish its frame
_NOTICE = 300

_Data = dict[str, Any]


def write(folder: Path, job: ShotJob) -> list[Path]:
    """Write the bundle. Returns its files; raises ValueError for a shot that makes no bundle, or OSError."""
    own = {TEMPLATE: template(job), VALUES: parameter_values(job)}
    texts = {
        folder / name: json.dumps(data, indent=2, ensure_ascii=False) + "\n" for name, data in own.items()
    }
    (folder / SEAS).mkdir(parents=True, exist_ok=True)
    return write_texts(sea_files(folder, job) | texts)


def template(job: ShotJob) -> _Data:
    """The job template as plain data. Raises ValueError for more tasks than the schema allows."""
    steps = [
        step
        for number, bake in enumerate(job.bakes)
        for step in (_bake_step(job, bake, number), _verify_step(job, bake, number))
    ]
    if job.render is not None:
        steps.append(_render_step(job))
    extensions: _Data = {} if job.plain_ranges else {"extensions": ["TASK_CHUNKING"]}
    return {
        "specificationVersion": "jobtemplate-2023-09",
        **extensions,
        "name": job.name,
        "description": f"Bakes and verifies seas, renders from them. Written by Ocean Tweak {__version__}",
        "parameterDefinitions": [*_sea_parameters(job), *_frame_parameters(job), *_programs(job)],
        "steps": steps,
    }


def parameter_values(job: ShotJob) -> _Data:
    """The job's own values: paths outside the bundle, which may not be a template's defaults."""
    paths = {"Cache": job.cache}
    if job.render is not None:
        paths |= {"BlendFile": job.render.blend, "Pictures": job.render.pictures}
    return {
        "parameterValues": [
            {"name": name, "value": str(path.absolute())} for name, path in paths.items() if path is not None
        ]
    }


def _sea_parameters(job: ShotJob) -> list[_Data]:
    parameters = [
        _path("Seas", "The seas' parameters, one JSON file each", "DIRECTORY", "IN", SEAS),
        _path("Cache", "Folder for the baked frames; each sea gets its own folder in it", "DIRECTORY", "OUT",
              "cache"),
    ]  # fmt: skip
    if job.render is not None:
        blend = _path("BlendFile", "The .blend file to render", "FILE", "IN")
        pictures = _path("Pictures", "Folder for the pictures", "DIRECTORY", "OUT", "pictures")
        parameters += [blend, pictures]
    return parameters


def _frame_parameters(job: ShotJob) -> list[_Data]:
    if job.plain_ranges:
        return []
    text = _farm_frames(job)
    if len(text) > LONGEST_VALUE:
        raise ValueError(
            f"scattered frames take {len(text)} characters, at most {LONGEST_VALUE} are allowed: "
            "write them out with --plain-ranges"
        )
    frames = {
        "name": "Frames",
        "type": "STRING",
        "minLength": 1,
        "default": text,
        "description": "Frames of the shot: 1-250, or 1-99:2, or 1,5,7-9",
        "userInterface": {"control": "LINE_EDIT", "label": "Frames", "groupLabel": "Shot"},
    }
    parameters = [frames, _count("ChunkSize", job.chunk, "Frames per baking or verifying task")]
    if job.render is not None:
        parameters.append(_count("RenderChunkSize", job.render.chunk, "Frames per rendering task"))
    return parameters


def _programs(job: ShotJob) -> list[_Data]:
    commands = {
        "Python": (job.python, "A Python with Ocean Tweak: pip install ocean-tweak"),
        "Blender": (job.blender, "Blender, as it is called on the farm's machines"),
    }
    used = {job.bake_with.capitalize()} | ({"Blender"} if job.render is not None else set())
    return [
        {
            "name": name,
            "type": "STRING",
            "minLength": 1,
            "default": command,
            "description": description,
            "userInterface": {"control": "LINE_EDIT", "label": name, "groupLabel": "Programs"},
        }
        for name, (command, description) in commands.items()
        if name in used
    ]


def _path(name: str, description: str, kind: str, flow: str, default: str | None = None) -> _Data:
    control = "CHOOSE_DIRECTORY" if kind == "DIRECTORY" else "CHOOSE_INPUT_FILE"
    return {
        "name": name,
        "type": "PATH",
        "objectType": kind,
        "dataFlow": flow,
        **({} if default is None else {"default": default}),
        "description": description,
        "userInterface": {"control": control, "label": name, "groupLabel": "Files"},
    }


def _count(name: str, default: int, description: str) -> _Data:
    return {
        "name": name,
        "type": "INT",
        "minValue": 1,
        "default": default,
        "description": description,
        "userInterface": {"control": "SPIN_BOX", "label": name, "groupLabel": "Shot"},
    }


def _bake_step(job: ShotJob, bake: Job, number: int) -> _Data:
    frames = _farm_frames(job) if job.plain_ranges else "{{Param.Frames}}"
    arguments = bake_arguments(
        job, bake, "{{Param.Seas}}", "{{Param.Cache}}", frames, "{{Task.Param.Frames}}", openjd=True
    )
    run = {
        **_command(job.bake_with, arguments),
        "cancelation": {"mode": "NOTIFY_THEN_TERMINATE", "notifyPeriodInSeconds": _NOTICE},
    }
    return _step(_name("Bake", job, number), _tasks(job, job.chunk, "ChunkSize"), run)


def _verify_step(job: ShotJob, bake: Job, number: int) -> _Data:
    arguments = verify_arguments(
        job, bake, "{{Param.Seas}}", "{{Param.Cache}}", "{{Task.Param.Frames}}", openjd=True
    )
    tasks = _tasks(job, job.chunk, "ChunkSize")
    run = _command(job.bake_with, arguments)
    return _step(_name("Verify", job, number), tasks, run, [_name("Bake", job, number)])


def _render_step(job: ShotJob) -> _Data:
    render = job.render
    assert render is not None
    arguments = [
        "--background", "{{Param.BlendFile}}", "--python-exit-code", "1", "--python", "{{Task.File.Render}}",
        "--",
        *render_arguments(job, "{{Param.Cache}}", "{{Task.Param.Frames}}", "{{Param.Pictures}}", openjd=True),
    ]  # fmt: skip
    tasks = _tasks(job, render.chunk, "RenderChunkSize")
    verified = [_name("Verify", job, number) for number in range(len(job.bakes))]
    step = _step("Render", tasks, _command("blender", arguments), verified)
    step["script"]["embeddedFiles"] = [
        {
            "name": "Render",
            "filename": RENDER_SCRIPT.name,
            "type": "TEXT",
            "data": RENDER_SCRIPT.read_text(encoding="utf-8"),
        }
    ]
    return step


def _step(name: str, tasks: _Data, run: _Data, after: list[str] | None = None) -> _Data:
    dependencies: _Data = {"dependencies": [{"dependsOn": other} for other in after]} if after else {}
    return {"name": name, **dependencies, "parameterSpace": tasks, "script": {"actions": {"onRun": run}}}


def _name(what: str, job: ShotJob, number: int) -> str:
    return what if len(job.bakes) == 1 else f"{what} {number + 1}"


def _command(program: str, arguments: list[str]) -> _Data:
    return {"command": f"{{{{Param.{program.capitalize()}}}}}", "args": arguments}


def _tasks(job: ShotJob, size: int, size_parameter: str) -> _Data:
    if not job.plain_ranges:
        frames = {
            "name": "Frames",
            "type": "CHUNK[INT]",
            "range": "{{Param.Frames}}",
            "chunks": {
                "defaultTaskCount": f"{{{{Param.{size_parameter}}}}}",
                "rangeConstraint": "NONCONTIGUOUS",
            },
        }
        return {"taskParameterDefinitions": [frames]}
    ranges = chunks(job.frames, size)
    if len(ranges) > _MOST_RANGES:
        raise ValueError(f"{len(ranges)} tasks in a step: at most {_MOST_RANGES} can be written out")
    longest = max(map(len, ranges))
    if longest > LONGEST_VALUE:
        raise ValueError(
            f"the frames of a task take {longest} characters, at most {LONGEST_VALUE} are "
            "allowed: lower --chunk"
        )
    return {"taskParameterDefinitions": [{"name": "Frames", "type": "STRING", "range": ranges}]}


def _farm_frames(job: ShotJob) -> str:
    return format_frames(job.frames, ":")
