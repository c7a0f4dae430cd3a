# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: the same arguments as `python -m ocean_tweak` and as `blender --command ocean_tweak`."""

from __future__ import annotations

from ..core import ParameterError
from ..export.cache.job import CacheError
from ..export.cache.locks import Held
from ..export.exr import ExrError
from .arguments import make_parser
from .outcome import FAILED, WRONG_ARGUMENTS, UsageError, complain
from .seas import SceneOceans, Sea

__all__ = ["SceneOceans", "Sea", "main"]

#: what a user, a disk or another process can cause; anything else is a bug and raises
_EXPECTED = (ParameterError, UsageError, OSError, ExrError, CacheError, Held, MemoryError)


def main(argv: list[str] | None = None, scene_oceans: SceneOceans | None = None) -> int:
    """Run one command. Returns the exit code: 0 done, 1 failed, 2 wrong arguments or parameters.

    argv : the arguments after the program's name; those of the process by default
    scene_oceans : inside Blender, gives the file's oceans by object name
    """
    try:
        arguments = make_parser(in_blender=scene_oceans is not None).parse_args(argv)
    except SystemExit as end:  # argparse has printed the reason; Blender wants the code as a result
        return int(end.code or 0)
    try:
        return int(arguments.run(arguments, scene_oceans))
    except (*_EXPECTED, KeyboardInterrupt) as error:
        message = _message(error)
        if getattr(arguments, "openjd", False):
            print(f"openjd_fail: {message}", flush=True)
        complain(message)
        return WRONG_ARGUMENTS if isinstance(error, (ParameterError, UsageError)) else FAILED


def _message(error: BaseException) -> str:
    """What is wrong, in a line."""
    if isinstance(error, KeyboardInterrupt):
        return "interrupted; the frames written so far are whole"
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}"
    if isinstance(error, MemoryError) and not str(error):
        return "there is not enough memory: lower the resolution"
    return str(error)
