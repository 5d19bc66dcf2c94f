"""SHA256SUMS of a folder with folders in it: written as `sha256sum` writes it, and every way in which a folder departs from it."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator
from pathlib import Path

SUMS = "SHA256SUMS"
_LINE = re.compile(r"([0-9a-f]{64})  (.+)\n")


def sha256_of(path: Path) -> str:
    """SHA-256 [hex] of a file. Raises OSError."""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def files_in(folder: Path) -> list[str]:
    """The paths of all files in `folder`, and in its folders, relative to it and in order."""
    return sorted(
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.is_symlink() or not path.is_dir()
    )


def write_sums(folder: Path) -> str:
    """Write SUMS of all other files in `folder`; returns the folder's identity, the SHA-256 [hex] of SUMS."""
    text = sums_text({name: sha256_of(folder / name) for name in files_in(folder) if name != SUMS})
    (folder / SUMS).write_bytes(text.encode())
    return sha256_of(folder / SUMS)


def sums_text(sums: dict[str, str]) -> str:
    return "".join(f"{sums[name]}  {name}\n" for name in sorted(sums))


def faults_of_sums(folder: Path) -> Iterator[str]:
    """A line for each file that was changed, is missing or was added, and for each line of SUMS that is none."""
    if not (folder / SUMS).is_file():
        yield f"{SUMS} is missing"
        return
    try:
        text = (folder / SUMS).read_bytes().decode("utf-8")
    except (OSError, ValueError) as error:
        yield f"{SUMS} cannot be read: {error}"
        return
    sums: dict[str, str] = {}
    for number, line in enumerate(text.splitlines(keepends=True), start=1):
        if match := _LINE.fullmatch(line):
            sums[match[2]] = match[1]
        else:
            yield f"{SUMS}, line {number}: is no SHA-256 and name"
    if text != sums_text(sums):
        yield f"{SUMS} is not as it was written: one line for each file, in order"
    there = set(files_in(folder)) - {SUMS}
    yield from (f"{name} is missing" for name in sorted(sums.keys() - there))
    yield from (f"{name} was added" for name in sorted(there - sums.keys()))
    for name in sorted(there & sums.keys()):
        path = folder / name
        if path.is_symlink():  # whose content is not of the folder
            yield f"{name} is a link"
        elif not path.is_file():
            yield f"{name} is no file"
        elif sha256_of(path) != sums[name]:
            yield f"{name} was changed"
    for path in sorted(folder.rglob("*")):
        if path.is_dir() and not path.is_symlink() and not any(path.iterdir()):
            yield f"{path.relative_to(folder).as_posix()}/ was added"
