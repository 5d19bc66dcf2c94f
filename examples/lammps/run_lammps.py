"""Has LAMMPS run a case of crossdem: the program that lammps.toml names. It knows nothing of crossdem but the contract.

usage: run_lammps.py --case case.json --packing packing.csv --step-s SECONDS --out DIR
       run_lammps.py --version

To be started in the folder that holds inputs/ (with the decks) and DIR, which must be output/, as the deck names them.
Only numbers of the case reach the deck. Ends with 77 and a reason for a case that the deck cannot express.
"""

import argparse
import csv
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

CANNOT = 77
INPUTS = Path("inputs")
DECK = INPUTS / "lammps_case.in"
FRAME_HEAD_LINES = 9
SAMPLE_VALUES = 8
RESISTANCE = (
    *("time_s", "depth_m", "force_x_N", "force_y_N", "tip_force_y_N", "shaft_force_y_N"),
    *("floor_force_y_N", "contacts", "kinetic_energy_J"),
)
MOTION = (
    *("time_s", "id", "x_m", "y_m", "velocity_x_m_s", "velocity_y_m_s"),
    "angular_velocity_rad_s",
)
# Open MPI would start a daemon beside a single process, and that opens TCP ports on every interface.
NO_MPI_DAEMON = {
    "OMPI_MCA_ess_singleton_isolated": "1",
    "OMPI_MCA_btl": "self",
    "OMPI_MCA_pml": "ob1",
    "OMP_NUM_THREADS": "1",
}


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--version", action="store_true")
    for name in ("--case", "--packing", "--out"):
        arguments.add_argument(name, type=Path)
    arguments.add_argument("--step-s", type=float)
    given = arguments.parse_args()
    version = lammps_version()
    if given.version:
        print(version)
        return 0
    case = json.loads(given.case.read_text(encoding="utf-8"))
    if reason := what_is_lacking(case):
        print(reason)
        return CANNOT
    discs = read_packing(given.packing)
    about = json.loads(given.packing.with_suffix(".json").read_text(encoding="utf-8"))
    schedule = Schedule(case["time"], given.step_s)
    write_numbers(case, schedule, discs, about["bar_tip_m"])
    write_discs(case, discs, about["bar_tip_m"])
    if status := run_deck(case, schedule, given.out):
        return status
    frames = convert_frames(schedule, len(discs), given.out)
    said = {
        "completed": frames == schedule.frames,
        "frames": frames,
        "particles": len(discs),
        "engine": "lammps",
        "version": version,
    }
    (given.out / "run.json").write_text(json.dumps(said) + "\n", encoding="utf-8")
    return 0


