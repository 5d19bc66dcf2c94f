"""LAMMPS with its GRANULAR package: data files for the deck lammps_case.in. It is only timed: nothing reads its output."""

from __future__ import annotations

import shutil
from pathlib import Path

from .case import Case
from .engine import INPUTS, Code, EngineNotFound, unexpressed_options, unexpressed_readings
from .liggghts import ERROR_LINE, NO_MPI_DAEMON, said_version
from .liggghts_input import number, particles
from .packing import Packing
from .schedule import Schedule

# What the deck includes, by whether the case has a bar.
BAR_DECKS = [Path(__file__).with_name(f"lammps_bars_{bars}.in") for bars in (0, 1)]
LACKS = dict.fromkeys(("tensile_strength_N", "rolling_friction"), "is not in its deck")


class Lammps(Code):
    name = "lammps"
    program = "lmp"
    script = Path(__file__).with_name("lammps_case.in")
    cost_s = 1.5e-7

    def executable(self) -> str:
        found = shutil.which("lmp")
        if not found:
            raise EngineNotFound("lmp is not installed: apt install lammps")
        return found

    def version(self) -> str:
        return said_version(self.executable(), "Simulator - (.+)", "LAMMPS", "lammps")

    def environment(self) -> dict[str, str]:
        return super().environment() | NO_MPI_DAEMON

    def schedule(self, case: Case) -> Schedule:
        """At the time step of LIGGGHTS: with its contact law and its integrator, beds rest at the same steps."""
        return Schedule.of(case.resolved, case.step_s("liggghts"))

    def unsupported(self, case: Case) -> list[str]:
        found = [*unexpressed_readings(case), *unexpressed_options(case, LACKS)]
        if case.resolved["scheme"]["attraction"] == "clipped":
            found.append("its dashpots may pull; scheme.attraction = clipped is not in its deck")
        for pair, contact in case.resolved["contact"].items():
            if contact["shear_damping_N_s_m"] > 0 and contact["normal_damping_N_s_m"] == 0:
                found.append(
                    f"it knows shear damping as a multiple of normal damping, which is 0 in contact.{pair}"
                )
        return found

    def command(self, case: Case, run_dir: Path) -> list[str]:
        return [self.program, "-log", "none", "-in", f"{INPUTS}/{self.script.name}"]

    def complaint(self, log: str) -> str | None:
        found = ERROR_LINE.findall(log)
        return found[-1] if found else None

    def write_input(self, case: Case, packing: Packing, run_dir: Path) -> None:
        inputs = run_dir / INPUTS
        self._copy_script(run_dir)
        deck = BAR_DECKS["bar" in case.resolved]
        shutil.copyfile(deck, inputs / deck.name)
        values = _numbers(case.resolved, self.schedule(case), packing)
        lines = [f"variable {name} string {number(value)}\n" for name, value in values.items()]
        (inputs / "numbers.in").write_text("".join(lines), encoding="ascii")
        # As thin as may be: LAMMPS keeps bins for all of the domain's depth, also of one plane of discs.
        half_depth_m = float(packing.particles["radius_m"].max())
        discs = particles(case.resolved, packing, half_depth_m)
        (inputs / "particles.data").write_text(discs, encoding="ascii")


def _numbers(case: dict, schedule: Schedule, packing: Packing) -> dict[str, float | int]:
    """The numbers of the case; SI units, names as the deck uses them."""
    found = {
        "step_s": schedule.step_s,
        "steps": schedule.steps,
        "rest_steps": schedule.rest,
        "gravity": case["gravity_m_s2"],
        "width_m": case["container"]["width_m"],
        "density_per_area": case["particles"]["density_kg_m3"] * case["container"]["thickness_m"],
        "skin_m": 0.5 * float(packing.particles["radius_m"].min()),
        "bars": int("bar" in case),
    }
    for suffix, pair in (("particle", "particle_particle"), ("wall", "particle_wall")):
        contact = case["contact"][pair]
        normal, shear = contact["normal_damping_N_s_m"], contact["shear_damping_N_s_m"]
        found[f"kn_{suffix}"] = contact["normal_stiffness_N_m"]
        found[f"kt_{suffix}"] = contact["shear_stiffness_N_m"]
        found[f"gamman_{suffix}"] = normal
        found[f"gammat_share_{suffix}"] = shear / normal if normal else 0.0
        found[f"friction_{suffix}"] = contact["friction"]
    if "bar" in case:
        bar = case["bar"]
        found |= {
            "speed": bar["speed_m_s"],
            "bar_left_m": bar["centre_x_m"] - bar["width_m"] / 2,
            "bar_right_m": bar["centre_x_m"] + bar["width_m"] / 2,
            "bar_tip_m": packing.bar_tip_m,
            "bar_top_m": packing.bar_tip_m + bar["length_m"],
        }
    return found
