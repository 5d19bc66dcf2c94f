"""An attempt at a run. Two attempts at the same run may be alive at once, on one machine or two: each has a folder of its
own to work in, and a journal of its own that says how it went.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import socket
import time
from contextlib import suppress
from datetime import datetime, timezone
from functools import lru_cache
from pathlib import Path
from secrets import token_hex

WORK = "work"  # ending of the folder that an engine works in
WHOLE = "whole"  # ending of a dataset on its way to its place
FOLDER = re.compile(
    r"\.(?P<run>.+)@(?P<machine>[^@]+)-(?P<process>\d+)-(?P<born>\d+)-[0-9a-f]{8}\.\w+(\.partial)?"
)
FORGOTTEN_S = 24 * 3600.0  # after which nobody comes back to an attempt of another machine


class Attempt:
    """One attempt of this process at the run `run_name`, whose dataset is to lie in `runs`."""

    def __init__(self, run_name: str, runs: Path, journal: Path | None = None):
        self.run_name = run_name
        self.name = f"{run_name}@{machine()}-{os.getpid()}-{_born(os.getpid())}-{token_hex(4)}"
        self.work_dir = runs / f".{self.name}.{WORK}"
        self.whole_dir = runs / f".{self.name}.{WHOLE}"
        self._journal = journal / f"{self.name}.jsonl" if journal else None
        self._open = False

    def begin(self) -> None:
        self._open = True
        self._note("start")

    def end(self, how: str, leaving: bool = False) -> None:
        """Write the last line of the journal: published, was there, failed or stopped. Remove the rest unless `leaving` it."""
        if self._open:
            self._open = False
            with suppress(OSError):  # a full disk
                self._note("end", how=how)
        for folder in () if leaving else (self.work_dir, self.whole_dir):
            shutil.rmtree(folder, ignore_errors=True)

    def _note(self, event: str, **more: str) -> None:
        if not self._journal:
            return
        line = {
            "event": event,
            "run": self.run_name,
            "folder": self.work_dir.name,
            "host": socket.gethostname(),
            "pid": os.getpid(),
            "time_utc": datetime.now(timezone.utc).isoformat(timespec="milliseconds"),
        }
        self._journal.parent.mkdir(parents=True, exist_ok=True)
        with open(self._journal, "a", encoding="utf-8") as file:
            file.write(json.dumps(line | more) + "\n")


def work_folders(runs: Path) -> dict[str, Path]:
    """The folders in `runs` that are, or were, worked in, by the name of their run; of several the newest."""
    found = {}
    for folder in runs.glob(f".*@*.{WORK}"):
        if match := FOLDER.fullmatch(folder.name):
            found.setdefault(match["run"], []).append(folder)
    return {run: max(folders, key=_changed) for run, folders in found.items()}


def clear_away(runs: Path) -> None:
    """Remove what attempts left in `runs` whose process is no more."""
    for folder in runs.glob(".*@*"):
        match = FOLDER.fullmatch(folder.name)
        if match and not _may_be_alive(match, folder):
            shutil.rmtree(folder, ignore_errors=True)


@lru_cache
def machine() -> str:
    """Names the machine and its table of processes: a process id says something only within it."""
    boot = Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii")
    table = os.readlink("/proc/self/ns/pid")
    mark = hashlib.sha256(f"{boot} {table}".encode()).hexdigest()[:6]
    return re.sub(r"[^\w.-]", "_", f"{socket.gethostname()}-{mark}")


def _may_be_alive(match: re.Match, folder: Path) -> bool:
    if match["machine"] != machine():
        return time.time() - _changed(folder) < FORGOTTEN_S
    return _born(int(match["process"])) == match["born"]


def _born(process_id: int) -> str | None:
    """When the process was started, in clock ticks since the machine was; None: there is none, or it has ended and only
    its parent does not know yet.
    """
    try:
        stat = Path(f"/proc/{process_id}/stat").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    state, *fields = stat.rpartition(")")[2].split()
    return None if state in "ZX" else fields[18]


def _changed(folder: Path) -> float:
    """When something in it last changed [s since 1970]; 0 once it is gone."""
    newest = 0.0
    for path in (folder, folder / "output", *folder.glob("output/*")):
        try:
            newest = max(newest, path.stat().st_mtime)
        except OSError:
            continue
    return newest
