"""The ladder as rows of text: what the page and the terminal show alike; and as plain data."""

from __future__ import annotations

from typing import NamedTuple

from .ladder import Ladder
from .outcomes import AGREES, DIFFERS, NO_RESULT, NO_SUCH_LAW, NOT_COMPARABLE
from .rungs import AnswerRung, Rung, TwinRung
from .wording import MINUS, number

DASH = "\N{EN DASH}"
TITLES = (
    "case",
    "engine",
    "twin, m",
    "allowed",
    "answer",
    "off at \u0394t",
    "\u0394t/2",
    "\u0394t/4",
    "order",
    "limit off",
    "allowed",
    "verdict",
)


class AnswerCells(NamedTuple):
    """One answer of one engine."""

    title: str
    exact: str
    errors: tuple[str, str, str]  # at dt, dt/2, dt/4
    order: str
    error: str  # of the limit
    allowed: str
    outcome: str
    remark: str  # why


class TwinCells(NamedTuple):
    """One engine against its twin."""

    about: str
    difference: str
    allowed: str
    outcome: str
    remark: str


def answer_cells(rung: Rung) -> AnswerCells:
    if not isinstance(rung, AnswerRung):
        return AnswerCells(
            rung.about, DASH, (DASH,) * 3, DASH, DASH, DASH, rung.outcome, rung.sentence
        )
    unit = f" {rung.answer.unit}".rstrip()
    errors = [tiny(error) for error in rung.errors]
    expected = rung.expected
    return AnswerCells(
        title=rung.about,
        exact=f"{rung.exact:.6g}{unit}".replace("-", MINUS),
        errors=tuple(errors + [DASH] * (3 - len(errors))),
        order=DASH if rung.order is None else f"{rung.order:.2f}",
        error=tiny(rung.error),
        allowed=(
            f"{number(expected['value'], 2)} ± {number(expected['tolerance'], 1)}"
            if expected
            else tiny(rung.tolerance)
        ),
        outcome=rung.outcome,
        remark=_remark(rung),
    )


def twin_cells(rung: Rung) -> TwinCells:
    if not isinstance(rung, TwinRung):
        return TwinCells(rung.about, DASH, DASH, rung.outcome, rung.sentence)
    forces = "" if rung.difference_N is None else f"; forces {tiny(rung.difference_N)} N"
    exact = rung.limit_m == 0
    return TwinCells(
        about=rung.about,
        difference=tiny(rung.difference_m),
        allowed=tiny(rung.limit_m),
        outcome=rung.outcome,
        remark=f"up to {rung.until_s:.4g} s{forces}" + ("" if exact else f": {rung.reason}"),
    )


def summary_rows(ladder: Ladder) -> list[tuple[tuple[str, ...], str]]:
    """A row for each case and engine, with its outcome: the twin, and the answer that concerns most."""
    rows = []
    for case in ladder.cases:
        for engine in ladder.engines:
            found = ladder.of(case.name, engine)
            twins = [twin_cells(rung) for rung in found if rung.kind == "twin"]
            answers = sorted((rung for rung in found if rung.kind != "twin"), key=_concern)
            twin = twins[0] if twins else TwinCells("", DASH, DASH, "", "")
            answer = answer_cells(answers[-1]) if answers else None
            cells = (
                (answer.title, *answer.errors, answer.order, answer.error, answer.allowed)
                if answer
                else (DASH,) * 7
            )
            outcome = _worst([rung.outcome for rung in found])
            rows.append(
                ((case.name, engine, twin.difference, twin.allowed, *cells, outcome), outcome)
            )
    return rows


def record(ladder: Ladder) -> dict:
    """Everything as plain data; SI units."""
    return {
        "name": ladder.name,
        "verdict": {
            "word": ladder.word,
            "sentence": ladder.sentence,
            "next_step": ladder.next_step,
            "exit_code": int(ladder.exit_code),
        },
        "engines": {engine: ladder.versions.get(engine) for engine in ladder.engines},
        "cases": [vars(case) for case in ladder.cases],
        "rungs": [_rung_record(rung) for rung in ladder.rungs],
        "wall_s": ladder.seconds,
    }


def tiny(value: float, digits: int = 2) -> str:
    """Digits and an exponent; a plain 0 for nothing at all."""
    return "0" if value == 0 else f"{value:.{digits - 1}e}".replace("-", MINUS)


def _rung_record(rung: Rung) -> dict:
    found = vars(rung) | {"answer": None}
    if isinstance(rung, AnswerRung):
        found |= {"answer": rung.answer.name, "unit": rung.answer.unit, "error": rung.error}
    return found


def _remark(rung: AnswerRung) -> str:
    """The case's reason, and which of the values counts where that is not their limit."""
    if rung.answer.own_step:
        return f"{rung.reason}; at the engine's own time step alone"
    if rung.answer.every_step:
        return f"{rung.reason}; at any time step: the worst of the three"
    return rung.reason


def _concern(rung: Rung) -> tuple[bool, bool, float]:
    """To sort by: what fails last, before it what is refined, then by the share of the tolerance."""
    if not isinstance(rung, AnswerRung):
        return True, False, 0.0
    return rung.outcome != AGREES, not rung.answer.every_step, rung.share


def _worst(outcomes: list[str]) -> str:
    for outcome in (DIFFERS, NO_RESULT, NOT_COMPARABLE, NO_SUCH_LAW):
        if outcome in outcomes:
            return outcome
    return AGREES if outcomes else "nothing asked"
