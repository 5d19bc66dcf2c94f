"""LIGGGHTS-PUBLIC: data files for the deck liggghts_case.in, and its output as a Dataset."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from functools import lru_cache
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd

from .case import Case
from .dataset import Dataset, Motion
from .dataset_faults import FORCE_ROUNDING, FORCE_TOLERANCE_N
from .engine import (
    INPUTS,
    OUTPUT,
    Engine,
    EngineFailure,
    EngineNotFound,
    options,
    unexpressed_options,
    unexpressed_readings,
    where_it_differs,
)
from .liggghts_input import bar, half_depth_m, numbering, numbers, particles, resisting_rolling
from .packing import Packing
from .sample_table import SAMPLE_COLUMNS, frame_times, resistance_table, whole_lines
from .schedule import Schedule

# What the deck includes, by whether the case has a bar and by whether displacements are averaged.
BAR_DECKS = [Path(__file__).with_name(f"liggghts_bars_{bars}.in") for bars in (0, 1)]
INTEGRATOR_DECKS = [Path(__file__).with_name(f"liggghts_averaged_{number}.in") for number in (0, 1)]
ROLLING_DECK = Path(__file__).with_name("liggghts_rolling.in")
# src/cohesion_model_*.h of LIGGGHTS-PUBLIC 3.8: sjkr, sjkr2, easo/capillary/viscous, washino/capillary/viscous.
LACKS = {
    "tensile_strength_N": "its models of cohesion attract by the area of contact (sjkr) or by a liquid bridge (easo, washino); none "
    "is a spring that carries tension up to a strength"
}
SAMPLES = f"{OUTPUT}/samples.txt"
FRAMES = f"{OUTPUT}/frames.txt"
FRAME_COLUMNS = ("id", "x_m", "y_m", "vx_m_s", "vy_m_s", "omega_rad_s")
FRAME_HEADER_LINES = 9
# Open MPI would start a daemon beside even a single process, and that opens TCP ports on every interface.
NO_MPI_DAEMON = {
    "OMPI_MCA_ess_singleton_isolated": "1",
    "OMPI_MCA_btl": "self",
    "OMPI_MCA_pml": "ob1",
    # Relative to the run's folder: where they share one, the end of a process may take the start of another's away.
    "OMPI_MCA_orte_tmpdir_base": OUTPUT,
}
ERROR_LINE = re.compile(r"^ERROR[^:]*: (.+?)(?: \([\w./]+:\d+\))?$", re.MULTILINE)


class Liggghts(Engine):
    name = "liggghts"
    sources = "liggghts"
    averaged = False  # whether it moves by the paper's averaged displacement
    program = "liggghts"
    script = Path(__file__).with_name("liggghts_case.in")
    samples_file = SAMPLES
    cost_s = 1.2e-7
    integration = ("integrator", "velocity_verlet")
    integrator = "integrates by velocity Verlet, not by the averaged displacement of Eqs (19)-(24)"

    def executable(self) -> str:
        found = shutil.which("liggghts")
        if not found:
            raise EngineNotFound("liggghts is not installed: apt install liggghts")
        return found

    def version(self) -> str:
        return said_version(self.executable(), r"Version ([^,)]+)", "LIGGGHTS", "liggghts")

    def environment(self) -> dict[str, str]:
        return super().environment() | NO_MPI_DAEMON

    def unsupported(self, case: Case) -> list[str]:
        return [*unexpressed_readings(case), *unexpressed_options(case, LACKS)]

    def limitations(self, case: Case) -> list[str]:
        own = {
            (
                "slip_cap",
                "total",
            ): "caps the shear spring by the absolute total normal force, not by the normal spring "
            "force of Eq (9)",
            (
                "torque_arm",
                "contact_point",
            ): "takes torque arms and slip velocity at r - overlap / 2, not at the full "
            "radius of Eqs (2) and (12)",
            (
                "first_contact_shear",
                "whole_step",
            ): "counts a first contact's shear displacement in full, without the "
            "share of Eq (4)",
            (
                "normal_spring",
                "overlap",
            ): "takes the normal spring from the overlap, not by the increments of Eq (5)",
        }
        return [
            *where_it_differs(case, {self.integration: self.integrator} | own),
            "rotates its shear spring with the contact by projection",
            "near a corner of the bar, a disc on its side may feel side and corner at once",
            "keeps no angles of the particles",
            "of the readings in [scheme] follows only attraction",
            *(
                ["resists rolling by up to mu_r times the absolute total normal force"]
                if options(case)
                else []
            ),
        ]

    def command(self, case: Case, run_dir: Path) -> list[str]:
        # Unbuffered, because some of its errors end the process without flushing what they said.
        deck = f"{INPUTS}/{self.script.name}"
        return ["stdbuf", "-o0", self.program, "-log", "none", "-in", deck]

    def complaint(self, log: str) -> str | None:
        found = ERROR_LINE.findall(log)
        return found[-1] if found else None

    def lines_before_bar(self, case: Case) -> int:
        schedule = self.schedule(case)
        first_step, start_step = numbering(schedule)
        # A title, the sample of the packing, and those of the rest less its last, which is that of the bar's start.
        return 1 + start_step // schedule.sample - first_step // schedule.sample

    def write_input(self, case: Case, packing: Packing, run_dir: Path) -> None:
        inputs = run_dir / INPUTS
        self._copy_script(run_dir)
        texts = {
            "numbers.in": numbers(case.resolved, self.schedule(case), packing, self.averaged),
            "particles.data": particles(case.resolved, packing, half_depth_m(packing)),
        }
        if "bar" in case.resolved:
            texts["bar.stl"] = bar(case.resolved, packing)
        for name, text in texts.items():
            (inputs / name).write_text(text, encoding="ascii")
        decks = [BAR_DECKS["bar" in case.resolved], INTEGRATOR_DECKS[self.averaged]]
        for included in decks:
            shutil.copyfile(included, inputs / included.name)
        if options(case):  # of which it has none but that against rolling
            shutil.copyfile(ROLLING_DECK, inputs / ROLLING_DECK.name)
            for name in (self.script.name, decks[0].name):
                text = (inputs / name).read_text(encoding="ascii")
                (inputs / name).write_text(resisting_rolling(text), encoding="ascii")

    def read_output(self, case: Case, packing: Packing, run_dir: Path, manifest: dict) -> Dataset:
        schedule = self.schedule(case)
        radius_m = packing.particles["radius_m"].to_numpy(dtype=float)
        resistance = _read_samples(run_dir / SAMPLES, case.resolved, schedule, self.name)
        motion = _read_frames(run_dir / FRAMES, case.resolved, schedule, packing, self.name)
        return Dataset(case.resolved, manifest, radius_m, motion, resistance)


class LiggghtsAveraged(Liggghts):
    """LIGGGHTS with the paper's averaged displacement, by velocities set anew after every step."""

    name = "liggghts-averaged"
    averaged = True
    cost_s = 8e-7
    log_noise = re.compile(  # every step is a run of its own, after which velocities are set
        rb"^(Setting atom values \.\.\.| +\d+ settings made for \w+| +Step .*| +\d+( +[-+.e\d]+){7} *|Loop time .*|)\n",
        re.MULTILINE,
    )
    integration = ("integrator", None)  # always worth saying
    integrator = (
        "integrates by velocity Verlet from velocities that are set after every step such that it moves by the "
        "averaged displacement of Eqs (19)-(24)"
    )


