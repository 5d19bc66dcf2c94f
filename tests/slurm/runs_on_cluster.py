"""`crossdem run --profile slurm` at work on a cluster, and the journal of its attempts at each run."""

import json
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

from command_line import REFERENCE, ROOT
from small_case import SMALL

POLL_S = 0.1
END_S = 30.0  # to take its jobs back


@dataclass(frozen=True)
class Attempt:
    """One attempt at a run, as far as its journal goes."""

    run: str
    folder: str  # that it worked in
    process: int
    how: str | None  # it ended; None: it goes on, or was killed


class RunsOnCluster:
    """`seeds` native runs of about a second each, in `tasks` jobs of the cluster."""

    def __init__(self, cluster, workspace: Path, seeds: int, tasks: int, *overrides: str):
        self.workspace = workspace
        self._output = workspace.with_suffix(".output")
        case = (*SMALL, "time.penetration_s=1.0", "time.frame_interval_s=0.1", *overrides)
        self._process = subprocess.Popen(
            ["setpriv", "--pdeathsig", "TERM"]  # it ends with the test
            + [ROOT / "crossdem", "run", REFERENCE, "--engines", "native", "--profile", "slurm"]
            + ["--seeds", str(seeds), "--jobs", str(tasks), "--out", workspace]
            + [argument for override in case for argument in ("--set", override)],
            cwd=workspace.parent,
            env={**cluster.environment, "CI": "true"},  # or Snakemake looks only every 10 s
            stdout=self._output.open("w"),
            stderr=subprocess.STDOUT,
        )

    def __enter__(self) -> "RunsOnCluster":
        return self

    def __exit__(self, *_) -> None:
        self._process.terminate()
        try:
            self._process.wait(END_S)
        finally:
            self._process.kill()

    def wait(self, timeout_s: float) -> tuple[int, str]:
        """Exit status and output."""
        status = self._process.wait(timeout_s)
        return status, self._output.read_text()

    def wait_until(self, condition, timeout_s: float = 120.0):
        """The first answer of `condition` to the attempts so far that is more than nothing."""
        deadline = time.monotonic() + timeout_s
        while not (answer := condition(self.attempts())):
            assert time.monotonic() < deadline, f"{self.attempts()}\n{self._output.read_text()}"
            time.sleep(POLL_S)
        return answer

    def attempts(self) -> list[Attempt]:
        found = []
        for file in (self.workspace / "workflow" / "journal").glob("*.jsonl"):
            events = [json.loads(line) for line in file.read_text().splitlines()]
            assert [event["event"] for event in events] in (["start"], ["start", "end"])
            start, how = events[0], events[-1].get("how")
            found.append(Attempt(start["run"], start["folder"], start["pid"], how))
        return found
