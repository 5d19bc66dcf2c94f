"""The paper's whole case for two seconds: the same bits from every set of instructions, number of threads and compiler."""

import hashlib
import os
import re
import subprocess
from pathlib import Path

import h5py
import pytest

from crossdem.adapters.case import load_case

ROOT = Path(__file__).parents[2]
SOLVER = os.environ.get("CROSSDEM_SOLVER", "")

# Of the bed, the resistance and the motion. When bits change on purpose, the recorded runs change with this line.
EXPECTED = "1cfed0f20785d416f231f2cbe9f17dbefd924eedeeee74afa3862eb9712aaf22"


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    shortened = ("time.rest_s=0.5", "time.penetration_s=1.5")
    case = load_case(ROOT / "reference_cases" / "bar_penetration.toml", shortened)
    file = tmp_path_factory.mktemp("case") / "case.json"
    file.write_bytes(case.canonical)
    return file


def digest(solver, case, folder, *options):
    """Of what `solver` makes of the case, from its own bed on."""
    bed, run = folder / "bed", folder / "run"
    for command in (["pack"], ["run", "--packing", bed / "packing.csv"]):
        output = bed if command == ["pack"] else run
        call = [solver, command[0], case, "--output", output, *command[1:], *options]
        subprocess.run(call, check=True)
    found = hashlib.sha256()
    for table in (bed / "packing.csv", run / "resistance.csv", run / "ledger.csv"):
        found.update(table.read_bytes())
    with h5py.File(run / "motion.h5") as file:

        def add(name, item):
            if isinstance(item, h5py.Dataset) and item.dtype.kind == "f":
                found.update(item[()].tobytes())

        file.visititems(add)
    return found.hexdigest()


def instruction_sets():
    """Those of this machine, as the solver names them where it is asked for one it has not."""
    call = [SOLVER, "measure", "-", "--packing=-", "--instructions=none"]
    said = subprocess.run(call, capture_output=True, text=True, check=False).stderr
    return re.search(r"\{(.+?)\}", said)[1].split(",")


def test_every_set_of_instructions(case, tmp_path):
    found = {
        name: digest(SOLVER, case, tmp_path / name, "--instructions", name)
        for name in instruction_sets()
    }
    assert len(found) >= 3, "the baseline, one between and the widest"
    assert set(found.values()) == {EXPECTED}, found


@pytest.mark.parametrize("threads", [2, 4])
def test_any_number_of_threads(threads, case, tmp_path):
    assert digest(SOLVER, case, tmp_path, "--threads", str(threads)) == EXPECTED


def test_another_compiler(case, tmp_path):
    """Built by clang as users build it."""
    build = tmp_path / "build"
    configure = [
        "cmake",
        "-S",
        ROOT,
        "-B",
        build,
        "-DCMAKE_BUILD_TYPE=Release",
        "-DBUILD_TESTING=OFF",
    ]
    subprocess.run(
        [*configure, "-DCMAKE_CXX_COMPILER=clang++"], check=True, stdout=subprocess.DEVNULL
    )
    make = ["cmake", "--build", build, "--target", "crossdem-solver", "--parallel", "2"]
    subprocess.run(make, check=True, stdout=subprocess.DEVNULL)
    assert digest(build / "solver" / "crossdem-solver", case, tmp_path) == EXPECTED
