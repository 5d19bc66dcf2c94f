"""What tells whether a run is the same run again: a digest of its content, and what of the machine can change last bits."""

from __future__ import annotations

import hashlib
import platform
from pathlib import Path

import numpy as np

from crossdem.adapters.dataset import Dataset

# Instructions that mathematical libraries choose their code by.
FLAGS = ("fma", "avx2", "avx512f")


def content_sha256(dataset: Dataset) -> str:
    """SHA-256 [hex] of the motion and the resistance table, bit by bit.

    What HDF5 or a CSV writer makes of the same numbers does not matter.
    """
    digest = hashlib.sha256()
    arrays = {"radius_m": dataset.radius_m}
    arrays |= {f"motion {name}": values for name, values in vars(dataset.motion).items()}
    arrays |= {f"resistance {name}": values for name, values in dataset.resistance.items()}
    for name, values in sorted(arrays.items()):
        if values is None:  # an engine that does not tell angles
            continue
        numbers = np.ascontiguousarray(values, dtype="<f8")
        digest.update(f"{name} {numbers.shape}\n".encode())
        digest.update(numbers.tobytes())
    return digest.hexdigest()


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
