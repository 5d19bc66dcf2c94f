"""The rungs of the ladder, judged: an engine against its twin, and an engine against what is known beforehand.

Both are data of the case: [[twin]] where the last bit cannot be had, [[answer]] for closed forms and invariants,
[[difference]] where an engine is known to come to something else; such a difference must not vanish either.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from crossdem.adapters.dataset import Dataset, Motion
from crossdem.adapters.engines import get_engine

from .answers import ANSWERS, Answer
from .engine_laws import engine_law
from .outcomes import AGREES, DIFFERS, NO_RESULT, NO_SUCH_LAW, NOT_COMPARABLE
from .refinement import extrapolated, observed_order
from .start import Start
from .twin_schemes import own_limit_m
from .wording import MINUS, number

TWIN, CLOSED_FORM = "twin", "closed form"
# Of the native solver against the paper's scheme written a second time, which sums in another order.
REFERENCE_LIMIT_M = 1e-11
REFERENCE_LIMIT_N = 1e-8  # on bar, its tip and shaft, and floor
REFERENCE_LIMIT_J = 1e-11  # of kinetic energy
OTHER_ORDER = "the transcription adds up contacts in an order of its own"
SAME_BITS = "the native scheme of the engine's name does the same operations in the same order"
OWN_LIMIT = "the engine's description says so"
FORCES = ("force_x_N", "force_y_N", "tip_force_y_N", "shaft_force_y_N", "floor_force_y_N")
TIME_SLACK_S = 1e-9
LARGEST_PLAIN = 1e6  # values up to here are written without exponent
ORDER_SHARE = 1e-5  # of the tolerance: smaller differences say nothing of an order


@dataclass(frozen=True)
class Rung:
    """What one engine says on one case: of a twin, or of one answer."""

    case: str
    engine: str
    kind: str  # TWIN or CLOSED_FORM
    about: str  # of the twin, or the answer's title
    outcome: str
    sentence: str  # why; no full stop

    @property
    def name(self) -> str:
        return f"{self.kind}, {self.about}"


@dataclass(frozen=True)
class TwinRung(Rung):
    """The largest distance between the particles of two runs that should be the same."""

    difference_m: float = math.nan
    time_s: float = math.nan  # where the difference is largest
    limit_m: float = math.nan
    until_s: float = math.nan  # how far they are compared
    reason: str = ""  # for the limit
    difference_N: float | None = None  # of the forces on bar and floor, where they are compared


@dataclass(frozen=True)
class AnswerRung(Rung):
    """A quantity at the engine's time step and at its halves, and what it must come to."""

    answer: Answer | None = None
    values: tuple[float, ...] = ()
    order: float | None = None
    limit: float = math.nan
    exact: float = math.nan
    tolerance: float = math.nan  # in the quantity's unit, whatever its kind in the case
    expected: dict | None = None  # the [[difference]] of the case, if it has one here
    reason: str = ""

    @property
    def errors(self) -> tuple[float, ...]:
        return tuple(value - self.exact for value in self.values)

    @property
    def declared(self) -> bool:
        """Whether it agrees because a difference of this size was declared, with a reason, and not with the closed form."""
        return self.outcome == AGREES and self.expected is not None

    @property
    def error(self) -> float:
        """Of the limit, in the quantity's unit."""
        return self.limit - self.exact

    @property
    def share(self) -> float:
        """Of the tolerance that is used up."""
        if self.expected:
            return abs(self.error - self.expected["value"]) / self.expected["tolerance"]
        return abs(self.error) / self.tolerance if self.tolerance > 0 else 0.0


def twin_rung(
    case: dict,
    engine: str,
    about: str,
    run: Dataset,
    twin: Motion,
    twin_table: pd.DataFrame | None = None,
) -> TwinRung:
    """`run` of `engine` against its `twin`, frame by frame; `twin_table`, of what was recorded beside the motion, where
    that is compared too.
    """
    entry = next((table for table in case["twin"] if table["engine"] == engine), {})
    limit_m = entry.get("limit_m", REFERENCE_LIMIT_M if twin_table is not None else 0.0)
    if own_m := own_limit_m(engine):
        limit_m = own_m
    until_s = entry.get("until_s", case["time"]["penetration_s"])
    compared = run.motion.time_s <= until_s + TIME_SLACK_S
    way_m = run.motion.position_m[compared] - twin.position_m[compared]
    distances_m = np.hypot(way_m[..., 0], way_m[..., 1]).max(axis=1)
    worst = int(np.argmax(distances_m))
    difference_N, miscounted = None, ""
    if twin_table is not None:
        rows = run.resistance["time_s"] <= until_s + TIME_SLACK_S
        tables = run.resistance[rows], twin_table[rows.to_numpy()]
        difference_N = max(_difference(column, *tables) for column in FORCES)
        miscounted = _miscounted(*tables)
    difference_m = float(distances_m[worst])
    agrees = difference_m <= limit_m and (difference_N or 0.0) <= REFERENCE_LIMIT_N
    agrees = agrees and not miscounted
    force = "" if difference_N is None else f" and {difference_N:.1e} N"
    when = f" (at {run.motion.time_s[worst]:.4g} s)" if difference_m > 0 else ""
    return TwinRung(
        case=case["name"],
        engine=engine,
        kind=TWIN,
        about=about,
        outcome=AGREES if agrees else DIFFERS,
        sentence=f"apart by {difference_m:.2e} m{force} at most{when}, allowed {limit_m:.1e} m{miscounted}",
        difference_m=difference_m,
        time_s=float(run.motion.time_s[worst]),
        limit_m=limit_m,
        until_s=until_s,
        reason=OWN_LIMIT
        if own_m
        else entry.get("reason", SAME_BITS if twin_table is None else OTHER_ORDER),
        difference_N=difference_N,
    )


