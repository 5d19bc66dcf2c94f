#!/usr/bin/python3
"""How many instructions the solver needs for one step of one particle, counted by callgrind: unlike times, the same
each time to a few thousandths, however busy the machine.

    PYTHONPATH=. tests/instructions/instructions.py            # prints them
    PYTHONPATH=. tests/instructions/instructions.py --record   # and writes them into recorded.json

Counts build/release, or the program that CROSSDEM_SOLVER names.
"""

from __future__ import annotations

import argparse
import json
import platform
import re
import subprocess
import tempfile
from pathlib import Path

from crossdem.adapters.case import Case, load_case
from crossdem.adapters.native import Native
from crossdem.adapters.packing import Packing, make_packing
from crossdem.adapters.solver import find_solver

ROOT = Path(__file__).resolve().parents[2]
REFERENCE_CASE = ROOT / "reference_cases" / "bar_penetration.toml"
RECORD = Path(__file__).with_name("recorded.json")
RECORD_ANEW = f"PYTHONPATH=. {Path(__file__).relative_to(ROOT)} --record"

# The paper's bed, its bar ten times as fast: contacts are listed so often that what a list costs shows, too.
CHANGES = ("time.rest_s=0", "time.penetration_s=0.1", "bar.speed_m_s=0.1")
# Each with the time step [s] at which its beds rest.
SCHEMES = {"paper": 1e-4, "liggghts": 5e-5, "yade": 5e-5}
# Of two runs, whose difference is neither start-up nor the reading of files.
STEPS = (200, 1000)
# By name, as valgrind emulates no AVX-512, and Highway would choose by what it emulates.
INSTRUCTION_SET = "AVX2"


def built() -> str:
    """What the counts depend on besides the sources: compiler, its flags, and the kind of machine."""
    compiler_and_flags, _, _ = (
        Native().compiler().rpartition(", ")
    )  # last stands what this machine's vectors are
    return f"{compiler_and_flags}, {platform.machine()}"


def count() -> dict[str, float]:
    """Instructions per particle and step, by scheme."""
    with tempfile.TemporaryDirectory(prefix="crossdem-instructions-") as folder:
        packing = make_packing(load_case(REFERENCE_CASE, CHANGES), 1, Path(folder) / "packing")
        return {scheme: _per_particle_step(scheme, packing) for scheme in SCHEMES}


def _per_particle_step(scheme: str, packing: Packing) -> float:
    changes = [*CHANGES, f"scheme.name={scheme}", f"time.step_s={SCHEMES[scheme]}"]
    case = load_case(REFERENCE_CASE, changes)
    few, many = (_instructions(case, packing, steps) for steps in STEPS)
    return (many - few) / (STEPS[1] - STEPS[0]) / len(packing.particles)


def _instructions(case: Case, packing: Packing, steps: int) -> int:
    """Of the whole process, for so many steps."""
    measure = [find_solver(), "measure", "-", "--packing", packing.folder / "packing.csv"]
    options = [f"--steps={steps}", f"--instructions={INSTRUCTION_SET}"]
    callgrind = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    done = subprocess.run(
        [*callgrind, *measure, *options], input=case.canonical, capture_output=True
    )
    said = done.stderr.decode(errors="replace")
    assert done.returncode == 0, said
    return int(re.search(r"Collected : (\d+)", said)[1])


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--record", action="store_true", help=f"write {RECORD.name}")
    chosen = parser.parse_args()
    counted = {scheme: round(number, 1) for scheme, number in count().items()}
    text = json.dumps({"built": built(), "per_particle_step": counted}, indent=2)
    print(text)
    if chosen.record:
        RECORD.write_text(text + "\n")


if __name__ == "__main__":
    main()
