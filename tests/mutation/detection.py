"""What each layer says of each fault, as one row of a table."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pandas as pd
from beds import SoundRuns, judged, read, run
from ladder import Climb, name_of

from crossdem.compare.checks import DIFFERENT
from crossdem.compare.ensemble import Ensemble
from crossdem.compare.quantities import QUANTITIES

SMOKE = 4  # packings of that tier
OUTCOME = " outcome"  # after the name of a quantity: of its check


def ladder_row(climbed: Climb) -> dict:
    failing, answers = climbed.failing, climbed.failing_answers
    return {
        "ladder": "caught" if climbed.caught else "holds",
        "first_rung": name_of(failing[0]) if failing else "",
        "cases_failing": len({rung["case"] for rung in failing}),
        "rungs": len(climbed.rungs),
        "rungs_failing": len(failing),
        "first_answer": name_of(answers[0]) if answers else "",
        "answers_failing": len(answers),
    }


def bed_row(program: Path, sound: SoundRuns, seeds: list[int], folder: Path, jobs: int = 1) -> dict:
    """Runs what is not in `folder` yet, `jobs` at a time.

    Numbers are differences mutant - sound in margins, of the runs that came to an end; whether these may be compared is
    for the columns runs_failed and gates_failed to say.
    """
    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(lambda seed: run(program, sound, seed, folder / f"seed{seed}"), seeds))
    datasets, failures, gates = {}, {}, {}
    for seed in seeds:
        found = read(sound.packing(seed), folder / f"seed{seed}")
        if isinstance(found, str):
            failures[seed] = found
        else:
            datasets[seed] = found
            failed = [gate["name"] for gate in found.manifest["gates"] if not gate["passed"]]
            gates |= {seed: failed} if failed else {}
    row = {
        "packings": len(seeds),
        "runs_failed": len(failures),
        "gates_failed": len(gates),
        "said": next(iter(failures.values()), ""),
        "gate": ", ".join(sorted({name for names in gates.values() for name in names})),
        "different": "",
        "smoke": "",
    }
    if not datasets:
        return row | {"smoke": "runs fail"}
    endpoints = Ensemble.of(datasets.values()).endpoints
    results = judged(endpoints, sound.endpoints(seeds), seeds)
    alarms = judged(endpoints, sound.endpoints(seeds), [s for s in seeds if s <= SMOKE])
    row["different"] = _different(results)
    row["smoke"] = "; ".join(
        filter(
            None,
            [
                "runs fail" * any(seed <= SMOKE for seed in failures),
                "gates" * any(seed <= SMOKE for seed in gates),
                _different(alarms),
            ],
        )
    )
    for result in results:
        name = result.check.quantity.name
        row[name] = round(result.difference / result.margin, 3)
        row[name + OUTCOME] = result.outcome
    return row


def caught_by(row: pd.Series) -> list[str]:
    """The layers that notice; none: the fault escapes."""
    layers = {
        "ladder": row["ladder"] == "caught",
        "closed forms": row["answers_failing"] > 0,
        "ensemble": row["runs_failed"] > 0 or row["gates_failed"] > 0 or bool(row["different"]),
        "smoke": bool(row["smoke"]),
    }
    return [layer for layer, notices in layers.items() if notices]


def endpoints_of(table: pd.DataFrame) -> list[str]:
    """The quantities that the table has a difference of."""
    return [name for name in QUANTITIES if name in table]


def _different(results) -> str:
    return "; ".join(r.check.quantity.name for r in results if r.outcome == DIFFERENT)
