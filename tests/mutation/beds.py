"""The paper's case by a program with a fault, on packings of the sound solver, and what the judge says of it.

A fault is a code of its own: packings are shared, runs are not. The sound runs that it is compared with are of other
twins of the packings, so that a fault that does nothing differs from them by chaos alone and never agrees to the bit.
"""

from __future__ import annotations

import functools
import json
import shutil
import subprocess
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

import pandas as pd
from workshop import ROOT

from crossdem.adapters.case import load_case
from crossdem.adapters.dataset import Dataset, DatasetError
from crossdem.adapters.gates import contacts_at_rest, with_gates
from crossdem.adapters.motion_file import MotionFileError, read_motion
from crossdem.compare.checks import CheckResult, evaluate
from crossdem.compare.ensemble import Ensemble, packing_means
from crossdem.compare.margins import Check

CASE = ROOT / "reference_cases" / "bar_penetration.toml"
MUTANT, SOUND = "mutant", "native"
TWINS = (1, 2)  # of the sound runs
RUN_S = 300  # allowed for one run, which takes about five


class SoundRuns:
    """Runs of the sound solver, as `crossdem run --engines native --twins 2` leaves them below `folder`/runs."""

    def __init__(self, folder: Path):
        self.folders = {}
        for manifest in folder.glob("runs/native-*/manifest.json"):
            about = json.loads(manifest.read_bytes())
            self.folders[about["seed"], about["twin"]] = manifest.parent
        found = {twin: {seed for seed, of in self.folders if of == twin} for twin in (0, *TWINS)}
        self.seeds = sorted(set.intersection(*found.values()))
        self._packings: dict[int, Dataset] = {}
        self._endpoints: dict[int, pd.DataFrame] = {}

    def packing(self, seed: int) -> Dataset:
        """The sound run on the packing as it was settled."""
        if seed not in self._packings:
            self._packings[seed] = Dataset.read(self.folders[seed, 0])
        return self._packings[seed]

    def endpoints(self, seeds: Iterable[int]) -> pd.DataFrame:
        """Of the TWINS of these packings."""
        for seed in set(seeds) - set(self._endpoints):
            twins = (Dataset.read(self.folders[seed, twin]) for twin in TWINS)
            self._endpoints[seed] = Ensemble.of(twins).endpoints
        return pd.concat([self._endpoints[seed] for seed in seeds])


def run(program: Path, sound: SoundRuns, seed: int, folder: Path) -> None:
    """What `program` makes of the case and packing of a sound run, in `folder`, unless it is there already."""
    if (folder / "ending.json").exists():
        return
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(sound.folders[seed, 0] / "inputs", folder / "inputs")
    (folder / "output").mkdir()
    arguments = ["run", "inputs/case.json", "--packing", "inputs/packing.csv", "--output", "output"]
    try:
        done = subprocess.run(
            [program, *arguments], cwd=folder, capture_output=True, text=True, timeout=RUN_S
        )
        ending = {"status": done.returncode, "said": done.stderr.strip().splitlines()[-1:]}
    except subprocess.TimeoutExpired:
        ending = {"status": -1, "said": [f"not done after {RUN_S} s"]}
    (folder / "ending.json").write_text(json.dumps(ending) + "\n")


def read(sound: Dataset, folder: Path) -> Dataset | str:
    """The dataset of a run with its gates, or why there is none."""
    ending = json.loads((folder / "ending.json").read_bytes())
    if ending["status"]:
        return ending["said"][0] if ending["said"] else f"ended with status {ending['status']}"
    try:
        motion, radius_m = read_motion(folder / "output" / "motion.h5")
        resistance = pd.read_csv(folder / "output" / "resistance.csv", float_precision="round_trip")
        manifest = sound.manifest | {"engine": MUTANT}
        found = replace(
            sound, manifest=manifest, radius_m=radius_m, motion=motion, resistance=resistance
        )
    except (OSError, ValueError, MotionFileError, DatasetError) as error:
        return str(error)
    return with_gates(found, contacts_at_rest(sound))


@functools.cache
def checks() -> list[Check]:
    """Those of the case as its file has them now; what is run does not depend on them."""
    return Check.of_case(load_case(CASE).resolved)


def judged(found: pd.DataFrame, sound: pd.DataFrame, seeds: Sequence[int]) -> list[CheckResult]:
    """All checks of the case, mutant against sound; `found` and `sound` are endpoints as Ensemble has them."""
    table = packing_means(pd.concat([found, sound]))
    table = table[table.index.get_level_values("seed").isin(seeds)]
    return evaluate(checks(), (MUTANT, SOUND), table)
