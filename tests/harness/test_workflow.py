"""Ensembles through Snakemake: what is tried again, what goes on, what a kill leaves, and what a second call makes of it."""

import importlib.metadata
import json
import os
import signal
import subprocess
import sys
import time
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console
from small_case import small_case

from crossdem.adapters.attempt import WORK, Attempt, clear_away, machine
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.engines import get_engine
from crossdem.adapters.one_run import Limits, Run
from crossdem.adapters.packing import make_packing, make_twin
from crossdem.adapters.run import RunRequest, look_up
from crossdem.adapters.solver import BEYOND_REASON
from crossdem.adapters.workflow.ensemble import run_ensemble
from crossdem.adapters.workflow.snakemake import WorkflowError
from crossdem.adapters.workflow.plan import PlannedRun
from crossdem.adapters.workflow.watch import Progress, Watch
from crossdem.compare.progress import ProgressDisplay


@pytest.fixture(scope="module")
def packings(case, tmp_path_factory):
    folder = tmp_path_factory.mktemp("beds")
    first = make_packing(case, 1, folder / "seed1")
    return [first, make_twin(first, 1, folder / "seed1-twin1"), make_twin(first, 2, folder / "t2")]


@pytest.fixture
def out(tmp_path):
    """A folder that no shell could be handed as it is."""
    return tmp_path / """an "out" 'folder' of $(touch x); {curly} *"""


def ensemble(case, packings, engines, out, **options):
    requests = [RunRequest(case, packing, engine) for engine in engines for packing in packings]
    return run_ensemble([(request, out) for request in requests], out / "workflow", 2, **options)


def journal(out):
    """The lines of each attempt."""
    files = sorted((out / "workflow" / "journal").glob("*.jsonl"))
    texts = [text for file in files if (text := file.read_text())]  # one may be about to be written
    return [[json.loads(line) for line in text.splitlines()] for text in texts]


def endings(out):
    """By name of the run how its attempts ended; None: they were not let."""
    found = {}
    for lines in journal(out):
        found.setdefault(lines[0]["run"], []).append(lines[-1].get("how"))
    return found


def calls(out):
    return sorted(path.name for path in (out / "workflow").glob("call-*"))


