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
    except (ParameterError, UsageError) as error:
        complain(error)
        return WRONG_ARGUMENTS
    except OSError as error:
        complain(f"{error.filename}: {error.strerror}" if error.filename else error)
        return FAILED
    except (ExrError, CacheError, Held) as error:
        complain(error)
        return FAILED
    except MemoryError as error:
        complain(error if str(error) else "there is not enough memory: lower the resolution")
        return FAILED
    except KeyboardInterrupt:
        complain("interrupted; the frames written so far are whole")
        return FAILED
