"""Starting Snakemake on a plan: its command, its environment, its end."""

from __future__ import annotations

import importlib.metadata
import os
import shlex
import signal
import subprocess
import sys
from pathlib import Path

import crossdem

from ..process import Ending, Process

HERE = Path(__file__).resolve().parent
LOG = "snakemake.log"
SHIPPED_PROFILES = ("slurm",)  # folders beside this file
GRACE_S = 5.0  # to end tasks and their engines
GRACE_ON_CLUSTER_S = 60.0  # to take back what was handed in
LAST_LINES = 5
PING_S = 30.0  # for the controllers of a cluster to answer
UNSAFE = frozenset(
    "'\"$`\\\n"
)  # in a path that Snakemake puts into a job's script in quotes of its own


class WorkflowError(Exception):
    """Snakemake is missing, or a profile, or it cannot work in the folder."""


def version() -> str:
    """Of the Snakemake that is installed. Raises WorkflowError."""
    try:
        return importlib.metadata.version("snakemake")
    except importlib.metadata.PackageNotFoundError as error:
        raise WorkflowError("snakemake is not installed: apt install snakemake") from error


class Snakemake:
    """Snakemake at work on the plan in the folder `call`."""

    def __init__(self, call: Path, jobs: int | None, profile: str | None):
        """At most `jobs` processes here, or tasks handed in with a profile, whose own number holds for None.

        Raises WorkflowError, OSError.
        """
        version()
        if profile and (found := UNSAFE.intersection(str(call.absolute()))):
            raise WorkflowError(
                f"{call.absolute()}: with --profile, Snakemake can work in no folder with {' '.join(sorted(found))} in its "
                "path: choose another with --out"
            )
        self.log = call / LOG
        self._grace_s = GRACE_ON_CLUSTER_S if profile else GRACE_S
        command = [
            # -P: a user's file of the name of a module, in the folder of the call, is none.
            *(sys.executable, "-P", "-m", f"{__package__}.scheduler"),
            *("--snakefile", str(HERE / "Snakefile"), "--directory", str(call.absolute())),
            *("--keep-going", "--retries", "1", "--rerun-triggers", "mtime", "--nocolor"),
            *(_on_cluster(profile, jobs) if profile else _on_cores(jobs)),
        ]
        root = Path(crossdem.__file__).resolve().parent
        paths = [str(root), *filter(None, [os.environ.get("PYTHONPATH")])]
        environment = {
            "PYTHONPATH": os.pathsep.join(paths),
            "SNAKEMAKE_PROFILE": "",  # a user's own, which Snakemake would add to what it is told here
        }
        # In the call's folder, as Snakemake prefers a file found where it is started to one of the profile.
        self._process = Process(command, call, environment, self.log)

    def poll(self) -> Ending | None:
        return self._process.poll()

    def cancel(self) -> None:
        """End it, its tasks and their engines, or take them back from the cluster."""
        self._process.kill(signal.SIGINT, self._grace_s)

    def last_words(self) -> str:
        text = self.log.read_text(encoding="utf-8", errors="replace")
        return "\n".join([line for line in text.splitlines() if line.strip()][-LAST_LINES:])


def profile_folder(profile: str) -> str:
    """What Snakemake is told. Raises WorkflowError."""
    if profile in SHIPPED_PROFILES:
        return str(HERE / profile)
    if not (Path(profile) / "config.yaml").is_file():
        raise WorkflowError(
            f"{profile}: neither {', '.join(SHIPPED_PROFILES)} nor a folder with a config.yaml"
        )
    return str(Path(profile).absolute())


def check_cluster(profile: str | None) -> None:
    """Raises WorkflowError where nobody would take the tasks of a `profile` that is shipped: Slurm's own commands wait."""
    if profile != "slurm":
        return
    try:
        ping = subprocess.run(
            ["scontrol", "ping"],
            capture_output=True,
            text=True,
            timeout=PING_S,
            stdin=subprocess.DEVNULL,
        )
        if any(line.endswith("UP") for line in ping.stdout.splitlines()):
            return
        said = ping.stdout.split("\n")[:1] if ping.stdout else ping.stderr.splitlines()[-1:]
        why = "".join(said) or "scontrol ping says nothing"
    except FileNotFoundError:
        why = "there is no scontrol here: apt install slurm-client"
    except subprocess.TimeoutExpired:
        why = f"scontrol ping has no answer after {PING_S:.0f} s"
    raise WorkflowError(f"--profile slurm: no Slurm controller answers, and nothing was run: {why}")


def _on_cores(jobs: int) -> list[str]:
    return ["--cores", str(jobs), "--scheduler", "greedy"]


def _on_cluster(profile: str, jobs: int | None) -> list[str]:
    command = ["--profile", profile_folder(profile), *(["--jobs", str(jobs)] if jobs else [])]
    if profile in SHIPPED_PROFILES:
        scripts = HERE / profile
        command += ["--jobscript", str(scripts / "jobscript.sh")]
        command += ["--cluster-status", shlex.quote(str(scripts / "status"))]  # goes to a shell
        command += ["--cluster-cancel", str(scripts / "cancel")]
    return command