def names_in(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_run_that_has_just_begun_does_not_say_when_all_are_done(
    case, packings, tmp_path, monkeypatch
):
    names = ("native-seed1-000000000000", "native-seed2-000000000000")
    request = RunRequest(case, packings[0], "native")
    watch = Watch([PlannedRun(request, tmp_path, name, name, 10.0) for name in names], tmp_path)
    done = tmp_path / "runs" / names[0]
    works = tmp_path / "runs" / f".{names[1]}@machine-1-1-00000000.{WORK}"
    samples = works / get_engine("native").samples_file
    samples.parent.mkdir(parents=True)
    now = time.monotonic()
    monkeypatch.setattr(time, "monotonic", lambda: now)
    watch.look()
    done.mkdir()
    samples.write_text("a header\n")
    now += 10.0
    assert watch.look().seconds_left == pytest.approx(10.0, rel=0.2)


def test_every_run_becomes_a_dataset_and_is_run_into_once(case, packings, out):
    told = []
    results = ensemble(case, packings, ["native"], out, on_progress=told.append)
    assert [result.status for result in results] == ["done"] * 3
    assert [Dataset.read(result.dataset_folder).twin for result in results] == [0, 1, 2]
    assert names_in(out / "runs") == sorted(result.dataset_folder.name for result in results)
    assert endings(out) == {result.dataset_folder.name: ["published"] for result in results}
    folders = [lines[0]["folder"] for lines in journal(out)]
    assert len(set(folders)) == 3
    assert (told[0].runs, told[0].done) == (3, 0)
    assert (told[-1].done, told[-1].running, told[-1].failed) == (3, {}, 0)
    assert not Path("x").exists() and not (out / "workflow" / calls(out)[0] / "x").exists()


def test_a_second_call_takes_what_is_there_and_does_not_start_snakemake(case, packings, out):
    first = ensemble(case, packings[:1], ["native"], out)
    before = calls(out)
    again = ensemble(case, packings[:1], ["native"], out)
    assert [result.status for result in again] == ["reused"]
    assert again[0].dataset_folder == first[0].dataset_folder
    assert calls(out) == before and len(journal(out)) == 1


def test_a_run_that_fails_once_is_tried_again(fake, case, packings, out):
    fake.fault("crash once")
    [result] = ensemble(case, packings[:1], ["liggghts"], out)
    assert result.status == "done", result.failure
    [how] = endings(out).values()
    assert sorted(how) == ["failed", "published"]
    assert len(fake.process_ids()) == 2
    assert not any((out / "failed").iterdir())


def test_a_run_that_fails_twice_is_a_failure_and_the_others_go_on(fake, case, packings, out):
    fake.fault("crash")
    told = []
    failed, done = ensemble(
        case, packings[:1], ["liggghts", "native"], out, on_progress=told.append
    )
    assert (failed.status, done.status) == ("failed", "done")
    assert failed.exit_status == 1
    assert "liggghts ended with status 1" in failed.failure and "Lost atoms" in failed.failure
    assert Path(failed.failure.split("; see ")[1]).exists()
    assert len(fake.process_ids()) == 2
    assert names_in(out / "runs") == [done.dataset_folder.name]
    assert (told[-1].done, told[-1].failed) == (1, 1)


def test_what_a_status_means_to_the_native_solver_it_means_to_no_other(
    fake, case, packings, out, monkeypatch
):
    monkeypatch.setenv("FAKE_STATUS", str(BEYOND_REASON))
    fake.fault("crash once")
    [result] = ensemble(case, packings[:1], ["liggghts"], out)
    assert result.status == "done", result.failure


def test_a_motion_beyond_reason_is_not_tried_again(packings, out):
    wild = small_case("time.rest_s=0.02", "contact.particle_particle.normal_damping_N_s_m=1e3")
    [result] = ensemble(wild, packings[:1], ["native"], out)
    assert result.exit_status == BEYOND_REASON, result.failure
    assert [len(how) for how in endings(out).values()] == [1]


@pytest.mark.parametrize("looks, status", [(5, "done"), (10**6, "failed")])
def test_a_finished_run_may_be_seen_here_later(case, packings, out, monkeypatch, looks, status):
    """As on a file system that caches."""
    seen, finished = [], Run.finished

    def late(run):
        seen.append(run)
        return finished(run) if len(seen) > looks else None

    monkeypatch.setattr(Run, "finished", late)
    monkeypatch.setattr("crossdem.adapters.workflow.ensemble.LATENCY_S", 60 if looks == 5 else 0.3)
    [result] = ensemble(case, packings[:1], ["native"], out)
    assert result.status == status, result.failure
    if status == "failed":
        assert "native was finished by its task, but" in result.failure
        assert "repeat the command" in result.failure


def test_what_needs_no_process_is_answered_without_snakemake(packings, out, case, monkeypatch):
    monkeypatch.setenv("PATH", str(out))
    [missing] = ensemble(case, packings[:1], ["liggghts"], out)
    assert missing.status == "missing" and "apt install liggghts" in missing.failure
    assert calls(out) == []


def test_the_contacts_of_the_others_are_held_against_the_native_run(fake, case, packings, out):
    [alone] = ensemble(case, packings[:1], ["liggghts"], out)
    assert len(Dataset.read(alone.dataset_folder).manifest["gates"]) == 2
    results = ensemble(case, packings[:1], ["liggghts", "native"], out)
    assert [result.status for result in results] == ["reused", "done"]
    native = Dataset.read(results[1].dataset_folder)
    gates = Dataset.read(alone.dataset_folder).manifest["gates"]
    at_rest = native.resistance["contacts"].iloc[0]
    [gate] = [gate for gate in gates if gate["name"] == "contacts_share"]
    assert gate["value"] == pytest.approx(abs(70 - at_rest) / at_rest)
    assert f"{at_rest} in the native run" in gate["message"]
    [again] = ensemble(case, packings[:1], ["liggghts"], out)
    assert Dataset.read(again.dataset_folder).manifest["gates"] == gates and len(gates) == 3
    assert len(fake.process_ids()) == 1


def test_without_snakemake_it_says_how_to_get_it(packings, out, case, monkeypatch):
    def missing(name):
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr("importlib.metadata.version", missing)
    with pytest.raises(WorkflowError, match="apt install snakemake"):
        ensemble(case, packings[:1], ["native"], out)


def test_a_profile_of_the_user_changes_nothing_here(case, packings, out, monkeypatch):
    monkeypatch.setenv("SNAKEMAKE_PROFILE", "mine")
    [result] = ensemble(case, packings[:1], ["native"], out)
    assert result.status == "done", result.failure


def test_a_folder_that_snakemake_cannot_hand_to_a_cluster_is_refused(case, packings, out):
    with pytest.raises(WorkflowError, match="with --profile.*choose another with --out"):
        ensemble(case, packings[:1], ["native"], out, profile="slurm")


FRONT = """
from pathlib import Path
from crossdem.adapters.case import Case
from crossdem.adapters.packing import Packing
from crossdem.adapters.run import RunRequest
from crossdem.adapters.workflow.ensemble import run_ensemble
case, packing, out = Case.from_canonical({canonical!r}), Packing.read(Path({packing!r})), Path({out!r})
requests = [RunRequest(case, packing, name) for name in ("native", "liggghts")]
for result in run_ensemble([(request, out) for request in requests], out / "workflow", 2):
    print(result.status, result.failure, flush=True)
"""


@pytest.mark.parametrize("killed", ["front", "scheduler", "both"])
def test_after_a_kill_the_same_call_goes_on_where_it_was(fake, case, packings, out, killed):
    fake.fault("hang")
    text = FRONT.format(canonical=case.canonical, packing=str(packings[0].folder), out=str(out))
    front = subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, text=True)
    wait_for(lambda: fake.process_ids() and ["published"] in endings(out).values())
    [scheduler] = children(front.pid, "workflow.scheduler")
    victims = {"front": [front.pid], "scheduler": [scheduler], "both": [front.pid, scheduler]}
    for victim in victims[killed]:
        os.kill(victim, signal.SIGKILL)
    said, _ = front.communicate(timeout=30)
    if killed == "scheduler":
        assert "was ended by signal 9 (SIGKILL)" in said and "done None" in said
    wait_for(lambda: not alive(fake.process_ids()[0]), "the engine goes on")

    fake.fault("none")
    native, other = ensemble(case, packings[:1], ["native", "liggghts"], out)
    assert (native.status, other.status) == ("reused", "done"), other.failure
    assert len(fake.process_ids()) == 2
    assert names_in(out / "runs") == sorted([native.dataset_folder.name, other.dataset_folder.name])
    how = endings(out)
    assert how[native.dataset_folder.name] == ["published"]
    assert how[other.dataset_folder.name].count("published") == 1


