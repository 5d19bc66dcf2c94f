"""Processes by what /proc says of them: the daemons of a cluster, and what its jobs have started."""

import os
import signal
from pathlib import Path


def started(process: int) -> str | None:
    """When it began, which tells it from a later one of the same id; None where it is no more."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return None
    return None if state[0] == "Z" else state[19]


def send(processes: set[int], *numbers: signal.Signals) -> None:
    """Each signal to all of them, before the next."""
    for number in numbers:
        for process in processes:
            try:
                os.kill(process, number)
            except ProcessLookupError:
                pass


def of_jobs(configuration: Path, node: str | None = None) -> set[int]:
    """All that jobs have started on a node, or on any, and the slurmstepd that watch over them."""
    folder = configuration.parent
    logs = {str(log) for log in folder.glob(f"{node or 'node*'}.log")}
    found = set()
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if _is_in_job(process, configuration, node) or _is_step_daemon(process, logs):
                found.add(int(process.name))
        except OSError:
            continue  # it has ended, or is another user's
    return found


def _is_in_job(process: Path, configuration: Path, node: str | None) -> bool:
    text = (process / "environ").read_text(errors="replace")
    environment = dict(entry.split("=", 1) for entry in text.split("\0") if "=" in entry)
    its_node = environment.get("SLURMD_NODENAME")
    ours = environment.get("SLURM_CONF") == str(configuration)
    return ours and its_node is not None and node in (None, its_node)


def _is_step_daemon(process: Path, logs: set[str]) -> bool:
    """Whether it is a slurmstepd that writes to one of these logs; it has wiped its environment."""
    if (process / "comm").read_text() != "slurmstepd\n":
        return False
    return any(str(link.readlink()) in logs for link in (process / "fd").iterdir())
