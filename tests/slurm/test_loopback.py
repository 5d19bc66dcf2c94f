"""The cluster of these tests: alone on this machine, unseen from outside, and gone without a trace."""

from pathlib import Path

import loopback
import pytest
from loopback import Loopback, LoopbackError
from test_workflow import wait_for

LISTENING = "0A"
LOOPBACK = "0100007F"  # 127.0.0.1 as the kernel prints it


def listening(processes):
    """Addresses on which they listen, in hexadecimal."""
    sockets = set()
    for process in processes:
        links = (str(link.readlink()) for link in Path(f"/proc/{process}/fd").iterdir())
        sockets |= {link[8:-1] for link in links if link.startswith("socket:[")}
    rows = []
    for table in Path("/proc/net").glob("tcp*"):
        rows += [line.split() for line in table.read_text().splitlines()[1:]]
    return {row[1].split(":")[0] for row in rows if row[3] == LISTENING and row[9] in sockets}


def test_two_clusters_stand_side_by_side_and_leave_no_process(cluster_folder):
    with Loopback(cluster_folder / "a") as one, Loopback(cluster_folder / "b") as other:
        daemons = [*one.daemons().values(), *other.daemons().values()]
        assert len(set(daemons)) == 8
        assert listening(daemons) == {LOOPBACK}
        job = one.call("sbatch", "--wrap", "sleep 600", "--output", "/dev/null")
        assert job.returncode == 0, job.stderr
        wait_for(one.job_processes)
        assert one.nodes() and not other.job_processes()
    assert not one.daemons() and not one.job_processes() and not other.daemons()


def test_a_daemon_that_does_not_come_up_says_why(cluster_folder, monkeypatch):
    broken = cluster_folder / "broken.conf"
    broken.write_text(loopback.TEMPLATE.read_text() + "Nonsense=1\n")
    monkeypatch.setattr(loopback, "TEMPLATE", broken)
    cluster = Loopback(cluster_folder / "a")
    with pytest.raises(LoopbackError, match="slurmctld ended with status 1.*\n.*Nonsense"):
        cluster.start()
    assert not cluster.daemons()
