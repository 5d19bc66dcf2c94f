"""How far the runs of a workflow are, by what lies in their folders: so it is the same on a cluster."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..attempt import work_folders
from ..engines import get_engine
from ..process import LineCounter
from .plan import STATUS, PlannedRun

EARLY = 0.2  # share of a run's samples before which its own pace says little: it begins with a rest that has none


@dataclass(frozen=True)
class Progress:
    """Of all the runs of a call."""

    runs: int
    done: int
    failed: int  # so far: a task is tried twice
    running: dict[str, float]  # by name of the run: share of its samples written [0, 1]
    seconds_left: float | None  # where known


class Watch:
    def __init__(self, runs: Sequence[PlannedRun], call: Path):
        self._runs = {run.name: run for run in runs}
        self._call = call
        self._done: set[str] = set()
        self._seen: dict[Path, tuple[float, LineCounter]] = {}  # work folder: since when
        self._started = time.monotonic()

    def look(self) -> Progress:
        for name, run in self._runs.items():
            if name not in self._done and (run.out_dir / "runs" / name).exists():
                self._done.add(name)
        working = {}
        for out_dir in {run.out_dir for run in self._runs.values()}:
            working |= work_folders(out_dir / "runs")
        working = {name: folder for name, folder in working.items() if self._is_awaited(name)}
        shares = {name: self._share(name, folder) for name, folder in working.items()}
        failed = {
            run
            for run, outcome in outcomes(self._call, self._runs.values()).items()
            if outcome["failure"] and run not in self._done and run not in shares
        }
        left_s = self._seconds_left(shares, working, failed)
        return Progress(len(self._runs), len(self._done), len(failed), shares, left_s)

    def _is_awaited(self, name: str) -> bool:
        return name in self._runs and name not in self._done

    def _share(self, name: str, folder: Path) -> float:
        request = self._runs[name].request
        engine = get_engine(request.engine_name)
        if folder not in self._seen:
            self._seen[folder] = time.monotonic(), LineCounter(folder / engine.samples_file)
        lines = self._seen[folder][1].update()
        return min(1.0, lines / engine.lines_in_all(request.case))

    def _seconds_left(
        self, shares: dict[str, float], working: dict[str, Path], failed: set[str]
    ) -> float | None:
        """As fast as so far; and no sooner than the slowest of those that run."""
        expected = {name: run.expected_s for name, run in self._runs.items() if name not in failed}
        done_s = sum(expected[name] for name in self._done)
        done_s += sum(share * expected[name] for name, share in shares.items())
        if done_s == 0:
            return None
        now = time.monotonic()
        even = (sum(expected.values()) - done_s) * (now - self._started) / done_s
        last = [
            (now - self._seen[working[name]][0]) * (1 - share) / share
            for name, share in shares.items()
            if share > EARLY
        ]
        return max([even, *last])


def outcomes(call: Path, runs: Sequence[PlannedRun]) -> dict[str, dict]:
    """What tasks said of their runs, by the runs' names: status, failure, exit_status."""
    names = {run.key: run.name for run in runs}
    found = {}
    for path in (call / STATUS).glob("[!.]*.json"):
        said = json.loads(path.read_text(encoding="utf-8"))
        found |= {names[key]: outcome for key, outcome in said.items() if key in names}
    return found
