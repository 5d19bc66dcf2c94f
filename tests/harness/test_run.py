"""Running engines: what ends well, what ends badly and is said as what it is, and what a second call makes of it."""

import errno
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path

import pytest
from few_particles import Disc, few_particles
from small_case import small_case

from crossdem.adapters.dataset import Dataset
from crossdem.adapters.machine import machine_facts
from crossdem.adapters.one_run import Limits
from crossdem.adapters.packing import make_packing
from crossdem.adapters.process import Process, wait_for_any
from crossdem.adapters.run import RunRequest, run_all


def liggghts(case, packing, out_dir, **options):
    [result] = run_all([RunRequest(case, packing, "liggghts")], out_dir, 1, **options)
    return result


def names_in(folder):
    return sorted(path.name for path in folder.iterdir()) if folder.exists() else []


def test_a_whole_run_becomes_a_dataset_with_inputs_log_and_readme(fake, case, packing, tmp_path):
    result = liggghts(case, packing, tmp_path / "out")
    assert (result.status, result.failure) == ("done", None)
    assert names_in(result.dataset_folder) == [
        *("README.txt", "engine.log", "inputs", "manifest.json", "motion.h5", "resistance.csv")
    ]
    assert names_in(tmp_path / "out" / "runs") == [result.dataset_folder.name]
    run = Dataset.read(result.dataset_folder)
    assert run.manifest["run_key"].startswith(result.dataset_folder.name.split("-")[-1])
    assert run.manifest["engine_version"] == "LIGGGHTS-PUBLIC 3.8.0-fake"
    assert str(tmp_path) not in (result.dataset_folder / "manifest.json").read_text()
    assert run.manifest["command"][0] == "stdbuf"
    assert run.manifest["machine"] == machine_facts()


@pytest.mark.parametrize(
    "fault, message",
    [
        ("crash", "status 1 with the bar at a depth of .* cm: Lost atoms"),
        ("crash while resting", r"signal 6 \(SIGABRT\) while resting"),
        ("missing samples", "left 10 of 11 samples: disk full"),
        ("missing frames", "left 5 of 6 frames: disk full"),
        ("torn frame", "left 5 of 6 frames: disk full"),
        ("lost particle", "lost 1 particles"),
        ("outside", "lost 1 particles, found outside the container from 0.1 s on"),
        ("nan force", "not finite"),
        ("nan position", "not finite"),
    ],
)
def test_a_bad_end_is_said_as_what_it_is(fake, case, packing, tmp_path, fault, message):
    fake.fault(fault)
    result = liggghts(case, packing, tmp_path / "out")
    assert (result.status, result.dataset_folder) == ("failed", None)
    assert result.failure.startswith("liggghts ")
    assert re.search(message, result.failure), result.failure
    assert names_in(tmp_path / "out" / "runs") == []
    log = Path(result.failure.split("; see ")[1])
    assert log.exists() and log.parent.parent == tmp_path / "out" / "failed"


def test_a_hang_is_ended_when_nothing_new_comes(fake, case, packing, tmp_path):
    fake.fault("hang")
    limits = Limits(silent_s=1.0, silent_share=0.0)
    result = liggghts(case, packing, tmp_path / "out", limits=limits)
    assert result.status == "failed"
    assert "made no progress for 1 s with the bar at a depth of" in result.failure
    assert_ended(fake.process_ids())


def test_a_run_past_its_time_limit_is_ended_though_it_goes_on(fake, case, packing, tmp_path):
    fake.fault("slow")
    limits = Limits(least_s=1.0, factor=0.0)
    result = liggghts(case, packing, tmp_path / "out", limits=limits)
    assert "ran past its time limit of 1 s while resting" in result.failure
    assert_ended(fake.process_ids())


