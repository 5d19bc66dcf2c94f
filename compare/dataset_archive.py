"""The archive of a package: the same bytes for the same files, whoever packs them, and when."""

from __future__ import annotations

import gzip
import tarfile
from pathlib import Path

from .dataset_sums import files_in


def archive_of(folder: Path) -> Path:
    """Where the archive of the package in `folder` lies."""
    return folder.absolute().with_name(f"{folder.absolute().name}.tar.gz")


def write_archive(folder: Path) -> Path:
    """Write the archive beside `folder`, whole or not at all; returns its path."""
    path = archive_of(folder)
    partial = path.with_name(f".{path.name}.partial")
    try:
        with open(partial, "wb") as file, gzip.GzipFile("", "wb", 9, file, mtime=0) as packed:
            with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
                for name in files_in(folder):
                    _add(archive, folder / name, f"{folder.absolute().name}/{name}")
        partial.rename(path)
    finally:
        partial.unlink(missing_ok=True)
    return path


def _add(archive: tarfile.TarFile, path: Path, name: str) -> None:
    """Without owner, and with neither time nor mode of its own."""
    entry = tarfile.TarInfo(name)
    entry.size = path.stat().st_size
    entry.mode = 0o644
    with open(path, "rb") as file:
        archive.addfile(entry, file)
