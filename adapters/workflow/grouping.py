"""Short runs share a task: a task costs a second to start here, and on a cluster the wait for the next poll."""

from __future__ import annotations

import heapq
from collections.abc import Sequence

from .plan import Group, PlannedRun

TASK_S = 30.0  # CPU time from which on a run is a task of its own


def grouped(runs: Sequence[PlannedRun], jobs: int) -> list[Group]:
    """Tasks of about TASK_S each, the longest first; but no fewer than `jobs`, that no core idles."""
    ordered = sorted(runs, key=lambda run: -run.expected_s)
    groups = [Group((run,)) for run in ordered if run.expected_s >= TASK_S]
    short = [run for run in ordered if run.expected_s < TASK_S]
    for ranks in sorted({run.request.ranks for run in short}):
        groups += _shared([run for run in short if run.request.ranks == ranks], jobs)
    return sorted(groups, key=lambda group: -group.expected_s)


def _shared(runs: list[PlannedRun], jobs: int) -> list[Group]:
    """Longest first, each to the task that has least to do so far; as many tasks for each core, that they end together."""
    rounds = max(1, round(sum(run.expected_s for run in runs) / TASK_S / jobs))
    tasks = [(0.0, number, []) for number in range(min(len(runs), rounds * jobs))]
    for run in runs:
        load_s, number, members = heapq.heappop(tasks)
        members.append(run)
        heapq.heappush(tasks, (load_s + run.expected_s, number, members))
    return [Group(tuple(members)) for _, _, members in tasks]