class Schedule:
    """A run in whole time steps. The bar starts at a step that is a multiple of both intervals, as output comes there."""

    def __init__(self, time, step_s):
        self.step_s = step_s
        self.sample_s, self.frame_s = time["sample_interval_s"], time["frame_interval_s"]
        self.rest, self.penetration = (
            round(time[key] / step_s) for key in ("rest_s", "penetration_s")
        )
        self.sample, self.frame = round(self.sample_s / step_s), round(self.frame_s / step_s)
        common = math.lcm(self.sample, self.frame)
        self.start = -(-self.rest // common) * common
        self.frames = self.penetration // self.frame + 1


def what_is_lacking(case):
    """Why LAMMPS with this deck does not compute what the case asks for; empty if it does."""
    scheme = case["scheme"]
    if "bar" in case and scheme["bar_corner"] == "faces_only":
        return "its bar always has corners; scheme.bar_corner = faces_only is not in its deck"
    if scheme["inertia"] == "sphere":
        return "its particles are discs; scheme.inertia = sphere is not in its deck"
    if scheme["attraction"] == "clipped":
        return "its dashpots may pull; scheme.attraction = clipped is not in its deck"
    for pair, contact in case["contact"].items():
        for key in ("tensile_strength_N", "rolling_friction"):
            if contact.get(key):
                return f"contact.{pair}.{key} is not in its deck"
        normal, shear = contact["normal_damping_N_s_m"], contact["shear_damping_N_s_m"]
        if shear > 0 and (normal == 0 or math.isinf(shear / normal)):
            return f"it knows shear damping as a multiple of normal damping, which is too small in contact.{pair}"
    return ""


def read_packing(path):
    with open(path, newline="", encoding="ascii") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def number(value):
    """The only text that reaches the deck."""
    if not math.isfinite(value):
        raise ValueError(f"{value!r} is not a finite number")
    return str(value) if isinstance(value, int) else format(value, ".17g")


def write_numbers(case, schedule, discs, bar_tip_m):
    """inputs/numbers.in: the numbers of the case, as the deck names them."""
    found = {
        "step_s": schedule.step_s,
        "first_step": schedule.start - schedule.rest,
        "start_step": schedule.start,
        "rest_steps": schedule.rest,
        "penetration_steps": schedule.penetration,
        "sample_steps": schedule.sample,
        "frame_steps": schedule.frame,
        "gravity": case["gravity_m_s2"],
        "width_m": case["container"]["width_m"],
        "density_per_area": case["particles"]["density_kg_m3"] * case["container"]["thickness_m"],
        "skin_m": 0.5 * min(disc["radius_m"] for disc in discs),
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
            "bar_tip_m": bar_tip_m,
            "bar_top_m": bar_tip_m + bar["length_m"],
        }
    lines = [f"variable {name} string {number(value)}\n" for name, value in found.items()]
    (INPUTS / "numbers.in").write_text("".join(lines), encoding="ascii")


def write_discs(case, discs, bar_tip_m):
    """inputs/particles.data: the discs, in a domain with room for wherever they may fly."""
    width_m, height_m = case["container"]["width_m"], case["container"]["height_m"]
    gravity, time = case["gravity_m_s2"], case["time"]
    duration_s = time["rest_s"] + time["penetration_s"]

    def rise_m(disc):
        speed = max(0.0, disc["velocity_y_m_s"])
        ballistic_m = speed**2 / (2 * gravity) if gravity > 0 else math.inf
        return min(speed * duration_s, ballistic_m)

    top_m = max(disc["y_m"] + disc["radius_m"] + rise_m(disc) for disc in discs)
    if "bar" in case:
        top_m = max(top_m, bar_tip_m + case["bar"]["length_m"])
    # As thin as may be: LAMMPS keeps bins for all of the domain's depth, also of one plane of discs.
    half_depth_m = max(disc["radius_m"] for disc in discs)
    margin_m = 0.1 * width_m
    lines = [
        "discs of the packing",
        "",
        f"{len(discs)} atoms",
        "1 atom types",
        f"{number(-margin_m)} {number(width_m + margin_m)} xlo xhi",
        f"{number(-margin_m)} {number(top_m + height_m)} ylo yhi",
        f"{number(-half_depth_m)} {number(half_depth_m)} zlo zhi",
        *("", "Atoms", ""),
    ]
    for disc in discs:  # the deck sets the density, by area
        place = f"{number(disc['x_m'])} {number(disc['y_m'])} 0"
        lines.append(f"{int(disc['id']) + 1} 1 {number(2 * disc['radius_m'])} 1 {place}")
    lines += ["", "Velocities", ""]
    for disc in discs:
        velocity = f"{number(disc['velocity_x_m_s'])} {number(disc['velocity_y_m_s'])} 0"
        spin = number(disc["angular_velocity_rad_s"])
        lines.append(f"{int(disc['id']) + 1} {velocity} 0 0 {spin}")
    (INPUTS / "particles.data").write_text("\n".join([*lines, ""]), encoding="ascii")


def run_deck(case, schedule, out):
    """Runs LAMMPS, passes on what it says, and writes resistance.csv while it does. Returns its exit status."""
    speed_m_s = case["bar"]["speed_m_s"] if "bar" in case else 0.0
    process = subprocess.Popen(
        [lammps(), "-log", "none", "-in", str(DECK)],
        env=os.environ | NO_MPI_DAEMON | {"OMPI_MCA_orte_tmpdir_base": str(out)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )
    signal.signal(signal.SIGTERM, lambda *_: process.terminate())
    failed, sampling, samples = "", False, 0
    with open(out / "resistance.csv", "w", encoding="ascii") as table:
        print(*RESISTANCE, sep=",", file=table, flush=True)
        for line in process.stdout:
            words = line.split()
            if line.startswith("ERROR"):
                failed = line.strip()
            if sampling and len(words) == SAMPLE_VALUES and words[0].isdigit():
                if int(words[0]) != schedule.start + samples * schedule.sample:
                    continue  # LAMMPS prints its last step, whatever it is told
                time_s = samples * schedule.sample_s
                *forces, contacts, energy = words[1:]
                values = (repr(time_s), repr(speed_m_s * time_s), *forces, contacts, energy)
                print(*values, sep=",", file=table, flush=True)
                samples += 1
            else:
                print(line, end="", flush=True)
            sampling = sampling or line.strip() == "samples"
    status = process.wait()
    if failed:
        print(re.sub(r"^ERROR[^:]*: |\s*\([\w./]+:\d+\)$", "", failed))
    return status if status >= 0 else 128 - status


def convert_frames(schedule, particles, out):
    """From output/frames.txt to motion.csv; returns how many whole frames there were."""
    frames = 0
    with open(out / "frames.txt", encoding="ascii") as source, open(
        out / "motion.csv", "w", encoding="ascii"
    ) as table:
        print(*MOTION, sep=",", file=table)
        while True:
            head = [source.readline() for _ in range(FRAME_HEAD_LINES)]
            rows = [source.readline() for _ in range(particles)]
            if (
                not rows[-1].endswith("\n")
                or int(head[1]) != schedule.start + frames * schedule.frame
            ):
                return frames
            time_s = repr(frames * schedule.frame_s)
            for row in rows:
                name, *values = row.split()
                print(time_s, int(name) - 1, *values, sep=",", file=table)
            frames += 1


def lammps():
    found = shutil.which("lmp")
    if not found:
        sys.exit("lmp is not installed: apt install lammps")
    return found


def lammps_version():
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | NO_MPI_DAEMON | {"OMPI_MCA_orte_tmpdir_base": folder}
        asked = [lammps(), "-log", "none", "-h"]
        said = subprocess.run(asked, env=environment, cwd=folder, capture_output=True, text=True)
    found = re.search("Simulator - (.+)", said.stdout)
    if not found:
        sys.exit("lmp does not say its version; is it LAMMPS? (apt install lammps)")
    return f"LAMMPS {found[1].strip()}"


if __name__ == "__main__":
    sys.exit(main())
