"""A live line per run on a terminal: how far, and how long still. Elsewhere plain lines, now and then."""

import time
from datetime import timedelta

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

from crossdem.adapters.workflow.watch import Progress as RunsProgress

LIVE_RUNS = 8  # runs with a line of their own beside the one of all
PLAIN_S = 30.0  # between plain lines about all runs


class ProgressDisplay:
    """Use as a context. A job appears with its first `update`."""

    def __init__(self, console: Console):
        self._live = Progress(
            TextColumn("{task.description:18}", markup=False),
            BarColumn(),
            TaskProgressColumn(),
            TextColumn("{task.fields[left]}"),
            console=console,
            transient=True,
            disable=not console.is_interactive,
        )
        self._tasks = {}
        self._quarters: dict[str, int] = {}
        self._finished: set[str] = set()
        self._told = time.monotonic()
        self._last_told = ""

    def __enter__(self) -> "ProgressDisplay":
        if not self._live.disable:
            self._live.start()
        return self

    def __exit__(self, *_) -> None:
        if not self._live.disable:
            self._live.stop()

    def update(self, job: str, share: float, seconds_left: float | None = None) -> None:
        """`share` of the job done, in [0, 1]; `seconds_left` where known. A job done leaves the live lines."""
        if share >= 1:
            return self._finish(job)
        self._show(job, share, _left(seconds_left))
        quarter = int(4 * share)
        if self._live.disable and quarter > self._quarters.get(job, 0):
            self._quarters[job] = quarter
            self.say(f"{job}: {25 * quarter} % {_left(seconds_left)}".rstrip())

    def count(self, runs: RunsProgress) -> None:
        """All the runs of a workflow: done, running, failed and the time left; on a terminal also those that run."""
        counted = f"{runs.done} of {runs.runs} runs done, {len(runs.running)} running, {runs.failed} failed"
        over = runs.done + runs.failed == runs.runs
        if self._live.disable:
            return self._tell(", ".join(filter(None, [counted, _left(runs.seconds_left)])), over)
        shown = {
            name.rpartition("-")[0]: share for name, share in list(runs.running.items())[:LIVE_RUNS]
        }
        for job in self._tasks.keys() - shown.keys() - {"runs"}:
            self._live.remove_task(self._tasks.pop(job))
        share = (runs.done + runs.failed + sum(runs.running.values())) / runs.runs
        self._show("runs", share, f"{counted}, {_left(runs.seconds_left)}".rstrip(", "))
        for job, share in shown.items():
            self._show(job, share, "")

    def _tell(self, line: str, at_once: bool) -> None:
        if line != self._last_told and (at_once or time.monotonic() - self._told >= PLAIN_S):
            self._told, self._last_told = time.monotonic(), line
            self.say(line)

    def _show(self, job: str, share: float, text: str) -> None:
        if job not in self._tasks:
            self._tasks[job] = self._live.add_task(job, total=1.0, left="")
        self._live.update(self._tasks[job], completed=share, left=text)

    def _finish(self, job: str) -> None:
        if job in self._tasks:
            self._live.remove_task(self._tasks.pop(job))
        if job not in self._finished:
            self._finished.add(job)
            self.say(f"{job}: done")

    def say(self, text: str) -> None:
        self._live.console.print(text, markup=False, highlight=False, soft_wrap=True)


def _left(seconds: float | None) -> str:
    return "" if seconds is None else f"{timedelta(seconds=round(seconds))} left"
