"""The report's tables and numbers as rows of text: what the page, the Markdown and the terminal show alike."""

from __future__ import annotations

import math
from typing import NamedTuple

import pandas as pd

from . import resistance, wording
from .checks import Check
from .comparison import Comparison
from .quantities import QUANTITIES
from .verdict import seeds_text

DASH = "\N{EN DASH}"


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
    outcome: str
    explanation: str


class CheckBlock(NamedTuple):
    """One check with its rows for all pairs."""

    title: str
    definition: str
    margin: str
    alarm: str
    seeds_needed: str
    reason: str
    rows: list[CheckRow]


def headlines(comparison: Comparison) -> list[Headline]:
    """Mean resistance, its largest difference between two engines, and the seeds behind the verdict."""
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
    needed = seeds_text(verdict.seeds_needed) if comparison.results else "no pair was checked"
    bar, time = comparison.case.resolved["bar"], comparison.case.resolved["time"]
    deepest_cm = 100 * bar["speed_m_s"] * time["penetration_s"]
    window = f"mean resistance from {resistance.DEEP_FROM * deepest_cm:.3g} to {deepest_cm:.3g} cm"
    return [
        Headline(span, window, by_engine or "no run finished"),
        _largest_difference(comparison),
        Headline(
            wording.plural(verdict.seeds if comparison.results else len(comparison.seeds), "seed"),
            "behind this verdict",
            f"a statement of equivalence needs {needed}" if comparison.results else needed,
        ),
    ]


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
    blocks: dict[Check, CheckBlock] = {}
    for result in comparison.results:
        check = result.check
        block = blocks.setdefault(
            check,
            CheckBlock(
                title=check.quantity.title,
                definition=check.quantity.definition,
                margin=wording.margin(check),
                alarm=wording.band(check, result.alarm),
                seeds_needed=wording.needed(result),
                reason=check.reason,
                rows=[],
            ),
        )
        values = " / ".join(wording.quantity_value(check.quantity, mean) for mean in result.means)
        block.rows.append(
            CheckRow(
                pair=" against ".join(result.pair),
                values=values,
                difference=wording.signed_difference(check, result.difference),
                interval=wording.interval(result),
                outcome=result.outcome,
                explanation=wording.explanation(result),
            )
        )
    return list(blocks.values())


def profile_rows(comparison: Comparison) -> list[list[str]]:
    """Per cm of depth: the depths, then mean ± scatter from seed to seed [N] of each engine."""
    profiles = {
        engine: resistance.profile_over_seeds(
            [resistance.resistance_profile(run.resistance) for run in comparison.of(engine)]
        )
        for engine in comparison.engines
        if comparison.of(engine)
    }
    if not profiles:
        return []
    return [
        [f"{100 * depth_m - 0.5:.0f}{DASH}{100 * depth_m + 0.5:.0f}"]
        + [
            wording.with_scatter(*profiles[engine].loc[depth_m]) if engine in profiles else DASH
            for engine in comparison.engines
        ]
        for depth_m in next(iter(profiles.values())).index
    ]


def quantity_rows(comparison: Comparison) -> list[tuple[str, str, list[str]]]:
    """Each quantity: title, definition, mean ± scatter from seed to seed for each engine."""
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
