"""What tells whether a run is the same run again: a digest of its content."""

from __future__ import annotations

import hashlib

import numpy as np

from crossdem.adapters.dataset import Dataset


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
