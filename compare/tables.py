"""The report's tables and numbers as rows of text: what the page, the Markdown and the terminal show alike."""

from __future__ import annotations

import math
from collections import Counter
from typing import NamedTuple

import pandas as pd

from . import resistance, wording
from .checks import DIFFERENT, EQUIVALENT, INCONCLUSIVE, NOT_COMPARABLE, CheckResult, by_check
from .comparison import Comparison
from .quantities import QUANTITIES
from .verdict import seeds_text

DASH = "\N{EN DASH}"
WORST_FIRST = (DIFFERENT, NOT_COMPARABLE, INCONCLUSIVE, EQUIVALENT)


class Headline(NamedTuple):
    """One of the three numbers that matter."""

    value: str
    label: str
    note: str


class CheckRow(NamedTuple):
    """One check of one pair."""

    pair: str
    values: str
    difference: str
    interval: str
    p: str  # after Holm
    outcome: str
    packings: str  # that both have, of those that a statement of equivalence needs
    explanation: str


class CheckBlock(NamedTuple):
    """One check with its rows for all pairs."""

    title: str
    margin: str
    reason: str
    rows: list[CheckRow]


def headlines(comparison: Comparison) -> list[Headline]:
    """Mean resistance, its largest difference between two engines, and the packings behind the verdict."""
    quantity = QUANTITIES["mean_resistance_N"]
    means = _means(comparison)[quantity.name]
    by_engine = ", ".join(
        f"{engine} {wording.number(value)}" for engine, value in means.items() if value == value
    )
    span = DASH
    if means.notna().any():
        ends = dict.fromkeys(wording.number(end) for end in (means.min(), means.max()))
        span = f"{' to '.join(ends)} {quantity.unit}"
    verdict = comparison.verdict
    bar, time = comparison.case.resolved["bar"], comparison.case.resolved["time"]
    deepest_cm = 100 * bar["speed_m_s"] * time["penetration_s"]
    window = f"mean resistance from {resistance.DEEP_FROM * deepest_cm:.3g} to {deepest_cm:.3g} cm"
    return [
        Headline(span, window, by_engine or "no run finished"),
        _largest_difference(comparison),
        Headline(
            wording.packings(
                verdict.seeds if comparison.results else len(comparison.seeds),
                comparison.ensemble.runs_each,
            ),
            "behind this verdict",
            _needed(comparison),
        ),
    ]


def _needed(comparison: Comparison) -> str:
    if not comparison.results:
        return "no pair was checked"
    if all(result.outcome != INCONCLUSIVE for result in comparison.results):
        return "no check is open"
    return f"if the engines are equal, the open checks need {seeds_text(comparison.verdict.seeds_needed)}"


def _largest_difference(comparison: Comparison) -> Headline:
    found = [
        result
        for result in comparison.results
        if result.check.quantity.name == "mean_resistance_N" and math.isfinite(result.difference)
    ]
    label = "largest difference in mean resistance"
    if not found:
        return Headline(DASH, label, "no pair of runs, or no check of it")
    worst = max(found, key=lambda result: abs(result.difference))
    shown = wording.signed_difference(worst.check, worst.difference)
    first, second = worst.pair
    return Headline(shown, label, f"{first} against {second}; margin {wording.margin(worst.check)}")


def check_blocks(comparison: Comparison) -> list[CheckBlock]:
    return [
        CheckBlock(
            title=check.quantity.title,
            margin=wording.margin(check),
            reason=check.reason,
            rows=[_check_row(result) for result in results],
        )
        for check, results in by_check(comparison.results).items()
    ]


def outcome_rows(comparison: Comparison) -> list[tuple[str, list[CheckResult]]]:
    """A row for each check: its title, and what it says of each pair, in the order of `comparison.pairs`."""
    return [
        (check.quantity.title, results) for check, results in by_check(comparison.results).items()
    ]


def pair_matrix(comparison: Comparison) -> list[tuple[str, list[list[tuple[str, str]] | None]]]:
    """Engine by engine: for each pair how many checks had which outcome, as (outcome, "11 of 13"); None: no such pair."""
    tallies = {
        pair: Counter(result.outcome for result in comparison.results if result.pair == pair)
        for pair in comparison.pairs
    }

    def cell(row: str, column: str) -> list[tuple[str, str]] | None:
        tally = tallies.get((row, column))
        if tally is None:
            return None
        worst_first = sorted(tally, key=WORST_FIRST.index)
        return [(outcome, f"{tally[outcome]} of {tally.total()}") for outcome in worst_first]

    engines = comparison.engines
    return [(row, [cell(row, column) for column in engines[:-1]]) for row in engines[1:]]


def _check_row(result: CheckResult) -> CheckRow:
    quantity = result.check.quantity
    return CheckRow(
        pair=" against ".join(result.pair),
        values=" / ".join(wording.quantity_value(quantity, mean) for mean in result.means),
        difference=wording.signed_difference(result.check, result.difference),
        interval=wording.interval(result),
        p=wording.claim(result),
        outcome=result.outcome,
        packings=f"{len(result.seeds)} / {wording.needed(result.seeds_needed)}",
        explanation=wording.explanation(result),
    )


def profile_rows(comparison: Comparison) -> list[list[str]]:
    """Per cm of depth: the depths, then mean ± scatter from packing to packing [N] of each engine."""
    packings = {engine: comparison.packings(engine) for engine in comparison.engines}
    return [
        [f"{100 * depth_m - 0.5:.0f}{DASH}{100 * depth_m + 0.5:.0f}"]
        + [
            wording.with_scatter(table[depth_m].mean(), table[depth_m].std(ddof=1))
            if len(table)
            else DASH
            for table in packings.values()
        ]
        for depth_m in comparison.ensemble.profiles.columns
    ]


def quantity_rows(comparison: Comparison) -> list[tuple[str, str, list[str]]]:
    """Each quantity: title, definition, mean ± scatter from packing to packing for each engine."""
    means, scatters = _means(comparison), comparison.endpoints.groupby("engine").std(ddof=1)
    return [
        (
            quantity.title,
            quantity.definition,
            [
                wording.quantity_with_scatter(
                    quantity, means[name][engine], scatters[name].get(engine)
                )
                for engine in comparison.engines
            ],
        )
        for name, quantity in QUANTITIES.items()
    ]


def _means(comparison: Comparison) -> pd.DataFrame:
    means = comparison.endpoints.groupby("engine").mean()
    return means.reindex(list(comparison.engines))
