"""crossdem: one granular case through several discrete element codes, and one verdict.

This module is the package `crossdem`. Its parts are the folders `adapters` and `compare`: beside this
file in a checkout, in `crossdem/` beside this file once installed.
"""

from enum import IntEnum
from pathlib import Path

__version__ = "0.1.0"

_here = Path(__file__).resolve().parent
_installed = _here / "crossdem"
__path__ = [str(_installed if _installed.is_dir() else _here)]


class ExitCode(IntEnum):
    """What the command line ends with; README.md explains each to users."""

    AGREES = 0  # or consistent, with too few seeds for more
    DIFFERS = 1
    BAD_INPUT = 2
    ENGINE_FAILED = 3  # or is missing
    INCONCLUSIVE = 4
    BUG = 70  # EX_SOFTWARE of sysexits.h
    SYSTEM = 74  # EX_IOERR: the system refused a file or a process
    INTERRUPTED = 130  # 128 + SIGINT, as shells have it
    TERMINATED = 143  # 128 + SIGTERM
