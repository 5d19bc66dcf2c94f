"""An attribution in words and rows of text: what the page and the terminal show alike, and what the files hold."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pandas as pd

from . import wording
from .attribution import CONFIDENCE, Attribution, Change, Endpoint
from .checks import Check
from .quantities import QUANTITIES

LEFT_OVER = "left over"


def headline(attribution: Attribution) -> str:
    total = attribution.endpoints[0].total
    shown = f"paper scheme to {attribution.target}: {change(total)}"
    return f"{shown} in the {total.check.quantity.title}"


def sentences(attribution: Attribution) -> list[str]:
    """What the numbers say, in the order of their weight."""
    first = attribution.endpoints[0]
    finite = [step for step in first.steps if math.isfinite(step.mean)]
    told = []
    if finite:
        largest = max(finite, key=lambda step: abs(step.mean))
        told.append(
            f"The largest single change of the {first.check.quantity.title} is that of the step "
            f"\u201c{largest.name}\u201d, {change(largest)}" + _certainty(largest)
        )
    steps = [step for endpoint in attribution.endpoints for step in endpoint.steps if step.interval]
    if steps:
        by_chance = (1 - CONFIDENCE) * len(steps)
        told.append(
            f"{len(attribution.clear_steps)} of {len(steps)} intervals leave out zero; "
            f"about {by_chance:.0f} would by chance."
        )
    told.append(_sum(attribution))
    return told


def change(step: Change) -> str:
    """The mean and half the 95 % interval: "+1.2 ± 2.0 %", "× 1.02 ± 5 %"; a dash without runs.

    To three digits of the check's margin, so that a column reads well.
    """
    check = step.check
    half = (step.interval[1] - step.interval[0]) / 2 if step.interval else math.nan
    if math.isnan(step.mean) or check.kind == "ratio":
        shown = wording.signed_difference(check, step.mean)
        return shown if math.isnan(half) else f"{shown} ± {100 * math.expm1(half):.0f} %"
    factor, unit = 100.0, "%"
    if check.kind == "absolute":
        factor, unit = wording.SHOWN_UNITS.get(check.quantity.unit, (1.0, check.quantity.unit))
    decimals = max(0, 2 - math.floor(math.log10(factor * check.margin)))
    rounded = round(factor * step.mean, decimals) + 0.0  # no minus sign before a zero
    shown = f"{rounded:+.{decimals}f}".replace("-", wording.MINUS)
    shown += "" if math.isnan(half) else f" ± {factor * half:.{decimals}f}"
    return f"{shown} {unit}".rstrip()


def change_rows(attribution: Attribution) -> list[tuple[str, list[Change | None], list[str]]]:
    """Of each step and of the sums: its name, the changes of all quantities, and the same as text."""
    rows = []
    for number, station in enumerate(attribution.stations[1:]):
        rows.append((station.name, [endpoint.steps[number] for endpoint in attribution.endpoints]))
    rows.append(("all, up to the native scheme", [one.to_scheme for one in attribution.endpoints]))
    rows.append((f"all, up to {attribution.target}", [one.total for one in attribution.endpoints]))
    table = [(name, changes, [change(entry) for entry in changes]) for name, changes in rows]
    if not all(endpoint.adds_up for endpoint in attribution.endpoints):
        cells = [
            wording.signed_difference(endpoint.check, endpoint.left_over)
            for endpoint in attribution.endpoints
        ]
        table.append((LEFT_OVER, [None] * len(cells), cells))
    return table


def value_rows(attribution: Attribution) -> list[tuple[str, list[str], list[str]]]:
    """Of each station: name, mean ± standard deviation from seed to seed of each quantity, and remarks."""
    return [
        (
            station.name,
            [
                _value(station.values[endpoint.check.quantity.name], endpoint.check)
                for endpoint in attribution.endpoints
            ],
            station.remarks,
        )
        for station in attribution.stations
    ]


def table(attribution: Attribution) -> pd.DataFrame:
    """Every number, for explain.csv: one row per quantity and step."""
    return pd.DataFrame(_records(attribution))


def _records(attribution: Attribution) -> Iterator[dict]:
    for endpoint in attribution.endpoints:
        for step in (*endpoint.steps, endpoint.to_scheme, endpoint.total):
            low, high = step.interval or (math.nan, math.nan)
            of_sum = step is endpoint.to_scheme or step is endpoint.total
            yield {
                "quantity": endpoint.check.quantity.name,
                "step": f"all, up to {step.name}" if step is endpoint.to_scheme else step.name,
                "against": step.against or "",
                "change": step.mean,
                "low_95": low,
                "high_95": high,
                "scale": _scale(endpoint),
                "packings": len(step.seeds),
                "leaves_out_zero": step.clear,
                "is_sum": of_sum,
            }


def _scale(endpoint: Endpoint) -> str:
    return {
        "relative": "share of the mean of the paper scheme",
        "ratio": "natural logarithm of the factor",
        "absolute": endpoint.check.quantity.unit or "as it is",
    }[endpoint.check.kind]


def _certainty(step: Change) -> str:
    if step.interval is None:
        return ", on one packing alone."
    return "." if step.clear else ", which its interval does not tell from none."


def _sum(attribution: Attribution) -> str:
    rest = [endpoint for endpoint in attribution.endpoints if not endpoint.adds_up]
    if not any(math.isfinite(endpoint.total.mean) for endpoint in attribution.endpoints):
        return "There is no total: one of its ends has no result."
    if not rest:
        return (
            "The steps add up to the total in every quantity: all were taken on the same packings."
        )
    worst = wording.signed_difference(rest[0].check, rest[0].left_over)
    return (
        f"The steps do not add up to the total, since not every station has a result on every packing: of the "
        f"{rest[0].check.quantity.title} {worst} is left over."
    )


def _value(values: pd.Series, check: Check) -> str:
    return wording.quantity_with_scatter(
        QUANTITIES[check.quantity.name], float(values.mean()), float(values.std(ddof=1))
    )
