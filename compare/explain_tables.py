"""An attribution in words and rows of text: what the page and the terminal show alike, and what the files hold."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

import pandas as pd

from . import wording
from .attribution import CONFIDENCE, Attribution, Change, Endpoint, Station
from .checks import Check
from .quantities import QUANTITIES
from .wording import listed, plural

LEFT_OVER = "left over"
TO_SCHEME = "all, up to the native scheme"
RESTLESS = "*"  # marks changes that hold the energy of a bed that does not rest


class Row(NamedTuple):
    """A step of all quantities, or one of the sums."""

    name: str
    changes: list[Change | None]  # one for each quantity; None in a row of rests
    cells: list[str]


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
            f"\u201c{step_name(largest)}\u201d, {change(largest)}" + _certainty(largest)
        )
    if telling := [step for step in attribution.steps if step.telling]:
        told.append(
            f"{len(attribution.clear_steps)} of {len(telling)} intervals leave out zero; "
            f"about {_by_chance(telling)} would by chance."
        )
    told.append(_last_step(attribution))
    told.append(_sum(attribution))
    return told


def remarks(station: Station) -> list[str]:
    """What a reader must know of its runs."""
    seeds = len(station.seeds)
    told = []
    if station.failures:
        first = next(iter(station.failures.values()))
        told.append(f"no result in {len(station.failures)} of {seeds}: {first}")
    for messages in station.failed_gates.values():
        first = next(iter(messages.values())).removeprefix("not comparable: ")
        told.append(f"`crossdem check` would refuse {len(messages)} of {seeds}: {first}")
    return told


def step_name(step: Change) -> str:
    """ "step 3 (with step 2)" for a step over a station without result, whose effect is in it, too."""
    return f"{step.name} (with {listed(step.over)})" if step.over else step.name


def change(step: Change) -> str:
    """The mean and half the 95 % interval: "+1.2 ± 2.0 %", "× 1.02 ± 5 %"; a dash without runs, an asterisk where some
    bed does not rest. To three digits of the check's margin, so that a column reads well.
    """
    return _number(step) + (RESTLESS if step.restless else "")


def _number(step: Change) -> str:
    check = step.check
    half = (step.interval[1] - step.interval[0]) / 2 if step.interval else math.nan
    if math.isnan(step.mean) or check.kind == "ratio":
        shown = wording.signed_difference(check, step.mean)
        return shown if math.isnan(half) else f"{shown} ± {100 * math.expm1(half):.0f} %"
    factor, unit = 100.0, "%"
    if check.kind == "absolute":
        factor, unit = check.quantity.shown_unit
    decimals = max(0, 2 - math.floor(math.log10(factor * check.margin)))
    rounded = round(factor * step.mean, decimals) + 0.0  # no minus sign before a zero
    shown = f"{rounded:+.{decimals}f}".replace("-", wording.MINUS)
    shown += "" if math.isnan(half) else f" ± {factor * half:.{decimals}f}"
    return f"{shown} {unit}".rstrip()


def change_rows(attribution: Attribution) -> list[Row]:
    """Each step, the sums, and what is left over where it is not nothing."""
    endpoints = attribution.endpoints
    named = [
        ("", [endpoint.steps[number] for endpoint in endpoints])
        for number in range(len(attribution.stations) - 1)
    ]
    named.append((TO_SCHEME, [endpoint.to_scheme for endpoint in endpoints]))
    named.append((f"all, up to {attribution.target}", [endpoint.total for endpoint in endpoints]))
    packings = len(attribution.stations[0].seeds)
    rows = [_row(name, changes, packings) for name, changes in named]
    if not all(endpoint.adds_up for endpoint in endpoints):
        cells = [wording.signed_difference(one.check, one.left_over) for one in endpoints]
        rows.append(Row(LEFT_OVER, [None] * len(cells), cells))
    return rows


def _row(name: str, changes: list[Change], packings: int) -> Row:
    """What most quantities have in common stands in the name; where one differs from that, it stands in its cell."""

    def about(step: Change) -> tuple[str, str]:
        few = 0 < len(step.seeds) < packings
        return name or step_name(step), plural(len(step.seeds), "packing") if few else ""

    found = [step for step in changes if step.seeds] or changes
    common = Counter(about(step) for step in found).most_common(1)[0][0]

    def cell(step: Change) -> str:
        other = [own for own, usual in zip(about(step), common) if own and own != usual]
        return change(step) + (f" [{', '.join(other)}]" if other and step.seeds else "")

    return Row(", ".join(filter(None, common)), changes, [cell(step) for step in changes])


def value_rows(attribution: Attribution) -> list[tuple[str, list[str]]]:
    """Of each station: name, and mean ± standard deviation from seed to seed of each quantity."""
    return [
        (
            station.name,
            [
                _value(station.values[endpoint.check.quantity.name], endpoint.check)
                for endpoint in attribution.endpoints
            ],
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
                "with": ", ".join(step.over),
                "change": step.mean,
                "low_95": low,
                "high_95": high,
                "scale": _scale(endpoint),
                "packings": len(step.seeds),
                "leaves_out_zero": step.leaves_out_zero,
                "all_beds_rest": not step.restless,
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
    if step.restless:
        return ", on beds of which some do not rest."
    return "." if step.clear else ", which its interval does not tell from none."


def _last_step(attribution: Attribution) -> str:
    """Whether the engine itself does what its native scheme does."""
    steps, target = attribution.last_steps, attribution.target
    if not steps:
        return f"The last step, to {target} itself, has no result."
    if any(step.over for step in steps):
        return f"The last step holds more than {target} itself: the native scheme has no result."
    packings = plural(len(steps[0].seeds), "packing")
    quantities = plural(len(steps), "quantity", "quantities")
    if all(step.nothing for step in steps):
        return (
            f"The last step changes nothing: {target} itself and its native scheme give the same bits in "
            f"{quantities}, on {packings}."
        )
    clear = [step for step in steps if step.leaves_out_zero]
    if clear:
        return (
            f"The last step leaves out zero in {len(clear)} of {quantities}: more than chaos would, which does so in "
            f"about {_by_chance([step for step in steps if not step.nothing])}; run `crossdem horizon`, which compares particle by particle."
        )
    if all(step.interval is None for step in steps):
        return f"What the last step changes cannot be told from chaos on {packings}."
    return "What the last step changes is not told from none."


def _by_chance(steps: list[Change]) -> str:
    """How many of their intervals leave out zero where nothing changes."""
    return f"{(1 - CONFIDENCE) * len(steps):.1f}"


def _sum(attribution: Attribution) -> str:
    rest = [endpoint for endpoint in attribution.endpoints if not endpoint.adds_up]
    if not attribution.has_total:
        return "There is no total: one of its ends has no result."
    if not rest:
        added = "The steps add up to the total in every quantity"
        same = ": all were taken on the same packings" if attribution.same_packings else ""
        return f"{added}{same}."
    worst = wording.signed_difference(rest[0].check, rest[0].left_over)
    return (
        f"The steps do not add up to the total, since not every station has a result on every packing: of the "
        f"{rest[0].check.quantity.title} {worst} is left over."
    )


def _value(values: pd.Series, check: Check) -> str:
    return wording.quantity_with_scatter(
        QUANTITIES[check.quantity.name], float(values.mean()), float(values.std(ddof=1))
    )
