"""One engine's process: started, watched, ended."""

from __future__ import annotations

import os
import select
import shutil
import signal
import subprocess
import time
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

GRACE_S = 2.0  # between asking a process to end and ending it


@dataclass(frozen=True)
class Ending:
    """How a process ended."""

    status: int  # exit status; below 0: the signal that ended it
    wall_s: float
    cpu_s: float  # of the process and of the children it waited for

    def __str__(self) -> str:
        if self.status >= 0:
            return f"ended with status {self.status}"
        return f"was ended by signal {-self.status} ({signal.Signals(-self.status).name})"


class Process:
    """A process with a session of its own, so that its children end with it. Its output goes to a log.

    It is ended when the thread that started it is gone, however that came.
    """

    def __init__(self, command: list[str], folder: Path, environment: dict[str, str], log: Path):
        self._started = time.monotonic()
        with open(log, "wb") as output:
            self._process = subprocess.Popen(
                [*bound_to_us(), *command],
                cwd=folder,
                env=os.environ | environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    @property
    def id(self) -> int:
        """Of the process, of its group and of its session."""
        return self._process.pid

    @property
    def wall_s(self) -> float:
        return time.monotonic() - self._started

    def poll(self) -> Ending | None:
        """How it ended, or None while it runs. To be called until it says, and then no more."""
        pid, status, usage = os.wait4(self._process.pid, os.WNOHANG)
        if pid == 0:
            return None
        self._process.returncode = os.waitstatus_to_exitcode(status)
        return Ending(self._process.returncode, self.wall_s, usage.ru_utime + usage.ru_stime)

    def kill(self, number: signal.Signals = signal.SIGTERM, grace_s: float = GRACE_S) -> None:
        """Ask it and its children to end by the signal `number`, end them `grace_s` later, and wait for that."""
        if self._process.returncode is not None:
            return
        self._signal(number)
        try:
            self._process.wait(grace_s)
        except subprocess.TimeoutExpired:
            pass
        self._signal(signal.SIGKILL)
        self._process.wait()

    def _signal(self, number: signal.Signals) -> None:
        try:
            os.killpg(self._process.pid, number)
        except ProcessLookupError:
            pass


def wait_for_any(processes: Sequence[Process], at_most_s: float) -> None:
    """Until one of them has ended, of which none was seen to end before, or `at_most_s`; at once where there is none."""
    if not processes:
        return
    with ExitStack() as descriptors:
        ends = select.poll()
        try:
            for process in processes:
                end = os.pidfd_open(process.id)
                descriptors.callback(os.close, end)
                ends.register(end, select.POLLIN)
        except OSError:  # containers may forbid it
            ends = select.poll()
        ends.poll(1e3 * at_most_s)


def bound_to_us() -> list[str]:
    """What is put before a command that shall not outlive this process; nothing where the system lacks it."""
    found = shutil.which("setpriv")
    return [found, "--pdeathsig", "KILL"] if found else []


class LineCounter:
    """The number of whole lines in a file that grows, or that is not there yet."""

    def __init__(self, path: Path):
        self._path = path
        self._read = 0
        self.lines = 0

    def update(self) -> int:
        if not self._path.is_file():  # or a pipe, which would have us wait
            return self.lines
        with open(self._path, "rb") as file:
            file.seek(self._read)
            new = file.read()
        self._read += len(new)
        self.lines += new.count(b"\n")
        return self.lines
