"""LIGGGHTS with several MPI processes: the same dataset as with one, no port that others could reach, and no leftovers.

The deck cuts the bed into layers, one per rank. LIGGGHTS adds up forces in the order in which it keeps discs and
contacts, and another cut may turn that order round. With two ranks it does not: their dataset is that of one rank to
the last bit, which is what is asked here. With four on the bed of 944 discs it does, by rounding, which a bed then
doubles every few hundredths of a second: `crossdem horizon` says up to when such runs can be compared disc by disc.
"""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from command_line import REFERENCE, crossdem
from small_case import SMALL, small_case
from test_no_ports import listening_sockets, sockets_of_session
from test_workflow import alive, wait_for

from crossdem.adapters import run_folder
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.engines import get_engine
from crossdem.adapters.packing import make_packing
from crossdem.adapters.process import Process

RANKS = 2
SHORT = (*SMALL, "time.rest_s=0.05", "time.penetration_s=0.1")


@pytest.fixture(scope="module")
def pair(tmp_path_factory, required):
    """The dataset of one rank and that of two, on the same packing, through the workflow."""
    required("liggghts")
    out = tmp_path_factory.mktemp("mpi") / "out"
    overrides = [word for override in SHORT for word in ("--set", override)]
    command = ["run", REFERENCE, *overrides, "--engines", "native,liggghts", "--seeds", "1"]
    found = {}
    for ranks in (1, RANKS):
        ended = crossdem(*command, "--out", out, "--mpi-ranks", str(ranks))
        assert ended.returncode == 0, ended.stderr
        *_, folder = [Path(line) for line in ended.stdout.splitlines() if "/runs/lig" in line]
        found[ranks] = folder
    assert len(list((out / "runs").glob("native-*"))) == 1  # it takes one, whatever is offered
    return found[1], found[RANKS]


def test_two_ranks_give_the_same_bits_as_one(pair):
    one, two = map(Dataset.read, pair)
    assert pair[0] != pair[1]
    pd.testing.assert_frame_equal(one.resistance, two.resistance, check_exact=True)
    for name in ("time_s", "position_m", "velocity_m_s", "angular_velocity_rad_s"):
        assert np.array_equal(getattr(one.motion, name), getattr(two.motion, name)), name
    assert np.ptp(one.resistance["contacts"]) > 0  # something happened


def test_the_command_of_a_run_of_several_ranks_is_told(pair):
    manifest = Dataset.read(pair[1]).manifest
    assert manifest["command"][manifest["command"].index("-n") + 1] == str(RANKS)
    assert "mpirun --oversubscribe -n 2 stdbuf" in (pair[1] / "README.txt").read_text()
    assert "mpirun" not in Dataset.read(pair[0]).manifest["command"]


def test_the_command_can_be_run_by_hand(pair, tmp_path):
    _, line, _ = (pair[1] / "README.txt").read_text().split("\n\n")[1:4]
    subprocess.run(["cp", "-r", pair[1] / "inputs", tmp_path], check=True)
    subprocess.run(["sh", "-c", line.strip()], cwd=tmp_path, check=True, capture_output=True)
    kept = Dataset.read(pair[1]).resistance["force_y_N"].to_numpy()
    again = np.loadtxt(tmp_path / "output" / "samples.txt")[:, 2]
    assert np.array_equal(again[-len(kept) :], kept)


@pytest.fixture
def started(tmp_path, required):
    """The command, its folder and its settings, for a run of several ranks that goes on for long."""
    required("liggghts")
    case, engine, folder = (
        small_case("time.penetration_s=1.0"),
        get_engine("liggghts"),
        tmp_path / "run",
    )
    packing = make_packing(case, 1, tmp_path / "packing")
    run_folder.prepare(case, packing, engine, folder, RANKS)
    command = run_folder.command(case, engine, folder, RANKS)
    return command, folder, run_folder.environment(engine, RANKS)


def test_ranks_listen_in_a_network_of_their_own_only(started, tmp_path):
    command, folder, environment = started
    process = Process(command, folder, environment, tmp_path / "log")
    samples = folder / "output" / "samples.txt"
    seen, networks = set(), set()
    try:
        wait_for(lambda: samples.exists() and samples.stat().st_size > 0)
        seen = sockets_of_session(process.id) & listening_sockets()
        networks = {os.readlink(f"/proc/{process.id}/ns/net")}
    finally:
        process.kill()
    assert seen == set()
    assert networks != {os.readlink("/proc/self/ns/net")}


def test_nothing_of_the_ranks_outlives_the_process_that_started_them(started, tmp_path):
    command, folder, environment = started
    text = f"""
import time
from pathlib import Path
from crossdem.adapters.process import Process
process = Process({command!r}, Path({str(folder)!r}), {environment!r}, Path({str(tmp_path / 'log')!r}))
print(process.id, flush=True)
time.sleep(600)
"""
    caller = subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, text=True)
    mpirun = int(caller.stdout.readline())
    wait_for(lambda: len(ranks_of(mpirun)) == RANKS)
    ranks = ranks_of(mpirun)
    memory = Path(f"/proc/{mpirun}/root/dev/shm")
    wait_for(
        lambda: len(list(memory.glob("vader_segment.*"))) == RANKS and any(memory.glob("ompi.*"))
    )
    assert memory.stat().st_dev != Path("/dev/shm").stat().st_dev, "what is left there stays there"
    os.kill(caller.pid, signal.SIGKILL)
    caller.wait()
    wait_for(lambda: not any(map(alive, [mpirun, *ranks])), "some go on")


def ranks_of(mpirun):
    try:
        return [
            int(word) for word in Path(f"/proc/{mpirun}/task/{mpirun}/children").read_text().split()
        ]
    except OSError:
        return []
