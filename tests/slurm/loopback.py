#!/usr/bin/python3
"""A whole Slurm cluster on this machine: a controller and two nodes, which listen on 127.0.0.1 only.

    tests/slurm/loopback.py start FOLDER     prints the line that has sbatch and others find it
    tests/slurm/loopback.py status FOLDER
    tests/slurm/loopback.py stop FOLDER

Configuration, state and logs lie in FOLDER; the system's own Slurm and munge are neither read nor touched.
Works as root, and as an ordinary user for that user's jobs.
"""

import os
import pwd
import shutil
import signal
import socket
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path

import processes

PACKAGES = {
    "munged": "munge",
    "slurmctld": "slurmctld",
    "slurmd": "slurmd",
    "sbatch": "slurm-client",
}
NODES = ("node1", "node2")
START_S = 20.0  # for a daemon to come up
GRACE_S = 3.0  # between asking a process to end and ending it
ATTEMPTS = 3  # to find ports that are still free when the daemons take them
LONGEST_SOCKET_PATH = 107  # of Linux
TEMPLATE = Path(__file__).with_name("loopback.conf")
ENVIRONMENT = {**os.environ, "PATH": f"{os.environ.get('PATH', '/usr/bin:/bin')}:/usr/sbin:/sbin"}


class LoopbackError(Exception):
    """The cluster is not up: why, and the last words of the daemon to blame."""


