"""What of a machine can change the last bits of a run."""

from __future__ import annotations

import platform
from pathlib import Path

# Instructions that mathematical libraries choose their code by.
FLAGS = ("fma", "avx2", "avx512f")


def machine_facts() -> dict:
    """What of this machine can change the last bits of a run: processor family, C library, instructions."""
    return {
        "machine": platform.machine(),
        "libc": " ".join(platform.libc_ver()),
        "flags": [flag for flag in FLAGS if flag in _flags()],
    }


def _flags() -> set[str]:
    """Of the first processor; none where the system does not tell."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return set()
    flags = (line.split(":", 1)[1] for line in lines if line.startswith("flags"))
    return set(next(flags, "").split())
