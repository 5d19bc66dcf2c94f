"""The opinions as rows of text for page and Markdown, and as plain data for report.json."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pandas as pd

from . import theory, wording
from .checks import CheckResult, by_check
from .consensus import FEWEST_ENGINES, apart
from .curves import CurveComparison
from .fields import FieldComparison
from .opinions import Opinions
from .pairing import ALPHA, FEWEST_PACKINGS
from .quantities import QUANTITIES
from .wording import DASH, listed, number, plural, probability, signed_difference

DIRECTIONS = {"x": ("to the right", "to the left"), "y": ("up", "down")}  # of a difference > 0, < 0
TONES = {
    theory.INSIDE: "agrees",
    theory.OUTSIDE: "differs",
    theory.OPEN: "inconclusive",
}  # report.css


class PairRow(NamedTuple):
    """One pair of engines, in its curves or fields."""

    pair: str
    cells: list[str]
    sentence: str


class ConsensusCell(NamedTuple):
    """One engine against the others, in one check."""

    outcome: str
    difference: str
    interval: str
    explanation: str
    apart: bool  # it is the one that stands apart


class ConsensusRow(NamedTuple):
    """One check: a cell for each engine."""

    title: str
    margin: str
    cells: list[ConsensusCell]


class TheoryRow(NamedTuple):
    """One window on one engine."""

    title: str
    window: str
    engine: str
    mean: str
    interval: str
    word: str
    tone: str


def values(opinions: Opinions) -> dict:
    """What both templates show."""
    return {
        "margin": wording.margin(opinions.margin) if opinions.margin else None,
        "curves": [_curve_row(one, opinions) for one in opinions.curves],
        "fields": [_field_row(one) for one in opinions.fields],
        "engines": opinions.engines,
        "consensus": _consensus_rows(opinions.consensus),
        "dragged": "half" if len(opinions.engines) == 3 else f"1/{len(opinions.engines) - 1}",
        "fewest_engines": FEWEST_ENGINES,
        "consensus_packings": plural(len(opinions.consensus[0].seeds), "packing")
        if opinions.consensus
        else "",
        "theory": [_theory_row(one) for one in opinions.theory],
        "sources": [(QUANTITIES[one.quantity].title, one.source) for one in theory.WINDOWS],
        "holds": theory.HOLDS,
    }


def curve_sentence(curves: CurveComparison, margin: str | None) -> str:
    """At which depths the codes differ, and where they are shown to be equal to within the margin."""
    if curves.identical:
        return "The same curves to the last bit."
    if curves.table is None:
        return _too_few(len(curves.seeds), "curves")
    table = curves.table
    differ = _depths(table, table["differs"])
    sentence = "No difference is shown at any depth"
    if differ:
        sentence = f"Differ at {differ}"
        sentence += "" if table["differs"].all() else "; elsewhere no difference is shown"
    if margin is None:
        return f"{sentence}. The case states no margin for the mean resistance."
    states = {
        f"equal to within {margin}": table["within"],
        f"unlike by more than {margin}": table["beyond"],
        "open": ~(table["within"] | table["beyond"]),
    }
    shown = "; ".join(f"{say} at {_depths(table, at)}" for say, at in states.items() if at.any())
    return f"{sentence}. {shown[0].upper()}{shown[1:]}."


def field_sentence(fields: FieldComparison) -> str:
    """Which cells stand out."""
    if fields.cells is None:
        return _too_few(len(fields.seeds), "fields")
    standing = fields.cells[fields.cells["p"] <= ALPHA]
    if standing.empty:
        return "No cell stands out; that is no agreement yet."
    worst = standing["t"].abs().idxmax()
    component, x_m, y_m = worst
    difference_mm = 1000 * standing.loc[worst, "difference_m"]
    places = len({(x, y) for _, x, y in standing.index})
    further = f"{number(abs(difference_mm), 2)} mm further {DIRECTIONS[component][int(difference_mm < 0)]}"
    return (
        f"{plural(places, 'cell stands', 'cells stand')} out, most of all that at x = {100 * x_m:g} cm, "
        f"y = {100 * y_m:g} cm, which {fields.pair[0]} moves {further}."
    )


def record(opinions: Opinions) -> dict:
    """The keys curves, fields, consensus and theory of report.json; lengths in m, forces in N."""
    return {
        "curves": [
            {
                "pair": one.pair,
                "seeds": one.seeds,
                "p": one.p,
                "identical": one.identical,
                "depths": _rows(one.table),
                "sentence": _curve_row(one, opinions).sentence,
            }
            for one in opinions.curves
        ],
        "fields": [
            {
                "pair": one.pair,
                "seeds": one.seeds,
                "p": one.p,
                "difference": one.share,
                "difference_of_halves": one.share_of_codes,
                "split_half": one.share_of_packings,
                "ratio": one.ratio,
                "cells_left_out": one.left_out,
                "cells": _rows(None if one.cells is None else one.cells[one.cells["p"] <= ALPHA]),
                "sentence": field_sentence(one),
            }
            for one in opinions.fields
        ],
        "consensus": [
            {
                "engine": one.pair[0],
                "quantity": check.quantity.name,
                "kind": check.kind,
                "margin": check.margin,
                "outcome": one.outcome,
                "stands_apart": one.pair[0] == apart(of_check),
                "seeds": one.seeds,
                "difference": one.difference,
                "interval_90": one.interval,
                "explanation": wording.explanation(one),
            }
            for check, of_check in by_check(opinions.consensus).items()
            for one in of_check
        ],
        "theory": [
            {key: value for key, value in vars(one).items() if key != "window"} | vars(one.window)
            for one in opinions.theory
        ],
    }


def _curve_row(curves: CurveComparison, opinions: Opinions) -> PairRow:
    margin = wording.margin(opinions.margin) if opinions.margin else None
    cells = [str(len(curves.seeds)), DASH if curves.p is None else probability(curves.p)]
    return PairRow(_pair(curves.pair), cells, curve_sentence(curves, margin))


def _field_row(fields: FieldComparison) -> PairRow:
    shares = (fields.share, fields.share_of_codes, fields.share_of_packings)
    cells = [
        str(len(fields.seeds)),
        *(DASH if math.isnan(share) else f"{100 * share:.1f} %" for share in shares),
        DASH if math.isnan(fields.ratio) else f"{fields.ratio:.2f}",
        DASH if fields.p is None else probability(fields.p),
    ]
    return PairRow(_pair(fields.pair), cells, field_sentence(fields))


def _consensus_rows(results: tuple[CheckResult, ...]) -> list[ConsensusRow]:
    return [
        ConsensusRow(
            check.quantity.title,
            wording.margin(check),
            [_consensus_cell(one, apart(of_check)) for one in of_check],
        )
        for check, of_check in by_check(results).items()
    ]


def _consensus_cell(one: CheckResult, furthest: str | None) -> ConsensusCell:
    return ConsensusCell(
        one.outcome,
        signed_difference(one.check, one.difference),
        wording.interval(one),
        wording.explanation(one),
        one.pair[0] == furthest,
    )


def _theory_row(opinion: theory.Opinion) -> TheoryRow:
    window = opinion.window
    return TheoryRow(
        QUANTITIES[window.quantity].title,
        f"{window.low:g} to {window.high:g}",
        opinion.engine,
        number(opinion.mean),
        " to ".join(map(number, opinion.interval)) if opinion.interval else DASH,
        opinion.word,
        TONES[opinion.word],
    )


def _pair(pair: tuple[str, str]) -> str:
    return " against ".join(pair)


def _too_few(packings: int, what: str) -> str:
    return (
        f"{plural(packings, 'packing that both ran is', 'packings that both ran are')} too few to tell {what} apart: "
        f"it takes {FEWEST_PACKINGS}."
    )


def _depths(table: pd.DataFrame, at: pd.Series) -> str:
    """The bins that are true in `at`, as "0–2 and 4–5 cm"; nothing for none."""
    if at.all():
        return "all depths"
    bins = np.flatnonzero(at)
    if not len(bins):
        return ""
    middles_cm = 100 * table.index.to_numpy()
    half_cm = (middles_cm[1] - middles_cm[0]) / 2
    spans = np.split(bins, np.flatnonzero(np.diff(bins) > 1) + 1)
    ends_cm = [(middles_cm[span[0]] - half_cm, middles_cm[span[-1]] + half_cm) for span in spans]
    return f"{listed([DASH.join(f'{round(end, 6):g}' for end in ends) for ends in ends_cm])} cm"


def _rows(table: pd.DataFrame | None) -> list[dict] | None:
    return None if table is None else table.reset_index().to_dict("records")