class Loopback:
    """One such cluster, which lives in `folder`."""

    def __init__(self, folder: Path):
        self.folder = Path(folder).resolve()
        self.configuration = self.folder / "slurm.conf"
        self.environment = {**ENVIRONMENT, "SLURM_CONF": str(self.configuration)}

    def __enter__(self) -> "Loopback":
        """A cluster that ends with the block, or with this process."""
        guard = ["setsid", "--fork", sys.executable, __file__, "guard", str(self.folder)]
        quiet = subprocess.DEVNULL
        self._guard = subprocess.Popen(guard, stdin=subprocess.PIPE, stdout=quiet, stderr=quiet)
        self.start()
        return self

    def __exit__(self, *_) -> None:
        self.stop()
        self._guard.communicate()

    def start(self) -> None:
        """Returns when every node waits for jobs. Raises LoopbackError, leaving no process."""
        if lacking := missing_packages():
            raise LoopbackError(f"no Slurm here: apt-get install {' '.join(lacking)}")
        if self.daemons():
            raise LoopbackError(f"{self.folder}: a cluster runs here already")
        self._make_folders()
        for attempts_left in reversed(range(ATTEMPTS)):
            self._configure(*_free_ports(1 + len(NODES)))
            try:
                self._start_munged()
                self.start_controller()
                for node in NODES:
                    self.start_node(node)
                return
            except LoopbackError as error:
                self.stop()
                if not attempts_left or "Address already in use" not in str(error):
                    raise
            except BaseException:
                self.stop()
                raise

    def start_controller(self) -> None:
        self._start("slurmctld", ["slurmctld", "-D"], self.nodes)

    def start_node(self, node: str) -> None:
        ready = ("idle", "mixed", "allocated")
        self._start(node, ["slurmd", "-D", "-N", node], lambda: self.nodes().get(node) in ready)

    def kill_daemon(self, name: str) -> None:
        """End slurmctld or a node's slurmd at once. The jobs of that node run on, as orphans."""
        processes.send({self.daemons()[name]}, signal.SIGKILL)

    def kill_node(self, node: str) -> None:
        """End a node's slurmd and all of its jobs at once: a power cut."""
        self.kill_daemon(node)
        while jobs := self.job_processes(node):
            processes.send(
                jobs, signal.SIGSTOP, signal.SIGKILL
            )  # none is to report another's death

    def stop(self) -> None:
        """End daemons and jobs, and wait for that."""
        for number in (signal.SIGTERM, signal.SIGKILL):
            deadline = time.monotonic() + GRACE_S
            while alive := {*self.daemons().values(), *self.job_processes()}:
                processes.send(alive, number)
                if time.monotonic() > deadline:
                    break
                time.sleep(0.05)

    def daemons(self) -> dict[str, int]:
        """Process ids of the daemons that run, by name."""
        found = {}
        for file in self.folder.glob("*.process"):
            process, started = file.read_text().split()
            if processes.started(int(process)) == started:
                found[file.stem] = int(process)
        return found

    def job_processes(self, node: str | None = None) -> set[int]:
        """All that jobs have started on a node, or on any, and the slurmstepd that watch over them."""
        return processes.of_jobs(self.configuration, node)

    def nodes(self) -> dict[str, str]:
        """State of each node, such as idle; empty while the controller is away."""
        listing = self.call("sinfo", "--noheader", "--Node", "--format=%N %T")
        return dict(line.split() for line in listing.stdout.splitlines())

    def call(self, *command: str) -> subprocess.CompletedProcess:
        """One of Slurm's commands, on this cluster."""
        return subprocess.run(
            command, env=self.environment, capture_output=True, text=True, timeout=60
        )

    def _make_folders(self) -> None:
        for name in ("state", *NODES):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        socket_path = self.folder / f"{NODES[0]}/{NODES[0]}_1000.4294967291"
        if len(str(socket_path)) > LONGEST_SOCKET_PATH:
            raise LoopbackError(f"{self.folder}: too long a path for a socket; choose another")
        key = os.open(self.folder / "munge.key", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
        with open(key, "wb") as file:
            file.write(os.urandom(128))

    def _configure(self, controller_port: int, *node_ports: int) -> None:
        nodes = (
            f"NodeName={node} NodeHostname=localhost NodeAddr=127.0.0.1 Port={port}"
            for node, port in zip(NODES, node_ports)
        )
        text = TEMPLATE.read_text().format(
            user=pwd.getpwuid(os.getuid()).pw_name,
            folder=self.folder,
            controller_port=controller_port,
            nodes="\n".join(nodes),
        )
        self.configuration.write_text(text)

    def _start_munged(self) -> None:
        files = {
            "key-file": "munge.key",
            "socket": "munge.socket",
            "pid-file": "munge.pid",
            "seed-file": "munge.seed",
            "log-file": "munge.log",
        }
        options = [f"--{option}={self.folder / name}" for option, name in files.items()]
        socket_path = self.folder / "munge.socket"
        socket_path.unlink(missing_ok=True)
        # By force, as it wants a folder that everyone can reach.
        self._start("munged", ["munged", "--foreground", "--force", *options], socket_path.exists)

    def _start(self, name: str, command: list[str], is_up) -> None:
        output = self.folder / f"{name}.out"
        with open(output, "wb") as file:
            process = subprocess.Popen(
                command,
                cwd=self.folder,
                env=self.environment,
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        identity = f"{process.pid} {processes.started(process.pid)}\n"
        (self.folder / f"{name}.process").write_text(identity)
        deadline = time.monotonic() + START_S
        while not is_up():
            ended = process.poll()
            if ended is not None or time.monotonic() > deadline:
                why = "did not come up" if ended is None else f"ended with status {ended}"
                last = "\n".join(output.read_text(errors="replace").splitlines()[-15:])
                raise LoopbackError(f"{name} {why}; the end of {output}:\n{last}")
            time.sleep(0.05)


def missing_packages() -> list[str]:
    """Debian packages to install before a cluster can start."""
    path = ENVIRONMENT["PATH"]
    return [
        package for program, package in PACKAGES.items() if not shutil.which(program, path=path)
    ]


def _free_ports(count: int) -> list[int]:
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]


def main() -> int:
    if len(sys.argv) != 3 or sys.argv[1] not in ("start", "status", "stop", "guard"):
        print(__doc__, file=sys.stderr)
        return 2
    cluster = Loopback(Path(sys.argv[2]))
    if sys.argv[1] == "start":
        try:
            cluster.start()
        except LoopbackError as error:
            print(f"loopback: {error}", file=sys.stderr)
            return 1
        print(f"export SLURM_CONF={cluster.configuration}")
    elif sys.argv[1] == "status":
        for name, process in cluster.daemons().items():
            print(f"{name} runs as process {process}")
        print("\n".join(f"{node} is {state}" for node, state in cluster.nodes().items()))
        return 0 if cluster.daemons() else 1
    else:
        if sys.argv[1] == "guard":
            sys.stdin.read()  # until there is nobody left who could write to it
        cluster.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
