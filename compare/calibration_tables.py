"""What a calibration says, as words, rows and plain data."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pandas as pd

from .calibration import (
    AT_MARGIN,
    CONFIDENCE,
    POWER,
    SHIFTS,
    STATE,
    TRUE_SHIFT,
    Calibration,
    Endpoint,
    Rate,
)
from .checks import SEEDS_FOR_INTERVAL
from .record import plain
from .wording import margin, plural, quantity_value

MOST_FALSE_DIFFERENT = 0.02  # of comparisons of equal codes, with any check that says different
MOST_FALSE_EQUIVALENT = 0.05  # of codes that truly differ by TRUE_SHIFT margins, for each check
DESIGN_TITLES = ("packings x runs", "false DIFFERENT, of a case", "all checks EQUIVALENT")
ENDPOINT_TITLES = (
    "check",
    "packings x runs",
    "EQUIVALENT when equal",
    "EQUIVALENT at the margin",
    "DIFFERENT at the margin",
    f"EQUIVALENT at {TRUE_SHIFT:g} margins",
    f"DIFFERENT at {TRUE_SHIFT:g} margins",
    f"found in {100 * POWER:.0f} %: margins",
    "the same in the check's unit",
)


def misses(found: Sequence[Calibration]) -> list[str]:
    """A line for each target that does not hold."""
    lines = []
    for one in found:
        if one.false_different.share > MOST_FALSE_DIFFERENT:
            said = f"{rate(one.false_different)} of comparisons of equal codes end with DIFFERENT"
            lines.append(f"{one.design}: {said}; at most {percent(MOST_FALSE_DIFFERENT)} may")
        for endpoint in one.endpoints:
            title = endpoint.check.quantity.title
            passed = endpoint.at(TRUE_SHIFT).equivalent
            if passed.share > MOST_FALSE_EQUIVALENT:
                said = f"{title} passes for EQUIVALENT in {rate(passed)} at a true shift of"
                most = percent(MOST_FALSE_EQUIVALENT)
                lines.append(f"{one.design}: {said} {TRUE_SHIFT:g} margins; at most {most} may")
            if one.design.packings < SEEDS_FOR_INTERVAL:
                continue
            if not endpoint.at(0.0).equivalent.events:
                lines.append(f"{one.design}: {title} of equal codes is never EQUIVALENT")
            if endpoint.detectable is None:
                said = f"{title} is not DIFFERENT in {percent(POWER)} at any true shift"
                lines.append(f"{one.design}: {said} up to {max(SHIFTS):g} margins")
    return lines


def sentence(found: Sequence[Calibration], splits: int) -> str:
    if not found:
        return "Too few recorded runs to judge the judge."
    worst = max(found, key=lambda one: one.false_different.share).false_different
    blind = max(
        (endpoint.at(TRUE_SHIFT).equivalent for one in found for endpoint in one.endpoints),
        key=lambda passed: passed.share,
    )
    return (
        f"Of {plural(splits, 'comparison')} of equal codes at most {rate(worst)} ended with DIFFERENT (target "
        f"{percent(MOST_FALSE_DIFFERENT)}); of codes that truly differ by {TRUE_SHIFT:g} margins at most {rate(blind)} "
        f"passed for EQUIVALENT (target {percent(MOST_FALSE_EQUIVALENT)})."
    )


def design_rows(found: Sequence[Calibration]) -> list[tuple[str, ...]]:
    return [(str(one.design), rate(one.false_different), rate(one.all_equivalent)) for one in found]


def endpoint_rows(found: Sequence[Calibration]) -> list[tuple[str, ...]]:
    """A row per check and design, the designs of one check together."""
    if not found:
        return []
    rows = []
    for number in range(len(found[0].endpoints)):
        for one in found:
            endpoint = one.endpoints[number]
            at_margin, shifted = endpoint.at(AT_MARGIN), endpoint.at(TRUE_SHIFT)
            rows.append(
                (
                    f"{endpoint.check.quantity.title} {margin(endpoint.check)}",
                    str(one.design),
                    rate(endpoint.at(0.0).equivalent),
                    rate(at_margin.equivalent),
                    rate(at_margin.different),
                    rate(shifted.equivalent),
                    rate(shifted.different),
                    "above all tried"
                    if endpoint.detectable is None
                    else f"{endpoint.detectable:.2f}",
                    detectable(endpoint),
                )
            )
    return rows


def brief_titles(found: Sequence[Calibration]) -> list[str]:
    """For a terminal: of each design, equivalent when equal, the same when shifted, and what is found."""
    return ["check", "margin", *(str(one.design) for one in found)]


def brief_rows(found: Sequence[Calibration]) -> list[list[str]]:
    if not found:
        return []
    return [
        [
            endpoint.check.quantity.title,
            margin(endpoint.check),
            *(_brief(one.endpoints[number]) for one in found),
        ]
        for number, endpoint in enumerate(found[0].endpoints)
    ]


def _brief(endpoint: Endpoint) -> str:
    equal, shifted = endpoint.at(0.0).equivalent, endpoint.at(TRUE_SHIFT).equivalent
    found = "none" if endpoint.detectable is None else f"{endpoint.detectable:.2f}"
    return f"{100 * equal.share:.0f} / {100 * shifted.share:.1f} / {found}"


def rate(found: Rate) -> str:
    low, high = found.interval
    return f"{percent(found.share)} ({100 * low:.1f} to {100 * high:.1f})"


def percent(share: float) -> str:
    return f"{100 * share:.3g} %"


def detectable(endpoint: Endpoint) -> str:
    """The smallest shift that is found, as the case states margins, and in the quantity's unit."""
    if endpoint.detectable is None:
        return ""
    check = endpoint.check
    shift = endpoint.detectable * check.on_scale(check.margin)
    if check.kind == "absolute":
        return quantity_value(check.quantity, shift)
    if check.kind == "relative":
        said, by = percent(shift), abs(shift * endpoint.mean)
    else:
        said, by = f"× {math.exp(shift):.3g}", abs(endpoint.mean) * (math.exp(shift) - 1)
    return f"{said}: {quantity_value(check.quantity, by)}"


