"""YADE, by itself and with the paper's averaged displacement: the script yade_case.py and its output as a Dataset."""

from __future__ import annotations

import glob
import re
import shutil
import subprocess
from functools import lru_cache
from io import StringIO
from pathlib import Path

import numpy as np
import pandas as pd

from .case import Case
from .dataset import Dataset, Motion
from .engine import (
    INPUTS,
    OUTPUT,
    Engine,
    EngineFailure,
    EngineNotFound,
    unexpressed_options,
    unexpressed_readings,
    where_it_differs,
)
from .packing import Packing
from .sample_table import SAMPLE_COLUMNS, frame_times, resistance_table, whole_lines
from .schedule import Schedule

PYTHON = "/usr/bin/python3"  # YADE's modules are built for the system's Python
SAMPLES = f"{OUTPUT}/samples.csv"
FRAMES = f"{OUTPUT}/frames.f64"
VALUES_PER_PARTICLE = 6  # x, y, vx, vy, angle, angular velocity
# As YADE itself documents Law2_ScGeom_ViscElPhys_Basic, ViscElMat.mRtype and the laws of CohFrictPhys and ViscElCapPhys.
LACKS = {
    "tensile_strength_N": "its law with dashpots carries no tension; its bonds (CohFrictPhys) have no dashpots, and its liquid "
    "bridges (ViscElCapPhys) pull by their own law",
    "rolling_friction": "its law has no spring against rolling, only a moment by the direction or the rate of rolling (mR, mRtype), "
    "which holds nothing at rest",
}


class Yade(Engine):
    name = "yade"
    sources = "yade"
    program = PYTHON
    script = Path(__file__).with_name("yade_case.py")
    memory_script = Path(__file__).with_name("yade_averaged.py")  # imported by the other
    samples_file = SAMPLES
    cost_s = 4e-7
    integration = ("integrator", "leap_frog")
    integrator = (
        "integrates by leap-frog, not by the averaged displacement of Eqs (19)-(24)",
        "its velocities and its kinetic energy are those of half a time step before their time",
    )

    def executable(self) -> str:
        if not glob.glob("/usr/lib/*/yade-double/py/yade") or not Path(PYTHON).exists():
            raise EngineNotFound("yade is not installed: apt install yade")
        return PYTHON

    def version(self) -> str:
        self.executable()
        return _version()

    def unsupported(self, case: Case) -> list[str]:
        found = [*unexpressed_readings(case), *unexpressed_options(case, LACKS)]
        pair = case.resolved["contact"]["particle_particle"]
        wall = case.resolved["contact"]["particle_wall"]
        for key, value in wall.items():
            if key != "friction" and value == 0 and pair[key] != 0:
                found.append(
                    f"contact.particle_wall.{key} = 0 cannot be had in series with {pair[key]:g} of the particles"
                )
        return found

    def limitations(self, case: Case) -> list[str]:
        own = {
            (
                "slip_cap",
                "total",
            ): "caps the shear spring by the total normal force, not by the normal spring force of "
            "Eq (9)",
            (
                "first_contact_shear",
                "whole_step",
            ): "counts a first contact's shear displacement in full, without the "
            "share of Eq (4)",
            (
                "attraction",
                "clipped",
            ): "clips attraction in the normal direction; Eqs (6) and (8) let the dashpot pull",
            (
                "normal_spring",
                "overlap",
            ): "takes the normal spring from the overlap, not by the increments of Eq (5)",
        }
        return [
            *where_it_differs(case, {self.integration: self.integrator[0]} | own),
            *self.integrator[1:],
            "takes torque arms and slip velocity at r - overlap / 2, at the container's walls at r - overlap, "
            "not at the full radius of Eqs (2) and (12)",
            "rotates its shear spring with the contact to first order",
            "of the readings in [scheme] follows none",
        ]

    def command(self, case: Case, run_dir: Path) -> list[str]:
        return [self.program, f"{INPUTS}/{self.script.name}", self.name]

    def lines_before_bar(self, case: Case) -> int:
        schedule = self.schedule(case)
        return 1 + schedule.rest // schedule.sample  # a title, and the samples of the rest

    def complaint(self, log: str) -> str | None:
        lines = [line for line in log.splitlines() if line.strip()]
        return lines[-1] if lines else None

    def write_input(self, case: Case, packing: Packing, run_dir: Path) -> None:
        self._copy_script(run_dir)  # it reads the case and the packing as they are
        shutil.copyfile(self.memory_script, run_dir / INPUTS / self.memory_script.name)

    def read_output(self, case: Case, packing: Packing, run_dir: Path, manifest: dict) -> Dataset:
        schedule = self.schedule(case)
        resistance = _read_samples(run_dir / SAMPLES, case.resolved, schedule, self.name)
        motion = _read_frames(
            run_dir / FRAMES, case.resolved, schedule, len(packing.particles), self.name
        )
        radius_m = packing.particles["radius_m"].to_numpy(dtype=float)
        return Dataset(case.resolved, manifest, radius_m, motion, resistance)


