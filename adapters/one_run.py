"""One run on its way: a folder that is being worked in, a process, and in the end a dataset or the reason why not."""

from __future__ import annotations

import errno
import shutil
import time
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path

from . import run_folder
from .attempt import Attempt
from .dataset import Dataset, DatasetError
from .dataset_faults import SCHEMA_VERSION, bar_speed_m_s
from .engine import OUTPUT, Declined, Engine, EngineFailure
from .files import refuse_special_files
from .machine import machine_facts
from .process import Ending, LineCounter, Process
from .run_folder import RunRequest, prepare, run_name

LOG = "engine.log"
FULL_DISK_B = 100_000  # free space below which a failure is put down to it


@dataclass(frozen=True)
class Limits:
    """When to give up on a process. Generous: the cores may be shared."""

    least_s: float = 300.0  # of wall time, for any run
    factor: float = 20.0  # of the CPU time that a run is expected to take
    silent_s: float = 120.0  # without a new sample, at the least
    silent_share: float = 1.0  # of the expected CPU time without a new sample

    def allowed_s(self, expected_s: float) -> float:
        """Wall time of a run that is expected to take so much CPU time."""
        return max(self.least_s, self.factor * expected_s)


class Run:
    """One request, its folders and its process."""

    def __init__(
        self,
        request: RunRequest,
        engine: Engine,
        key: str,
        out_dir: Path,
        journal: Path | None = None,
    ):
        self.request = request
        self.case = request.case
        self.engine = engine
        self.key = key
        self.out_dir = out_dir
        self.name = run_name(request.packing, engine, key)
        self.folder = out_dir / "runs" / self.name
        self.failed_folder = out_dir / "failed" / self.name
        self._attempt = Attempt(self.name, self.folder.parent, journal)
        self.work_dir = self._attempt.work_dir
        self.started: datetime | None = None  # None: reused, or not yet
        self.ending: Ending | None = None
        self.process: Process | None = None

    def start(self) -> None:
        """Write the input and start the process. Raises EngineNotFound, OSError."""
        self._attempt.begin()
        ranks = self.request.ranks
        prepare(self.case, self.request.packing, self.engine, self.work_dir, ranks)
        command = run_folder.command(self.case, self.engine, self.work_dir, ranks)
        command[command.index(self.engine.program)] = self.engine.executable()
        self.started = datetime.now(timezone.utc)
        self._samples = LineCounter(self.work_dir / self.engine.samples_file)
        self._last_sample = time.monotonic()
        environment = run_folder.environment(self.engine, ranks)
        self.process = Process(command, self.work_dir, environment, self.work_dir / LOG)

    def poll(self, limits: Limits) -> bool:
        """Whether the process has ended. Raises EngineFailure, having ended it, when there is no use in waiting on."""
        self.ending = self.process.poll()
        if self.ending is None and (overdue := self._overdue(limits)):
            self.process.kill()
            raise EngineFailure(f"{overdue} {self._stage()} and was ended")
        return self.ending is not None

    def progress(self) -> tuple[float, float | None]:
        """Share of the samples written [0, 1], and the seconds left as far as that tells."""
        lines = self._samples.lines
        if self._samples.update() > lines:
            self._last_sample = time.monotonic()
        share = min(1.0, self._samples.lines / self.engine.lines_in_all(self.case))
        return share, self.process.wall_s * (1 - share) / share if share > 0 else None

    def read(self) -> Dataset:
        """What a process that has ended left, its gates still to be set. Raises EngineFailure, Declined."""
        if self.ending.status != 0:
            log = (self.work_dir / LOG).read_bytes().decode(errors="replace")
            complaint = self.engine.complaint(log)
            if self.ending.status == self.engine.declined_status:
                raise Declined(complaint or "it does not say why")
            raise EngineFailure(
                f"{self.ending} {self._stage()}" + (f": {complaint}" if complaint else "")
            )
        try:
            refuse_special_files(self.work_dir)
        except OSError as error:
            raise EngineFailure(
                f"ended with status 0, but what it left cannot be read: {error}"
            ) from error
        try:
            return self.engine.read_output(
                self.case, self.request.packing, self.work_dir, self._manifest()
            )
        except DatasetError as error:
            raise EngineFailure(
                f"ended with status 0, but what it left is not a whole run: {error}"
            ) from error

    def keep(self, dataset: Dataset) -> None:
        """Put the finished run in its place, unless another attempt has been there first. Raises OSError."""
        for name in self.engine.kept_output:
            if (self.work_dir / OUTPUT / name).exists():
                shutil.copyfile(self.work_dir / OUTPUT / name, self.work_dir / name)
        if self.engine.log_noise:
            log = self.work_dir / LOG
            log.write_bytes(self.engine.log_noise.sub(b"", log.read_bytes()))
        whole = self._attempt.whole_dir
        dataset.write(whole, extra_files_from=self.work_dir, without=OUTPUT)
        published = self._publish(whole)
        shutil.rmtree(self.failed_folder, ignore_errors=True)
        self._attempt.end("published" if published else "was there")

    def put_aside(self, reason: str) -> str:
        """Leave what there is for people to look at; returns the whole message."""
        message = f"{self.engine.name} {reason}"
        if shutil.disk_usage(self.work_dir.parent).free < FULL_DISK_B:
            message += " (the disk is full)"
        if not self.work_dir.exists():
            return message
        try:
            self.failed_folder.parent.mkdir(exist_ok=True)
            shutil.rmtree(self.failed_folder, ignore_errors=True)
            self.work_dir.rename(self.failed_folder)
        except OSError:  # a full disk, again
            self._attempt.end("failed", leaving=True)
            return f"{message}; see {self.work_dir / LOG}"
        self._attempt.end("failed")
        return f"{message}; see {self.failed_folder / LOG}"

    def stop(self) -> None:
        """End the process, if there is one, and leave nothing."""
        if self.process:
            self.process.kill()
        self._attempt.end("stopped")

    def finished(self) -> Dataset | None:
        """The dataset that another attempt, or an earlier call, left for the same run, if it is whole."""
        try:
            dataset = Dataset.read(self.folder)
        except DatasetError:
            return None
        return dataset if dataset.manifest["run_key"] == self.key else None

    def _publish(self, whole: Path) -> bool:
        """Whether the dataset in `whole` is now in its place: the first that is there stays, as readers may have it open."""
        while True:
            try:
                whole.rename(self.folder)
                return True
            except OSError as error:
                if error.errno not in (errno.ENOTEMPTY, errno.EEXIST):
                    raise
            if self.finished():
                return False
            broken = whole.with_suffix(".broken")  # one step takes it away, whole or not at all
            try:
                self.folder.rename(broken)
            except FileNotFoundError:  # another attempt has done so
                continue
            shutil.rmtree(broken)

    def _overdue(self, limits: Limits) -> str | None:
        self.progress()
        expected_s = self.engine.expected_s(self.case)
        allowed_s = limits.allowed_s(expected_s)
        silent_s = max(limits.silent_s, limits.silent_share * expected_s)
        if self.process.wall_s > allowed_s:
            return f"ran past its time limit of {allowed_s:.3g} s"
        if time.monotonic() - self._last_sample > silent_s:
            return f"made no progress for {silent_s:.3g} s"
        return None

    def _stage(self) -> str:
        self.progress()
        samples = self._samples.lines - self.engine.lines_before_bar(self.case)
        if samples <= 0:
            return "while resting"
        moved_s = (samples - 1) * self.case.resolved["time"]["sample_interval_s"]
        if "bar" not in self.case.resolved:
            return f"after {moved_s:.3g} s"
        depth_cm = 100 * bar_speed_m_s(self.case.resolved) * moved_s
        return f"with the bar at a depth of {depth_cm:.3g} cm"

    def _manifest(self) -> dict:
        case, packing, schedule = self.case, self.request.packing, self.engine.schedule(self.case)
        return {
            "schema_version": SCHEMA_VERSION,
            "case_name": case.name,
            "case_hash": case.hash,
            "packing_hash": packing.hash,
            "seed": packing.seed,
            "twin": packing.twin,
            "engine": self.engine.name,
            "engine_version": self.engine.version(),
            "compiler": self.engine.compiler(),
            "time_step_s": schedule.step_s,
            "command": run_folder.command(case, self.engine, self.work_dir, self.request.ranks),
            "started_utc": self.started.isoformat(timespec="seconds"),
            "wall_s": round(self.ending.wall_s, 3),
            "cpu_s": round(self.ending.cpu_s, 3),
            "particles": len(packing.particles),
            "frames": schedule.frames,
            "samples": schedule.samples,
            "machine": machine_facts(),
            "limitations": self.engine.limitations(case),
            "gates": [],
            "run_key": self.key,
        }