@lru_cache
def said_version(executable: str, pattern: str, code: str, package: str) -> str:
    """What `executable` says of its version when asked for help, by the one group of `pattern`. Raises EngineNotFound."""
    try:
        with TemporaryDirectory() as folder:
            asked = subprocess.run(
                [executable, "-log", "none", "-h"],
                env=os.environ | NO_MPI_DAEMON | {"OMPI_MCA_orte_tmpdir_base": folder},
                cwd=folder,
                capture_output=True,
                timeout=60,
            )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise EngineNotFound(f"{executable} does not say its version: {error}") from error
    said = asked.stdout.decode(errors="replace")
    found = re.search(pattern, said)
    if not found:
        raise EngineNotFound(
            f"{executable} does not say its version; is it {code}? (apt install {package})"
        )
    return found[1]


def _read_samples(path: Path, case: dict, schedule: Schedule, engine: str) -> pd.DataFrame:
    """The table of resistance from the samples at and after the start of the bar."""
    try:
        table = pd.read_csv(
            StringIO(whole_lines(path)),
            sep=r"\s+",
            comment="#",
            header=None,
            names=SAMPLE_COLUMNS,
            float_precision="round_trip",
        ).astype(float)
    except (OSError, ValueError) as error:
        raise EngineFailure(f"{engine} left no readable {path.name} ({error})") from error
    table["step"] -= numbering(schedule)[1]
    table = resistance_table(table, case, schedule, engine)
    # f_bar sums over the bar's contacts, the other two over the discs: they must be the same force.
    gap_N = (table["tip_force_y_N"] + table["shaft_force_y_N"] - table["force_y_N"]).abs().max()
    if gap_N > FORCE_TOLERANCE_N + FORCE_ROUNDING * table["force_y_N"].abs().max():
        raise EngineFailure(f"{engine}: tip and shaft miss the bar's force by {gap_N:.3g} N")
    return table


def _bar_tip_m(case: dict, packing: Packing, time_s: np.ndarray) -> np.ndarray | None:
    return packing.bar_tip_m - case["bar"]["speed_m_s"] * time_s if "bar" in case else None


def _read_frames(
    path: Path, case: dict, schedule: Schedule, packing: Packing, engine: str
) -> Motion:
    """The motion after the rest, from a text dump whose frames all have the same particles, sorted by id."""
    count = len(packing.particles)
    try:
        text = whole_lines(path).splitlines()
    except OSError as error:
        raise EngineFailure(f"{engine} left no readable {path.name} ({error.strerror})") from error
    block = FRAME_HEADER_LINES + count
    _, start_step = numbering(schedule)
    frames, steps = [], []
    for first in range(0, len(text), block):
        lines = text[first : first + block]
        try:
            if int(lines[3]) != count:
                raise EngineFailure(
                    f"{engine} lost {count - int(lines[3])} particles by step {lines[1]}"
                )
            frame = np.array([line.split() for line in lines[FRAME_HEADER_LINES:]], dtype=float)
            whole = frame.shape == (count, len(FRAME_COLUMNS))
        except (ValueError, IndexError):
            whole = False
        if not whole:
            break
        if int(lines[1]) >= start_step:
            steps.append(int(lines[1]) - start_step)
            frames.append(frame)
    time_s = frame_times(np.array(steps, dtype=int), case, schedule, engine)
    values = np.stack(frames)
    if not np.isfinite(values).all():
        raise EngineFailure(f"{engine} wrote positions or velocities that are not finite")
    if not (values[:, :, 0] == np.arange(1, count + 1)).all():
        raise EngineFailure(
            f"{engine} lost particles: the ids in its frames are not those of the packing"
        )
    return Motion(
        time_s=time_s,
        position_m=values[:, :, 1:3],
        velocity_m_s=values[:, :, 3:5],
        angular_velocity_rad_s=values[:, :, 5],
        angle_rad=None,
        bar_tip_m=_bar_tip_m(case, packing, time_s),
    )
