"""A gas of 20000 discs, by every scheme, on 2 and 4 threads, in a solver that is built under the thread sanitizer.

usage: tsan_bed.py SOLVER
Ends with 1 and the sanitizer's words when it reports a race.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SMALL_BED = Path(__file__).parents[1] / "solver" / "small_bed.json"
SCHEMES = ("paper", "liggghts", "yade", "liggghts_averaged", "yade_averaged")
THREADS = (2, 4)  # a thread is given at least 4096 discs
ROWS, COLUMNS = 100, 200
SPACING_M, DIAMETER_M = 0.0051, 0.005
STEPS = 300


def write(folder: Path) -> None:
    """The case in each scheme, and a packing whose neighbours soon touch, as every row slides over the one below."""
    case = json.loads(SMALL_BED.read_text(encoding="utf-8"))
    del case["bar"], case["packing"]
    case["container"] |= {"width_m": COLUMNS * SPACING_M, "height_m": 2 * ROWS * SPACING_M}
    case["particles"] |= {
        "count": ROWS * COLUMNS,
        "diameters_m": [DIAMETER_M],
        "number_shares": [1.0],
    }
    for scheme in SCHEMES:
        (folder / f"{scheme}.json").write_text(json.dumps(case | {"scheme": {"name": scheme}}))
    rows = ["id,x_m,y_m,radius_m,velocity_x_m_s,velocity_y_m_s,angular_velocity_rad_s"]
    for number in range(ROWS * COLUMNS):
        row, column = divmod(number, COLUMNS)
        place = f"{(column + 0.5) * SPACING_M!r},{(row + 0.5) * SPACING_M!r}"
        velocity = f"{0.1 * (-1) ** row!r},{0.1 * (-1) ** column!r}"
        rows.append(f"{number},{place},{DIAMETER_M / 2!r},{velocity},0")
    (folder / "packing.csv").write_text("\n".join([*rows, ""]))
    facts = {"seed": 1, "bar_tip_m": None, "contacts": 0, "particles": ROWS * COLUMNS}
    facts |= {"kinetic_energy_J": 0.0, "bed_height_m": 0.5, "settling_s": 0.0}
    (folder / "packing.json").write_text(json.dumps(facts))


def main(solver: str) -> int:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write(folder)
        for scheme in SCHEMES:
            for threads in THREADS:
                command = [solver, "measure", folder / f"{scheme}.json", f"--threads={threads}"]
                command += [f"--packing={folder / 'packing.csv'}", f"--steps={STEPS}"]
                done = subprocess.run(
                    command,
                    capture_output=True,
                    text=True,
                    env=os.environ | {"TSAN_OPTIONS": "halt_on_error=1"},
                )
                if done.returncode:
                    print(f"{scheme}, {threads} threads:\n{done.stderr}", file=sys.stderr)
                    return 1
                print(f"{scheme}, {threads} threads: no race in {done.stdout.strip()}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
