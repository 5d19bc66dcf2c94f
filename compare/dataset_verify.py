"""Whether a package is as it was built, to the byte."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from .dataset_descriptor import DESCRIPTOR
from .dataset_sums import SUMS, faults_of_sums, sha256_of
from .recorded import RecordError


def faults_of_package(folder: Path, identity: str | None = None) -> list[str]:
    """A line for every fault, none for a sound package. `identity`: what it is to be, SHA-256 [hex] of its SUMS.

    Raises RecordError where there is no package.
    """
    if folder.is_file():
        raise RecordError([f"{folder}: is no folder; unpack it and verify what comes out"])
    if not any((folder / name).is_file() for name in (SUMS, DESCRIPTOR)):
        raise RecordError(
            [f"{folder}: there is no package; `crossdem dataset build CASE -o {folder}` makes one"]
        )
    faults = list(faults_of_sums(folder))
    faults += _faults_of_descriptor(folder)
    if identity and (folder / SUMS).is_file():
        found = sha256_of(folder / SUMS)
        if found != identity.lower():
            faults.append(f"{SUMS}: its identity is {found}, and not {identity.lower()}")
    return faults


def _faults_of_descriptor(folder: Path) -> Iterator[str]:
    """Where the second list of hashes tells otherwise: SUMS may have been written anew beside a changed file."""
    try:
        resources = json.loads((folder / DESCRIPTOR).read_bytes())["resources"]
        for entry in resources:
            path = folder / entry["path"]
            if path.is_file() and f"sha256:{sha256_of(path)}" != entry["hash"]:
                yield f"{entry['path']} is not what {DESCRIPTOR} lists"
    except FileNotFoundError:
        return  # said of SUMS
    except (OSError, ValueError, LookupError, TypeError) as error:
        yield f"{DESCRIPTOR} cannot be read: {error}"
