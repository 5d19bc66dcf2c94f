"""The output folder of the command line: `crossdem.json` marks it as ours, and only ours are ever written to."""

import fcntl
import json
import shutil
from pathlib import Path
from typing import IO

from .case import Case
from .packing import Packing, packing_key

_MARKER = "crossdem.json"
_RUN_FOLDERS = ("runs", "variants", "failed")
_MARK = {"made_by": "crossdem", "layout": 1}


class WorkspaceError(Exception):
    """A folder that must not or cannot be written to."""


class Workspace:
    """An output folder, held by one crossdem at a time: packings/, runs/, inputs/ and the report's files."""

    def __init__(self, root: Path):
        """Makes the folder, or takes up one that an earlier crossdem made. Raises WorkspaceError, leaving nothing."""
        self.root = Path(root)
        self._created: list[Path] = []  # by us and now, outermost first
        try:
            _refuse_foreign(self.root)
            self._is_new = not (self.root / _MARKER).exists()
            self._create_folders()
            self._lock = self._mark()
            self._sweep()
        except (OSError, ValueError) as error:
            self._remove_created()
            reason = getattr(error, "strerror", None) or error
            raise WorkspaceError(f"{root}: cannot be written: {reason}") from error

    def packing_folder(self, case: Case, seed: int) -> Path:
        return self.root / "packings" / f"seed{seed}-{packing_key(case, seed)[:12]}"

    def twin_folder(self, packing: Packing, number: int) -> Path:
        """Of the packing's twin `number`."""
        return packing.folder.with_name(f"{packing.folder.name}-twin{number}")

    def discard_if_new(self) -> None:
        """Undoes the constructor: for a fault that shows only after it. Not once there are runs, which it would orphan."""
        if self._is_new and not any((self.root / name).exists() for name in _RUN_FOLDERS):
            (self.root / _MARKER).unlink(missing_ok=True)
            # New like all the rest, so what lies in it is ours.
            shutil.rmtree(self.root / "packings", ignore_errors=True)
            self._remove_created()

    def _create_folders(self) -> None:
        absent = [folder for folder in (self.root, *self.root.parents) if not folder.exists()]
        for folder in reversed(absent):
            folder.mkdir()
            self._created.append(folder)

    def _mark(self) -> IO:
        marker = open(self.root / _MARKER, "a+")
        try:
            fcntl.flock(marker, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise WorkspaceError(f"{self.root}: another crossdem is writing to it") from None
        if marker.tell() == 0:
            marker.write(json.dumps(_MARK) + "\n")
            marker.flush()
        return marker

    def _sweep(self) -> None:
        """Remove packings that a crossdem that was killed had begun: nobody else makes any here."""
        for unfinished in (self.root / "packings").glob(".seed*"):
            shutil.rmtree(unfinished, ignore_errors=True)

    def _remove_created(self) -> None:
        for folder in reversed(self._created):
            try:
                folder.rmdir()
            except OSError:  # something else lies in it by now
                return


def _refuse_foreign(root: Path) -> None:
    if root.exists() and not root.is_dir():
        raise WorkspaceError(f"{root}: exists and is not a folder; choose another with --out")
    if root.is_dir() and any(root.iterdir()) and not _is_ours(root):
        raise WorkspaceError(
            f"{root}: exists and was not made by crossdem; choose another folder with --out"
        )


def _is_ours(root: Path) -> bool:
    if not (root / _MARKER).is_file():
        return False
    try:
        mark = json.loads((root / _MARKER).read_bytes())
    except (OSError, ValueError):
        return False
    return isinstance(mark, dict) and mark.get("made_by") == _MARK["made_by"]
