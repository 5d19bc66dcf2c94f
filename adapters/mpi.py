"""Several MPI processes for one run: what is put before the engine's command, and Open MPI's settings.

mpirun listens on every network interface, whatever it is told. So it gets a network of its own, in which there is no
interface but loopback. What it leaves in shared memory and in its folder of sockets when it is killed, nobody would remove:
both lie in a file system of its own, which goes with its last process. The kernel's namespaces need no rights for either,
where they are not forbidden.
"""

from __future__ import annotations

import shutil
import subprocess
from functools import lru_cache

from .engine import EngineNotFound

ENGINES = ("liggghts", "liggghts-averaged")  # those that split a bed among ranks
SHARED_MEMORY = "/dev/shm"  # a path short enough for sockets, too
ALONE = [
    *("unshare", "--map-root-user", "--net", "--mount", "sh", "-c"),
    f'ip link set lo up && mount -t tmpfs tmpfs {SHARED_MEMORY} && exec "$@"',
]
SETTINGS = {
    "OMPI_MCA_btl": "self,vader",  # by shared memory
    "OMPI_MCA_btl_vader_backing_directory": SHARED_MEMORY,
    "OMPI_MCA_orte_tmpdir_base": SHARED_MEMORY,
    "OMPI_MCA_plm": "isolated",  # on this machine, also where Slurm or ssh would reach others
    "OMPI_MCA_ras": "^slurm",
    "OMPI_MCA_hwloc_base_binding_policy": "none",  # or two runs at a time share the first cores
    "OMPI_ALLOW_RUN_AS_ROOT": "1",  # as which it sees itself in a network of its own
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
}


def ranks_of(engine_name: str, ranks: int) -> int:
    """How many ranks a run of this engine takes when `ranks` are offered."""
    return ranks if engine_name in ENGINES else 1


def with_ranks(command: list[str], ranks: int) -> list[str]:
    """The command that starts `command` as so many MPI processes."""
    if ranks == 1:
        return command
    mpirun = ["mpirun", "--oversubscribe", "-n", str(ranks)]
    return [*ALONE, "mpirun", *mpirun, *command]  # once as the shell's own name


def settings(ranks: int) -> dict[str, str]:
    """Variables set for the process beside, or instead of, the engine's own."""
    return {} if ranks == 1 else SETTINGS


@lru_cache
def check(path: str | None) -> None:
    """Raises EngineNotFound where runs of several ranks cannot be started by what is on the PATH."""
    for program, package in (("mpirun", "openmpi-bin"), ("ip", "iproute2")):
        if not shutil.which(program, path=path):
            raise EngineNotFound(
                f"{program} is not installed, which --mpi-ranks needs: apt install {package}"
            )
    tried = subprocess.run([*ALONE, "sh", "true"], capture_output=True, text=True)
    if tried.returncode:
        said = (tried.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise EngineNotFound(
            "mpirun would listen on every network interface and leave files in shared memory, and this machine allows it no "
            "network and file system of its own "
            f"({said}): leave out --mpi-ranks"
        )
