#!/usr/bin/python3
"""Which layer notices which fault: docs/detection.csv, .md and .png, made anew.

    PYTHONPATH=. tests/mutation/detection_matrix.py --packings 16 --work /somewhere/with/space

Needs CMake, a compiler and about two hours of one core: every fault is built, climbs the ladder and runs the paper's
case on each packing. What is in the work folder already is not done again, so that it goes on where it was stopped;
give it a new one after a change of the solver, the cases or the faults. `--pages` only draws docs/detection.csv anew.
"""

from __future__ import annotations

import argparse
import json
import subprocess
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path

import pandas as pd
from beds import CASE, TWINS, SoundRuns
from detection import bed_row, ladder_row
from detection_figure import figure
from detection_page import page
from faults import FAULTS
from ladder import Climb, climb
from workshop import ROOT, Fault, Workshop

DOCS = ROOT / "docs"
SOUND = Fault("no fault", "sound", "", "", "")


def sound_runs(folder: Path, packings: int) -> SoundRuns:
    """Runs of the solver of this checkout, in `folder`, made unless they are there."""
    options = [f"--seeds={packings}", f"--twins={max(TWINS)}", f"--out={folder}"]
    subprocess.run([ROOT / "crossdem", "run", CASE, "--engines=native", *options], check=True)
    return SoundRuns(folder)


def climbed(program: Path, folder: Path) -> Climb:
    """As ladder.climb, unless `folder` holds it."""
    kept = folder / "climb.json"
    if not kept.exists():
        folder.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(asdict(climb(program, folder / "out"))))
    return Climb(**json.loads(kept.read_bytes()))


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--packings", type=int, default=16)
    parser.add_argument("--work", type=Path, default=ROOT / "results" / "detection")
    parser.add_argument("--sound", type=Path, help="sound runs that are there, with twins 1 and 2")
    parser.add_argument("--docs", type=Path, default=DOCS, help="where the three files go")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--pages", action="store_true")
    chosen = parser.parse_args()
    if not chosen.pages:
        table = matrix(chosen.work, chosen.sound, chosen.packings, chosen.jobs)
        chosen.docs.mkdir(parents=True, exist_ok=True)
        table.to_csv(chosen.docs / "detection.csv", index=False)
    table = read_table(chosen.docs)
    (chosen.docs / "detection.md").write_text(page(table), encoding="utf-8")
    (chosen.docs / "detection.png").write_bytes(figure(table))


def matrix(work: Path, sound: Path | None, packings: int, jobs: int) -> pd.DataFrame:
    """A row for each fault, and one for the sound solver built the same way."""
    work.mkdir(parents=True, exist_ok=True)
    runs = SoundRuns(sound) if sound else sound_runs(work / "sound", packings)
    seeds = runs.seeds[:packings]
    workshop = Workshop(work / "workshop")
    rows = []
    with ThreadPoolExecutor(jobs) as pool:
        waiting = []
        for fault in (SOUND, *FAULTS):
            program = workshop.solver(None if fault is SOUND else fault)
            waiting.append(pool.submit(row_of, fault, program, runs, seeds, work))
        rows = [one.result() for one in waiting]
    return pd.DataFrame(rows)


def row_of(fault: Fault, program: Path, runs: SoundRuns, seeds: list[int], work: Path) -> dict:
    ladder = ladder_row(climbed(program, work / "ladder" / fault.slug))
    beds = bed_row(program, runs, seeds, work / "beds" / fault.slug)
    print(
        f"{fault.name}: {ladder['ladder']} {ladder['first_rung']}; {beds['different']}", flush=True
    )
    return {"fault": fault.name, "kind": fault.kind, **ladder, **beds}


def read_table(folder: Path = DOCS) -> pd.DataFrame:
    """detection.csv; texts that are missing are empty."""
    table = pd.read_csv(folder / "detection.csv")
    texts = table.select_dtypes("object").columns
    return table.astype({name: object for name in texts}).fillna({name: "" for name in texts})


if __name__ == "__main__":
    main()
