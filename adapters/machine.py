"""What of a machine can change the last bits of a run, and what it is called."""

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
    return set(_first_processor("flags").split())


def processor() -> str:
    """Model of the first processor, as it calls itself; empty where the system does not tell."""
    return _first_processor("model name").strip()


def _first_processor(key: str) -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return ""
    return next((line.split(":", 1)[1] for line in lines if line.startswith(key)), "")