def table(found: Sequence[Calibration]) -> pd.DataFrame:
    """The operating characteristics: a row per design, check and true shift."""
    return pd.DataFrame(
        {
            "packings": one.design.packings,
            "runs": one.design.runs,
            "quantity": endpoint.check.quantity.name,
            "shift_margins": point.shift,
            "splits": point.equivalent.trials,
            "equivalent": point.equivalent.events,
            "different": point.different.events,
        }
        for one in found
        for endpoint in one.endpoints
        for point in endpoint.points
    )


def record(found: Sequence[Calibration], splits: int) -> dict:
    """Counts, so that whoever computes them again can compare them exactly."""
    return plain(
        {
            "splits": splits,
            "random_state": STATE,
            "confidence": CONFIDENCE,
            "true_shift_margins": TRUE_SHIFT,
            "most_false_different": MOST_FALSE_DIFFERENT,
            "most_false_equivalent": MOST_FALSE_EQUIVALENT,
            "misses": misses(found),
            "designs": [_design(one) for one in found],
        }
    )


def _design(one: Calibration) -> dict:
    return {
        "packings": one.design.packings,
        "runs": one.design.runs,
        "false_different": _rate(one.false_different),
        "all_equivalent": _rate(one.all_equivalent),
        "checks": [
            {
                "quantity": endpoint.check.quantity.name,
                "kind": endpoint.check.kind,
                "margin": endpoint.check.margin,
                "equivalent_when_equal": _rate(endpoint.at(0.0).equivalent),
                "equivalent_at_margin": _rate(endpoint.at(AT_MARGIN).equivalent),
                "different_at_margin": _rate(endpoint.at(AT_MARGIN).different),
                "false_equivalent": _rate(endpoint.at(TRUE_SHIFT).equivalent),
                "detectable_margins": endpoint.detectable,
            }
            for endpoint in one.endpoints
        ],
    }


def _rate(found: Rate) -> dict:
    return {"events": found.events, "share": found.share, "interval": found.interval}
