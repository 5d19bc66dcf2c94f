"""How runs share tasks: short ones do, long ones do not, and no core idles."""

from pathlib import Path

import pytest

from crossdem.adapters.run_folder import RunRequest
from crossdem.adapters.workflow.grouping import TASK_S, grouped
from crossdem.adapters.workflow.plan import PlannedRun


def planned(*expected_s, ranks=1):
    return [
        PlannedRun(RunRequest(None, None, "native", ranks), Path("out"), f"{n}", f"{ranks} {n}", s)
        for n, s in enumerate(expected_s)
    ]


def sizes(groups):
    return [len(group.runs) for group in groups]


def test_a_long_run_is_a_task_of_its_own_and_the_longest_comes_first():
    groups = grouped(planned(70.0, 200.0, 90.0), jobs=2)
    assert [group.expected_s for group in groups] == [200.0, 90.0, 70.0]


def test_short_runs_share_tasks_of_about_half_a_minute():
    groups = grouped(planned(*[3.0] * 40), jobs=2)
    assert sizes(groups) == [10] * 4
    assert all(group.expected_s == pytest.approx(TASK_S) for group in groups)


@pytest.mark.parametrize("jobs, tasks", [(1, 1), (2, 2), (4, 4), (8, 5)])
def test_no_core_idles_while_another_works_off_short_runs(jobs, tasks):
    assert len(grouped(planned(*[1.0] * 5), jobs)) == tasks


@pytest.mark.parametrize("jobs, each", [(2, [4] * 8), (4, [4] * 8), (16, [2] * 16)])
def test_every_core_has_as_many_tasks_of_short_runs_as_any_other(jobs, each):
    assert sizes(grouped(planned(*[6.8] * 32), jobs)) == each


def test_short_runs_are_shared_evenly():
    groups = grouped(planned(9.0, 8.0, 2.0, 1.0), jobs=2)
    assert [group.expected_s for group in groups] == [10.0, 10.0]


def test_a_task_has_as_many_threads_as_its_runs_have_ranks():
    groups = grouped(planned(1.0, 1.0) + planned(1.0, 1.0, ranks=2), jobs=1)
    assert [(group.threads, len(group.runs)) for group in groups] == [(1, 2), (2, 2)]


def test_the_time_limit_of_a_task_is_above_those_of_its_runs_together():
    [short] = grouped(planned(*[2.0] * 15), jobs=1)
    assert 15 * 300 < short.limit_s < 15 * 400
    [long] = grouped(planned(100.0), jobs=1)
    assert 2000 < long.limit_s < 2100


def test_every_run_is_in_one_task_whose_name_is_its_own():
    runs = planned(*range(1, 100))
    groups = grouped(runs, jobs=3)
    assert sorted(int(run.name) for group in groups for run in group.runs) == list(range(99))
    assert len({group.name for group in groups}) == len(groups)
