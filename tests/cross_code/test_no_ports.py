"""That no engine listens on the network, nor starts something that does."""

import time
from pathlib import Path

import pytest
from small_case import small_case

from crossdem.adapters.packing import make_packing
from crossdem.adapters.process import Process
from crossdem.adapters.run_folder import prepare

LISTENING = "0A"


@pytest.fixture(scope="module")
def case():
    return small_case("time.penetration_s=1.0")


def listening_sockets():
    """Inodes of every listening TCP socket."""
    rows = [
        line.split()
        for table in ("tcp", "tcp6")
        if Path(f"/proc/net/{table}").exists()
        for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]
    ]
    return {row[9] for row in rows if row[3] == LISTENING}


def sockets_of_session(session):
    """Inodes of the sockets of every process in a session."""
    found = set()
    for process in Path("/proc").glob("[0-9]*"):
        try:
            state = (process / "stat").read_text().rpartition(")")[2].split()
            if int(state[3]) == session:
                links = [str(link.readlink()) for link in (process / "fd").iterdir()]
                found |= {link[8:-1] for link in links if link.startswith("socket:[")}
        except OSError:
            continue  # it has ended
    return found


def test_an_engine_listens_on_no_port(engine, case, tmp_path):
    packing = make_packing(case, 1, tmp_path / "packing")
    prepare(case, packing, engine, tmp_path / "run")
    command = engine.command(case, tmp_path / "run")
    command[command.index(engine.program)] = engine.executable()
    process = Process(command, tmp_path / "run", engine.environment(), tmp_path / "log")
    samples = tmp_path / "run" / engine.samples_file
    seen = set()
    try:
        while process.poll() is None and not (samples.exists() and samples.stat().st_size > 2000):
            seen |= sockets_of_session(process.id) & listening_sockets()
            time.sleep(0.02)
    finally:
        process.kill()
    assert samples.exists(), "the engine did not run"
    assert seen == set()