def test_ctrl_c_ends_everything_and_leaves_no_run(fake, case, packings, out):
    fake.fault("hang")
    text = FRONT.format(canonical=case.canonical, packing=str(packings[0].folder), out=str(out))
    front = subprocess.Popen([sys.executable, "-c", text], stderr=subprocess.PIPE)
    wait_for(lambda: fake.process_ids() and ["published"] in endings(out).values())
    [scheduler] = children(front.pid, "workflow.scheduler")
    front.send_signal(signal.SIGINT)
    _, said = front.communicate(timeout=30)
    assert b"KeyboardInterrupt" in said
    assert not alive(scheduler) and not alive(fake.process_ids()[0])
    assert [name.split("-")[0] for name in names_in(out / "runs")] == ["native"]
    assert sorted(how for [how] in endings(out).values()) == ["published", "stopped"]


def test_of_two_attempts_at_once_the_first_is_kept(case, packings, tmp_path):
    request = RunRequest(case, packings[0], "native")
    runs = [look_up(request, tmp_path, tmp_path / "journal")[0] for _ in range(2)]
    (tmp_path / "runs").mkdir()
    for run in runs:
        run.start()
    assert runs[0].work_dir != runs[1].work_dir
    for run in runs:
        wait_for(lambda: run.poll(Limits()))
    runs[1].keep(runs[1].read())
    first = (runs[1].folder / "motion.h5").stat()
    runs[0].keep(runs[0].read())
    assert (runs[0].folder / "motion.h5").stat().st_ino == first.st_ino
    assert names_in(tmp_path / "runs") == [runs[0].name]
    how = [
        json.loads(file.read_text().splitlines()[-1])["how"]
        for file in (tmp_path / "journal").iterdir()
    ]
    assert sorted(how) == ["published", "was there"]