def answer_rung(case: dict, engine: str, entry: dict, runs: Sequence[Dataset]) -> Rung:
    """The `entry` of the case's [[answer]] tables on `runs` at dt, dt/2, dt/4, or at dt alone."""
    answer = ANSWERS[entry["quantity"]]
    used = runs[:1] if answer.own_step else runs
    try:
        values = tuple(float(answer.measured(run)) for run in used)
        exact = float(answer.exact(Start.of(case), engine_law(engine, case)))
    except (ValueError, ZeroDivisionError) as error:
        said = "it divides by what is 0 here" if isinstance(error, ZeroDivisionError) else error
        why = f"no value on this case: {said}"
        return without_result(case["name"], engine, CLOSED_FORM, answer.title, why, NOT_COMPARABLE)
    if answer.own_step:
        limit = values[0]
    elif answer.every_step:
        limit = max(values, key=lambda value: abs(value - exact))
    else:
        limit = extrapolated(values)
    tolerance = entry["tolerance"] * (abs(exact) if entry["kind"] == "relative" else 1.0)
    expected = next(
        (
            table
            for table in [*case["difference"], *_own_differences(engine, case["name"])]
            if (table["engine"], table["quantity"]) == (engine, answer.name)
        ),
        None,
    )
    rung = AnswerRung(
        case=case["name"],
        engine=engine,
        kind=CLOSED_FORM,
        about=answer.title,
        outcome=AGREES,
        sentence="",
        answer=answer,
        values=values,
        order=None
        if len(values) == 1 or answer.every_step
        else observed_order(values, ORDER_SHARE * tolerance),
        limit=limit,
        exact=exact,
        tolerance=tolerance,
        expected=expected,
        reason=expected["reason"] if expected else entry["reason"],
    )
    outcome, sentence = _judged(rung)
    return AnswerRung(**{**vars(rung), "outcome": outcome, "sentence": sentence})


def _own_differences(engine: str, case_name: str) -> list[dict]:
    """Those that the description of a user's engine names for this case."""
    own = getattr(get_engine(engine), "difference", ())
    return [{"engine": engine, **entry} for entry in own if entry["case"] == case_name]


def without_result(
    case: str, engine: str, kind: str, about: str, why: str, outcome=NO_RESULT
) -> Rung:
    return Rung(case, engine, kind, about, outcome, why)


def _judged(rung: AnswerRung) -> tuple[str, str]:
    unit = f" {rung.answer.unit}".rstrip()
    said = f"{_digits(rung.limit, rung)}{unit}, exact {_digits(rung.exact, rung)}{unit}"
    if rung.expected is None:
        good = abs(rung.error) <= rung.tolerance
        return (AGREES if good else DIFFERS), f"{said}, allowed ± {number(rung.tolerance)}{unit}"
    value, band = rung.expected["value"], rung.expected["tolerance"]
    known = f"known to differ by {number(value)} ± {number(band)}{unit}"
    if abs(rung.error - value) <= band:
        return AGREES, f"{said}, {known}"
    if abs(rung.error) <= rung.tolerance:
        return DIFFERS, f"{said}: the expected difference has vanished, though {known}"
    return DIFFERS, f"{said}, {known}"


def _digits(value: float, rung: AnswerRung) -> str:
    """With one decimal more than the tolerance has."""
    if math.isnan(value):
        return "no value"
    if rung.tolerance == 0 or not math.isfinite(value) or abs(value) > LARGEST_PLAIN:
        return number(value)
    decimals = max(0, 1 - math.floor(math.log10(rung.tolerance)))
    return f"{value:.{decimals}f}".replace("-", MINUS)


def _miscounted(found: pd.DataFrame, twin: pd.DataFrame) -> str:
    """What else of the two tables differs, as the end of a sentence."""
    contacts = _difference("contacts", found, twin)
    energy_J = _difference("kinetic_energy_J", found, twin)
    said = f"; {contacts:.0f} contacts more or fewer" if contacts else ""
    too_far = energy_J > REFERENCE_LIMIT_J
    return said + (f"; kinetic energy apart by {energy_J:.1e} J" if too_far else "")


def _difference(column: str, found: pd.DataFrame, twin: pd.DataFrame) -> float:
    """The largest."""
    return float(np.abs(found[column].to_numpy() - twin[column].to_numpy()).max())