def test_a_missing_engine_says_what_to_install(case, packing, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    result = liggghts(case, packing, tmp_path / "out")
    assert result.status == "missing"
    assert "apt install liggghts" in result.failure


def test_a_program_that_cannot_say_its_version_is_a_missing_engine(case, packing, tmp_path, fake):
    program = Path(shutil.which("liggghts"))
    program.write_bytes(b"no program")  # executable, and of no format that the system knows
    result = liggghts(case, packing, tmp_path / "out")
    assert result.status == "missing"
    assert "does not say its version" in result.failure


def test_a_case_beyond_an_engine_is_not_run(fake, packing, tmp_path):
    result = liggghts(small_case('scheme.bar_corner="faces_only"'), packing, tmp_path / "out")
    assert result.status == "unsupported"
    assert "faces_only" in result.failure
    assert fake.process_ids() == []


def test_a_failure_without_a_bar_names_the_time(fake, tmp_path):
    fake.fault("crash")
    case = few_particles([Disc(0.01, 0.03)], tmp_path, "time.rest_s=0.001")
    result = liggghts(case, make_packing(case, 1, tmp_path / "packing"), tmp_path / "out")
    assert re.search("status 1 after 0 s: Lost atoms", result.failure), result.failure


def test_what_an_engine_repeats_in_every_step_is_not_kept(fake, case, packing, tmp_path):
    [result] = run_all([RunRequest(case, packing, "liggghts-averaged")], tmp_path / "out", 1)
    assert result.status == "done", result.failure
    assert (result.dataset_folder / "engine.log").read_text() == "LIGGGHTS says this once\n"


def test_a_failure_does_not_stop_the_others_and_results_keep_the_order(
    fake, case, packing, tmp_path
):
    fake.fault("crash")
    requests = [RunRequest(case, packing, name) for name in ("liggghts", "native")]
    failed, done = run_all(requests, tmp_path / "out", 2)
    assert [failed.request, done.request] == requests
    assert (failed.status, done.status) == ("failed", "done")


def test_a_finished_run_is_reused_and_not_started_again(fake, case, packing, tmp_path):
    first = liggghts(case, packing, tmp_path / "out")
    again = liggghts(case, packing, tmp_path / "out")
    assert (again.status, again.dataset_folder) == ("reused", first.dataset_folder)
    assert len(fake.process_ids()) == 1


def test_a_damaged_run_is_run_again(fake, case, packing, tmp_path):
    first = liggghts(case, packing, tmp_path / "out")
    (first.dataset_folder / "resistance.csv").write_text("time_s\n")
    again = liggghts(case, packing, tmp_path / "out")
    assert again.status == "done"
    Dataset.read(again.dataset_folder)


def test_another_case_or_another_engine_version_is_another_run(fake, case, packing, tmp_path):
    first = liggghts(case, packing, tmp_path / "out")
    wall = small_case("contact.particle_wall.friction=0.5")
    assert liggghts(wall, packing, tmp_path / "out").dataset_folder != first.dataset_folder
    assert len(names_in(tmp_path / "out" / "runs")) == 2


def test_a_failed_run_is_tried_again_and_its_remains_go_when_it_succeeds(
    fake, case, packing, tmp_path
):
    fake.fault("crash")
    liggghts(case, packing, tmp_path / "out")
    fake.fault("none")
    assert liggghts(case, packing, tmp_path / "out").status == "done"
    assert names_in(tmp_path / "out" / "failed") == []


def test_a_dataset_that_cannot_be_written_costs_nothing_of_what_the_engine_wrote(
    fake, case, packing, tmp_path, monkeypatch
):
    def full_disk(dataset, folder):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Dataset, "_write_files", full_disk)
    result = liggghts(case, packing, tmp_path / "out")
    assert result.status == "failed"
    assert "its dataset cannot be written" in result.failure and "No space left" in result.failure
    assert names_in(tmp_path / "out" / "runs") == []
    [remains] = (tmp_path / "out" / "failed").iterdir()
    assert names_in(remains / "output") == ["frames.txt", "samples.txt"]


def test_progress_grows_to_one(fake, case, packing, tmp_path):
    fake.fault("slow")
    told = []
    liggghts(case, packing, tmp_path / "out", on_progress=lambda *news: told.append(news))
    shares = [share for _, share, _ in told]
    assert shares == sorted(shares) and shares[-1] == 1.0
    assert any(0 < share < 1 and seconds_left > 0 for _, share, seconds_left in told)


def test_ctrl_c_ends_the_engines_and_leaves_no_run(fake, case, packing, tmp_path):
    fake.fault("hang")
    script = f"""
from pathlib import Path
from crossdem.adapters.case import Case
from crossdem.adapters.packing import Packing
from crossdem.adapters.run import RunRequest, run_all
case = Case.from_canonical({case.canonical!r})
packing = Packing.read(Path({str(packing.folder)!r}))
run_all([RunRequest(case, packing, "liggghts")], Path({str(tmp_path / 'out')!r}), 1)
"""
    caller = subprocess.Popen([sys.executable, "-c", script], stderr=subprocess.PIPE)
    deadline = time.monotonic() + 60
    while not fake.process_ids() and time.monotonic() < deadline:
        time.sleep(0.05)
    caller.send_signal(signal.SIGINT)
    _, error = caller.communicate(timeout=30)
    assert b"KeyboardInterrupt" in error
    assert_ended(fake.process_ids())
    assert names_in(tmp_path / "out" / "runs") == []


def assert_ended(process_ids):
    assert process_ids
    for process_id in process_ids:
        with pytest.raises(ProcessLookupError):
            os.kill(process_id, 0)


def test_the_end_of_a_process_is_noticed_beside_a_thousand_open_files(tmp_path):
    least = 1200
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, least), hard))
    with ExitStack() as files:
        files.callback(resource.setrlimit, resource.RLIMIT_NOFILE, (soft, hard))
        for _ in range(least - 100):
            files.enter_context(open(os.devnull, "rb"))
        process = Process(["sleep", "0.2"], tmp_path, {}, tmp_path / "log")
        begun = time.monotonic()
        wait_for_any([process], 60.0)
        assert time.monotonic() - begun < 30.0
        assert process.poll().status == 0
