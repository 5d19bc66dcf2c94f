"""Faults to seed in a copy of the native solver, and the program that comes of each: does the ladder notice?"""

from __future__ import annotations

import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MICRO = ROOT / "reference_cases" / "micro"


@dataclass(frozen=True)
class Fault:
    """One text of the sources, which stands there once, and the wrong one in its place."""

    name: str
    file: str  # below solver/src
    right: str
    wrong: str


# The formulas of the paper's scheme, each in the one place where it stands.
FAULTS = (
    Fault(
        "torque arm to the contact point",
        "step.hpp",
        "readings.torque_arm == TorqueArm::radius ?",
        "readings.torque_arm == TorqueArm::contact_point ?",
    ),
    Fault(
        "history lost with the neighbour list",
        "contacts.hpp",
        "contact.memory = old_contact->memory;",
        "contact.memory = {};",
    ),
    Fault(
        "slip cap from the total normal force",
        "laws/tanaka.hpp",
        "readings.slip_cap == SlipCap::spring ?",
        "readings.slip_cap == SlipCap::total ?",
    ),
    Fault("inertia of a sphere", "state.cpp", "inertia.push_back(0.5 *", "inertia.push_back(0.4 *"),
    Fault(
        "half the damping at walls",
        "simulation.cpp",
        ".particle_wall = setup.particle_wall,",
        ".particle_wall = [p = setup.particle_wall]() mutable { p.normal_damping /= 2; return p; }(),",
    ),
    Fault(
        "spin of the wrong sign at walls",
        "step.hpp",
        "displacement(contact.surface), arm_i * p_.rotation[i]",
        "displacement(contact.surface), -arm_i * p_.rotation[i]",
    ),
    Fault(
        "tangent of the friction coefficient",
        "laws/tanaka.hpp",
        "p.friction * (",
        "std::tan(p.friction) * (",
    ),
)


class Workshop:
    """A copy of the solver's sources in `folder`, and a build of it."""

    def __init__(self, folder: Path):
        self.sources, self.build = folder / "sources", folder / "build"
        shutil.copytree(ROOT / "solver", self.sources / "solver")
        shutil.copyfile(ROOT / "CMakeLists.txt", self.sources / "CMakeLists.txt")
        flags = ["-DBUILD_TESTING=OFF", "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O1"]
        _quietly("cmake", "-S", self.sources, "-B", self.build, *flags)

    def solver(self, fault: Fault | None = None) -> Path:
        """The program with this fault and no other, built in about two seconds after the first."""
        if fault is None:
            return self._program()
        file = self.sources / "solver" / "src" / fault.file
        sound = file.read_text()
        assert sound.count(fault.right) == 1, f"{fault.file} holds {fault.right!r} not just once"
        try:
            file.write_text(sound.replace(fault.right, fault.wrong))
            return self._program()
        finally:
            file.write_text(sound)

    def _program(self) -> Path:
        _quietly("cmake", "--build", self.build, "--target", "crossdem-solver", "--parallel", "2")
        return self.build / "solver" / "crossdem-solver"


def _quietly(*command) -> None:
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def climb(solver: Path, out_dir: Path, ladder: Path = MICRO) -> subprocess.CompletedProcess:
    """`crossdem check` of the reference cases with a known answer, by this native solver alone."""
    return subprocess.run(
        [ROOT / "crossdem", "check", ladder, "--engines=native", f"--out={out_dir / 'out'}"],
        env={**os.environ, "CROSSDEM_SOLVER": str(solver)},
        capture_output=True,
        text=True,
        timeout=600,
    )
