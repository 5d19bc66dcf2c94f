"""The detection matrix as a page in Markdown."""

from __future__ import annotations

import pandas as pd
from detection import OUTCOME, caught_by, endpoints_of
from escapes import UNSEEN_BY_LADDER

from crossdem.compare.checks import DIFFERENT, EQUIVALENT
from crossdem.compare.quantities import QUANTITIES
from crossdem.compare.wording import MINUS

HEAD = """\
# What the layers notice

Each row is the native solver with one fault in its sources. The faults live in
[tests/mutation/faults.py](../tests/mutation/faults.py); the product holds none of them.
Two layers look for them:

- **Ladder**: `crossdem check reference_cases/micro`, {rungs} on cases of 1 to 24 discs. Each run is held against the
  paper's scheme written a second time, and against closed forms. The closed forms are counted apart, since they are all
  that a code without a twin has.
- **Ensemble**: the paper's case on {packings} packings of the sound solver. The judge compares the fault's runs with sound
  runs of two other twins of the same packings, as two codes. A run that fails and a gate that fails count as noticed.
  **Smoke** is the same on 4 packings.

![heat map of faults and endpoints](detection.png)

Colour: dark is different, middle is inconclusive, light is equivalent. Numbers: difference to the sound solver in margins.

What only the twin sees of the ladder vanishes with the time step, or has no effect on one or two discs. What the ensemble
misses is smaller than the margins, or than what so many packings can tell.

| noticed by | faults |
|---|---|
"""
FOOT = """
Made by [tests/mutation/detection_matrix.py](../tests/mutation/detection_matrix.py) from [detection.csv](detection.csv),
which holds the differences too. `scripts/nightly` repeats the ladder for every fault, and the ensemble on 4 packings.
"""


def page(table: pd.DataFrame) -> str:
    faults = table[table["fault"] != "no fault"]
    layers = {row["fault"]: caught_by(row) for _, row in faults.iterrows()}
    sound = table[table["fault"] == "no fault"].iloc[0]
    return "\n".join(
        [
            HEAD.format(
                packings=int(table["packings"].max()), rungs=f"{int(table['rungs'].max())} rungs"
            ).rstrip("\n"),
            *_counts(layers),
            "",
            _sound(sound, endpoints_of(table)),
            "",
            *_rows(faults, layers),
            "",
            "## What is missed",
            "",
            *_missed(faults, layers),
            FOOT,
        ]
    )


def _counts(layers: dict[str, list[str]]) -> list[str]:
    of = len(layers)
    lines = [
        f"| {title} | {sum(layer in found for found in layers.values())} of {of} |"
        for layer, title in (
            ("ladder", "ladder"),
            ("closed forms", "its closed forms alone"),
            ("ensemble", "ensemble"),
            ("smoke", "smoke tier alone"),
        )
    ]
    either = sum(bool(found) for found in layers.values())
    return [*lines, f"| ladder or ensemble | {either} of {of} |"]


def _sound(row: pd.Series, endpoints: list[str]) -> str:
    outcomes = [row[name + OUTCOME] for name in endpoints]
    return (
        f"The sound solver, built and run the same way: ladder {row['ladder']}; of {len(outcomes)} endpoints "
        f"{outcomes.count(DIFFERENT)} different, {outcomes.count(EQUIVALENT)} equivalent, "
        f"{len(outcomes) - outcomes.count(DIFFERENT) - outcomes.count(EQUIVALENT)} undecided."
    )


def _rows(faults: pd.DataFrame, layers: dict[str, list[str]]) -> list[str]:
    titles = (
        "fault",
        "class",
        "ladder: first rung",
        "cases",
        "rungs",
        "closed forms",
        "ensemble: different",
        "smoke",
        "noticed by",
    )
    lines = [f"| {' | '.join(titles)} |", "|" + "---|" * len(titles)]
    for _, row in faults.iterrows():
        cells = (
            row["fault"],
            row["kind"],
            row["first_rung"] or ("no result" if row["ladder"] == "caught" else "holds"),
            int(row["cases_failing"]),
            int(row["rungs_failing"]),
            int(row["answers_failing"]),
            _ensemble(row),
            "yes" if row["smoke"] else "no",
            ", ".join(layers[row["fault"]]) or "**nothing**",
        )
        lines.append("| " + " | ".join(str(cell).replace("|", "/") for cell in cells) + " |")
    return lines


def _ensemble(row: pd.Series) -> str:
    said = []
    if row["runs_failed"]:
        said.append(f"{int(row['runs_failed'])} of {int(row['packings'])} runs fail")
    if row["gates_failed"]:
        said.append(f"gate {row['gate']} fails in {int(row['gates_failed'])}")
    said += [QUANTITIES[name].title for name in row["different"].split("; ") if name]
    return ", ".join(said) or "nothing"


def _missed(faults: pd.DataFrame, layers: dict[str, list[str]]) -> list[str]:
    reasons = {
        "ladder": lambda row: UNSEEN_BY_LADDER.get(row["fault"], "**no reason is known**"),
        "closed forms": lambda _: "only the twin tells",
        "ensemble": _too_small,
    }
    lines = []
    for layer, reason in reasons.items():
        rows = [row for _, row in faults.iterrows() if layer not in layers[row["fault"]]]
        lines += [f"By the {layer}:" if rows else f"By the {layer}: nothing.", ""]
        lines += [f"- {row['fault']}: {reason(row)}" for row in rows]
        lines += [""] if rows else []
    return lines[:-1] if lines[-1] == "" else lines


def _too_small(row: pd.Series) -> str:
    """How large the differences are that the ensemble did not call different."""
    values = {name: row[name] for name in QUANTITIES if name in row and pd.notna(row[name])}
    largest = max(values, key=lambda name: abs(values[name]))
    same = sum(row[name + OUTCOME] == EQUIVALENT for name in values)
    effect = f"{values[largest]:+.2f} margins of {QUANTITIES[largest].title} at most"
    return f"{effect}; {same} of {len(values)} endpoints equivalent".replace("-", MINUS)
