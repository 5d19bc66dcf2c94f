"""Numbers as people read them, alike in the page, the tables, the terminal and the test report."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from . import checks
from .checks import Check, CheckResult
from .quantities import Quantity

MINUS = "\N{MINUS SIGN}"
DASH = "\N{EN DASH}"  # where there is nothing to show

# Control characters, which neither XML nor a terminal may be given; and what is no character at all.
UNPRINTABLE = re.compile("[^\t\n\r\u0020-\u007e\u00a0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def printable(text: str) -> str:
    """Text of a case, dataset or engine, fit to be shown anywhere."""
    return UNPRINTABLE.sub("\N{REPLACEMENT CHARACTER}", text)


def glued(numbers: str) -> str:
    """Numbers that do not break from their units, only at "to", "/" and before the scatter."""
    return re.sub(r"(?<!to)(?<!/) (?!to\b|/|±)", "\N{NO-BREAK SPACE}", numbers)


def glued_sentence(text: str) -> str:
    """Words among which no number breaks from a unit, nor from any other word as short as one."""
    return re.sub(r"(?<=\d) (?=\S{1,4}(?!\S))", "\N{NO-BREAK SPACE}", text)


def plural(count: int, one: str, many: str | None = None) -> str:
    return f"{count} {one if count == 1 else many or one + 's'}"


def listed(names: Sequence[str]) -> str:
    """ "native, liggghts and yade"."""
    return " and ".join([", ".join(names[:-1]), names[-1]]) if len(names) > 1 else names[0]


def number(value: float, digits: int = 3) -> str:
    """`value` to `digits` significant digits, without exponent where it can be; a dash for NaN."""
    if math.isnan(value):
        return DASH
    text = f"{value:#.{digits}g}"
    text = f"{float(text):.0f}" if "e+0" in text and abs(value) < 1e6 else text.rstrip(".")
    return text.replace("-", MINUS)


def metres(value_m: float) -> str:
    """A length far below any other: "2.4e−15 m"."""
    return re.sub("e-0?", f"e{MINUS}", f"{value_m:.2g} m")


def quantity_value(quantity: Quantity, value: float, digits: int = 3) -> str:
    factor, unit = quantity.shown_unit
    return f"{number(factor * value, digits)} {unit}".rstrip()


def with_scatter(mean: float, scatter: float | None) -> str:
    """ "0.882 ± 0.046": the scatter to the digits of the mean; the mean alone where there is no scatter."""
    shown = number(mean)
    if scatter is None or math.isnan(scatter) or math.isnan(mean):
        return shown
    decimals = len(shown.partition(".")[2])
    return f"{shown} ± {scatter:.{decimals}f}"


def quantity_with_scatter(quantity: Quantity, mean: float, scatter: float | None) -> str:
    factor, unit = quantity.shown_unit
    shown = with_scatter(factor * mean, None if scatter is None else factor * scatter)
    return shown if math.isnan(mean) else f"{shown} {unit}".rstrip()


def signed_difference(check: Check, difference: float) -> str:
    """A difference on the check's scale, with its sign: "+4.1 %", "x 1.12", "-0.3 mm"."""
    if math.isnan(difference):
        return number(difference)
    if check.kind == "ratio":
        return f"\N{MULTIPLICATION SIGN} {math.exp(difference):.2f}"
    if check.kind == "relative":
        return f"{round(100 * difference, 1) + 0.0:+.1f} %".replace("-", MINUS)
    sign = MINUS if difference < 0 else "+"
    return f"{sign}{quantity_value(check.quantity, abs(difference), digits=2)}"


def band(check: Check, half_width: float) -> str:
    """A band about no difference, of a half width on the check's scale: "±10 %", "1/1.33 to 1.33"."""
    if check.kind == "ratio":
        factor = f"{math.exp(half_width):.2f}"
        return f"1/{factor} to {factor}"
    if check.kind == "relative":
        return f"±{100 * half_width:.3g} %"
    return f"±{quantity_value(check.quantity, half_width)}"


def margin(check: Check) -> str:
    return band(check, check.on_scale(check.margin))


def interval(result: CheckResult) -> str:
    """The 90 % interval of the mean difference; a dash where there are too few pairs for one."""
    if result.interval is None or not all(map(math.isfinite, result.interval)):
        return DASH
    return " to ".join(signed_difference(result.check, end) for end in result.interval)


def needed(seeds: int | None) -> str:
    return f"> {checks.MOST_SEEDS}" if seeds is None else str(seeds)


def packings(seeds: int, runs_each: Sequence[int] = (1,)) -> str:
    """ "16 packings × 3 runs": the packings behind a statement, and how many runs each of them has."""
    fewest, most = min(runs_each, default=1), max(runs_each, default=1)
    each = str(most) if fewest == most else f"{fewest} to {most}"
    runs = "" if most == 1 else f" \N{MULTIPLICATION SIGN} {each} runs"
    return plural(seeds, "packing") + runs


def probability(p: float) -> str:
    return "< 0.0001" if p < 0.0001 else f"{p:.2g}"


def claim(result: CheckResult) -> str:
    """p after Holm of the claim that the mean difference points to: "equivalent: 0.003"; a dash without an interval."""
    if result.interval is None or not all(map(math.isfinite, result.interval)):
        return DASH
    if abs(result.difference) > result.margin:
        return f"{checks.DIFFERENT}: {probability(result.p_different)}"
    return f"{checks.EQUIVALENT}: {probability(result.p_equivalent)}"


def explanation(result: CheckResult) -> str:
    """Why the outcome is what it is; no full stop."""
    if result.outcome == checks.NOT_COMPARABLE:
        return "; ".join(result.obstacles)
    if result.alarm is not None:
        shown = signed_difference(result.check, result.difference)
        alarm = f"the alarm band of {plural(len(result.seeds), 'packing')}, {band(result.check, result.alarm)}"
        if result.alarmed:
            return f"the mean difference {shown} lies outside {alarm}"
        return (
            f"{plural(len(result.seeds), 'packing')} can only raise an alarm, and {shown} lies within {alarm}; "
            f"a statement of equivalence needs {needed(result.seeds_needed)}"
        )
    where = f"the 90 % interval {interval(result)}"
    limits = f"the margin {margin(result.check)}"
    if result.within or result.beyond:
        p = result.p_equivalent if result.within else result.p_different
        place = f"{where} lies {'within' if result.within else 'wholly outside'} {limits}"
        if result.outcome != checks.INCONCLUSIVE:
            return f"{place}, p {probability(p)} after Holm"
        return (
            f"{place}, but among {plural(result.family, 'check')} that can be chance: p {probability(p)} after Holm, "
            f"above {checks.ALPHA}; {_to_settle(result)}"
        )
    return f"{where} reaches across {limits}: neither equivalence nor a difference is shown; {_to_settle(result)}"


def _to_settle(result: CheckResult) -> str:
    return (
        f"equal engines need {needed(result.seeds_needed)} packings, "
        f"a difference as measured {needed(result.seeds_to_settle)}"
    )
