"""The horizon in words and rows of text: what pages and the terminal show alike, and what the files hold."""

from __future__ import annotations

from typing import NamedTuple

import pandas as pd

from . import wording
from .horizon import COMPARED_S, LIMIT_M, LOST_SHARE, NOTICED_M, SHIFT_M, EngineHorizon, Horizon

DASH = "\N{EN DASH}"
NOT_COMPARABLE = "not comparable"
DEFINITION = (
    f"Twin: the same packing with one particle shifted by {wording.metres(SHIFT_M)}. Horizon: when any particle is "
    f"{100 * LOST_SHARE:g} % of the smallest radius away from its place in the twin run; before it, codes that do the "
    f"same steps can be compared particle by particle, after it only statistically. Each engine must stay within "
    f"{wording.metres(LIMIT_M)} of the native scheme of its name for {COMPARED_S:g} s from the packing, or as long as its twin "
    f"stays within {wording.metres(NOTICED_M)}."
)


class Row(NamedTuple):
    """One engine."""

    engine: str
    outcome: str  # agrees, differs, not comparable, or a dash where there is nothing to agree with
    difference: str  # to the native scheme of its name
    rate: str
    noticed: str
    horizon: str
    remark: str


def values(horizon: Horizon) -> dict:
    """What any text shows of a horizon."""
    return {
        "seed": horizon.seed,
        "sentence": sentence(horizon),
        "definition": DEFINITION,
        "rows": rows(horizon),
    }


def rows(horizon: Horizon) -> list[Row]:
    return [_row(one, horizon.recorded_s) for one in horizon.engines]


def sentence(horizon: Horizon) -> str:
    """What was found, in one go."""
    if horizon.strays:
        return "; ".join(horizon.strays) + "."
    compared = [one for one in horizon.engines if one.closeness]
    ends = [one.growth.horizon_s for one in horizon.engines if one.growth]
    when = "Nothing could be measured"
    if ends:
        known = [end for end in ends if end is not None]
        when = (
            f"Particle by particle a comparison means something up to {min(known):.2g} s after the packing"
            if known
            else f"Within the {horizon.recorded_s:.3g} s recorded no run comes to its horizon"
        )
    if not compared:
        return f"{when}."
    largest = max(compared, key=lambda one: one.closeness.largest_m)
    names = wording.listed([one.engine for one in compared])
    verb = "does" if len(compared) == 1 else "do"
    return (
        f"{when}; until {largest.closeness.until_s:.2g} s {names} {verb} what the native scheme of that name does, "
        f"to {_metres(largest.closeness.largest_m)}."
    )


def curves(horizon: Horizon) -> pd.DataFrame:
    """Every curve, for horizon.csv: one row per engine and frame."""
    tables = [
        pd.DataFrame(
            {
                "engine": one.engine,
                "time_s": one.growth.time_s,
                "twin_drift_m": one.growth.drift_m,
                "difference_to_native_scheme_m": one.closeness.difference_m
                if one.closeness
                else float("nan"),
            }
        )
        for one in horizon.engines
        if one.growth
    ]
    return pd.concat(tables, ignore_index=True) if tables else pd.DataFrame()


def record(horizon: Horizon) -> dict:
    """Every number but the curves, for other programs."""
    return {
        "seed": horizon.seed,
        "recorded_s": horizon.recorded_s,
        "shift_m": SHIFT_M,
        "limit_m": LIMIT_M,
        "engines": [_record(one) for one in horizon.engines],
    }


def _row(one: EngineHorizon, recorded_s: float) -> Row:
    if one.growth is None:
        return Row(one.engine, NOT_COMPARABLE, *[DASH] * 4, one.obstacle or "")
    close, rate = one.closeness, one.growth.rate_1_s
    outcome, difference, remark = DASH, DASH, "compared with its own twin only"
    if close:
        outcome, remark = ("differs", one.stray) if one.stray else ("agrees", "")
        difference = f"{_metres(close.largest_m)} up to {close.until_s:.2g} s"
    return Row(
        one.engine,
        outcome,
        difference,
        f"{rate[0]:.3g} ± {rate[1]:.1g} /s" if rate else DASH,
        _time(one.growth.noticed_s, recorded_s),
        _time(one.growth.horizon_s, recorded_s),
        remark,
    )


def _record(one: EngineHorizon) -> dict:
    entry = {"engine": one.engine, "obstacle": one.obstacle}
    if one.growth:
        rate = one.growth.rate_1_s or (None, None)
        entry |= {
            "growth_rate_1_s": rate[0],
            "growth_rate_standard_error_1_s": rate[1],
            "noticed_s": one.growth.noticed_s,
            "horizon_s": one.growth.horizon_s,
        }
    if one.closeness:
        entry |= {
            "native_scheme": one.closeness.scheme,
            "largest_difference_m": one.closeness.largest_m,
            "compared_until_s": one.closeness.until_s,
            "beyond_limit_s": one.closeness.beyond_s,
        }
    return entry


def _time(value_s: float | None, recorded_s: float) -> str:
    return f"later than {recorded_s:.3g} s" if value_s is None else f"{value_s:.3g} s"


def _metres(value_m: float) -> str:
    return "0 m, bit by bit" if value_m == 0 else wording.metres(value_m)