def test_a_broken_dataset_makes_room(case, packings, tmp_path):
    request = RunRequest(case, packings[0], "native")
    run, _ = look_up(request, tmp_path)
    run.folder.mkdir(parents=True)
    (run.folder / "motion.h5").write_text("torn")
    run.start()
    wait_for(lambda: run.poll(Limits()))
    run.keep(run.read())
    assert run.finished() and names_in(tmp_path / "runs") == [run.name]


def test_only_what_nobody_works_in_any_more_is_cleared_away(tmp_path):
    ours = Attempt("native-seed1-0", tmp_path).work_dir
    ended = subprocess.Popen(["true"])
    ended.wait()
    dead = tmp_path / f".native-seed1-0@{machine()}-{ended.pid}-1-00000000.work"
    reborn = tmp_path / f".native-seed1-0@{machine()}-{os.getpid()}-1-00000000.work"
    unread = subprocess.Popen(["true"])  # ended, but its parent has not asked how
    wait_for(lambda: not alive(unread.pid))
    born = Path(f"/proc/{unread.pid}/stat").read_text().rpartition(")")[2].split()[19]
    zombie = tmp_path / f".native-seed1-0@{machine()}-{unread.pid}-{born}-00000000.work"
    elsewhere = tmp_path / ".native-seed1-0@other-000000-1-1-00000000.work"
    forgotten = tmp_path / ".native-seed1-0@other-000000-1-1-00000001.work"
    for folder in (ours, dead, reborn, zombie, elsewhere, forgotten, tmp_path / "native-seed1-0"):
        folder.mkdir()
    os.utime(forgotten, (0, 0))
    clear_away(tmp_path)
    unread.wait()
    assert names_in(tmp_path) == sorted([ours.name, elsewhere.name, "native-seed1-0"])


@pytest.mark.parametrize("is_terminal", [True, False])
def test_the_progress_says_done_running_failed_and_the_time_left(is_terminal):
    said = StringIO()
    console = Console(
        file=said, force_terminal=is_terminal, force_interactive=is_terminal, width=150
    )
    with ProgressDisplay(console) as display:
        display.count(Progress(4, 1, 1, {"yade-seed2-twin1-0123456789ab": 0.5}, 75.0))
        display._live.refresh()
        display.count(Progress(4, 3, 1, {}, 0.0))
    if is_terminal:
        assert "1 of 4 runs done, 1 running, 1 failed, 0:01:15 left" in said.getvalue()
        assert "yade-seed2-twin1 " in said.getvalue()
    else:
        assert said.getvalue() == "3 of 4 runs done, 0 running, 1 failed, 0:00:00 left\n"


def children(parent, word):
    """Ids of the parent's processes whose command has the word in it."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            stat = (entry / "stat").read_text().rpartition(")")[2].split()
            if int(stat[1]) == parent and word in (entry / "cmdline").read_text():
                found.append(int(entry.name))
        except OSError:
            continue
    return found


def alive(process):
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def wait_for(condition, otherwise="it did not come about", seconds=60):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, otherwise
        time.sleep(0.02)