class YadeAveraged(Yade):
    """YADE with the paper's averaged displacement: its own law, and the time step of the paper."""

    name = "yade-averaged"
    cost_s = 2.5e-6
    integration = ("integrator", None)  # always worth saying
    integrator = (
        "integrates by leap-frog with doubled mass and inertia, halved gravity and a memory force that make it the "
        "averaged displacement of Eqs (19)-(24)",
    )


@lru_cache
def _version() -> str:
    """As YADE's configuration module has it; asked in a process of its own, as an import of YADE takes over signals."""
    ask = (
        "import glob, os, shutil, sys; sys.path[1:1] = glob.glob('/usr/lib/*/yade-double/py'); "
        "import yade.config; print('YADE', yade.config.version); "
        "shutil.rmtree(os.path.dirname(yade.O.tmpFilename()))"
    )
    try:
        done = subprocess.run(
            [PYTHON, "-c", ask], capture_output=True, text=True, errors="replace", timeout=120
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise EngineNotFound(f"yade does not say its version: {error}") from error
    found = re.search(r"^YADE (\S+)$", done.stdout, re.MULTILINE)
    if done.returncode or not found:
        raise EngineNotFound(
            "yade is installed but does not start: apt install --reinstall yade python3-yade"
        )
    return found[0]


def _read_samples(path: Path, case: dict, schedule: Schedule, engine: str) -> pd.DataFrame:
    """The table of resistance from the samples at and after the start of the bar."""
    try:
        table = pd.read_csv(StringIO(whole_lines(path)), float_precision="round_trip")[
            list(SAMPLE_COLUMNS)
        ].astype(float)
    except (OSError, ValueError, KeyError) as error:
        raise EngineFailure(f"{engine} left no readable {path.name} ({error})") from error
    return resistance_table(table, case, schedule, engine)


def _read_frames(path: Path, case: dict, schedule: Schedule, particles: int, engine: str) -> Motion:
    """The motion from the binary file whose layout yade_case.py describes."""
    try:
        values = np.fromfile(path)
    except OSError as error:
        raise EngineFailure(f"{engine} left no readable {path.name} ({error.strerror})") from error
    per_frame = 2 + VALUES_PER_PARTICLE * particles
    frames = values.size // per_frame  # less a torn one at the end
    values = values[: frames * per_frame].reshape(frames, per_frame)
    discs = values[:, 2:].reshape(frames, particles, VALUES_PER_PARTICLE)
    return Motion(
        time_s=frame_times(values[:, 0], case, schedule, engine),
        position_m=discs[:, :, 0:2],
        velocity_m_s=discs[:, :, 2:4],
        angular_velocity_rad_s=discs[:, :, 5],
        angle_rad=discs[:, :, 4],
        bar_tip_m=values[:, 1] if "bar" in case else None,
    )
