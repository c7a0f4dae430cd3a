# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: the same arguments as `python -m ocean_tweak` and as `blender --command ocean_tweak`."""

from __future__ import annotations

import contextlib
import io
import logging
import os
import sys

from ..core import ParameterError
from ..export import logs
from ..export.cache.job import CacheError
from ..export.cache.locks import Held
from ..export.exr import ExrError
from ..export.python_process import module_command
from ..export.shelf import use_environment, use_folder
from ..export.usd.library import UsdError
from .arguments import make_parser
from .outcome import FAILED, WRONG_ARGUMENTS, UsageError, message_of, remedy_of
from .seas import FileSea, SceneOceans

__all__ = ["FileSea", "SceneOceans", "command", "main"]

_LOG = logging.getLogger(__name__)

#: errors that a user, a disk or another process can cause; any other is a bug and is raised
_EXPECTED = (ParameterError, UsageError, OSError, ExrError, CacheError, UsdError, Held, MemoryError)


def main(argv: list[str] | None = None, scene_oceans: SceneOceans | None = None) -> int:
    """Run one command. Returns the exit code: 0 done, 1 failed, 2 wrong arguments or parameters.

    argv : the arguments after the program's name; those of the process by default
    scene_oceans : inside Blender, a function that returns the file's oceans by object name
    """
    _print_anything()
    try:
        arguments = make_parser(in_blender=scene_oceans is not None).parse_args(argv)
    except SystemExit as end:  # argparse has printed the reason; Blender wants the code as a result
        return int(end.code or 0)
    if arguments.verbose or scene_oceans is None:  # otherwise set by the preferences in Blender
        logs.to_console(logs.LEVELS[min(arguments.verbose, len(logs.LEVELS) - 1)])
    is_alone = scene_oceans is None  # in Blender the extension says where it keeps what takes long
    try:
        if is_alone:
            use_environment()
        return int(arguments.run(arguments, scene_oceans))
    except (*_EXPECTED, KeyboardInterrupt) as error:
        message = f"{message_of(error)}{remedy_of(error)}"
        if getattr(arguments, "openjd", False):
            with contextlib.suppress(BrokenPipeError):
                print(f"openjd_fail: {message}", flush=True)
        _LOG.error("%s", message)
        return WRONG_ARGUMENTS if isinstance(error, (ParameterError, UsageError)) else FAILED
    finally:
        if is_alone:
            use_folder(None)
        logs.end_file()
        _flush()


def command() -> list[str]:
    """The beginning of a command that runs this command line in a new process; arguments follow."""
    return module_command(__name__.rpartition(".")[0])


def _print_anything() -> None:
    """Print characters that the terminal's encoding lacks as escapes instead of failing."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def _flush() -> None:
    """Flush, so that the interpreter does not fail at exit if the reader of the output has gone."""
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
