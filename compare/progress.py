"""A live line per run on a terminal: how far, and how long still. Elsewhere a plain line per quarter of a run."""

from datetime import timedelta

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn


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
        if job not in self._tasks:
            self._tasks[job] = self._live.add_task(job, total=1.0, left="")
        left = "" if seconds_left is None else f"{timedelta(seconds=round(seconds_left))} left"
        self._live.update(self._tasks[job], completed=share, left=left)
        quarter = int(4 * share)
        if self._live.disable and quarter > self._quarters.get(job, 0):
            self._quarters[job] = quarter
            self.say(f"{job}: {25 * quarter} % {left}".rstrip())

    def _finish(self, job: str) -> None:
        if job in self._tasks:
            self._live.remove_task(self._tasks.pop(job))
        if job not in self._finished:
            self._finished.add(job)
            self.say(f"{job}: done")

    def say(self, text: str) -> None:
        self._live.console.print(text, markup=False, highlight=False, soft_wrap=True)
