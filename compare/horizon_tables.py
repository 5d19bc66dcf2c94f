"""The horizon in words and rows of text: what pages and the terminal show alike, and what the files hold."""

from __future__ import annotations

from typing import NamedTuple

import pandas as pd

from crossdem.adapters.packing import SHIFT_M

from . import outcomes, wording
from .horizon import (
    COMPARED_S,
    EARLY_SHARE,
    LIMIT_M,
    LOST_SHARE,
    NOTICED_M,
    EngineHorizon,
    Horizon,
)

DASH = "\N{EN DASH}"
COLUMNS = (
    "engine",
    "outcome",
    "difference to its native scheme",
    "growth",
    f"twin {wording.metres(NOTICED_M)} off",
    "horizon",
)
DEFINITION = (
    f"Twin: the same packing with one particle shifted by {wording.metres(SHIFT_M)}. Horizon: when any particle is "
    f"{100 * LOST_SHARE:g} % of the smallest radius away from its place in the twin run; before it, codes that do the "
    f"same steps can be compared particle by particle, after it only statistically. Each engine must stay within "
    f"{wording.metres(LIMIT_M)} of the native scheme of its name for {COMPARED_S:g} s from the packing, or as long as the "
    f"twin of that scheme stays within {wording.metres(NOTICED_M)}; its own twin may not leave that in less than "
    f"{100 * EARLY_SHARE:g} % of the time that the scheme's takes."
)


class Row(NamedTuple):
    """One engine: COLUMNS, and a remark."""

    engine: str
    outcome: str  # of the engine, or a dash where there is nothing to agree with
    difference: str  # to the native scheme of its name
    rate: str
    noticed: str
    horizon: str
    remark: str


def values(horizon: Horizon) -> dict:
    """What any text shows of a horizon."""
    return {
        "seed": horizon.seed,
        "shift": wording.metres(SHIFT_M),
        "sentence": sentence(horizon),
        "definition": DEFINITION,
        "columns": COLUMNS,
        "rows": rows(horizon),
    }


def rows(horizon: Horizon) -> list[Row]:
    return [_row(one, horizon.recorded_s) for one in horizon.engines]


def sentence(horizon: Horizon) -> str:
    """What was found, in one go."""
    if horizon.strays:
        return "; ".join(horizon.strays) + "."
    parts = [f"On the packing of seed {horizon.seed}, {_reach(horizon)}"]
    compared = [one for one in horizon.engines if one.outcome == outcomes.AGREES]
    if compared:
        names = wording.listed([one.engine for one in compared])
        does = f"{names} does" if len(compared) == 1 else f"each of {names} does"
        until_s = min(one.closeness.until_s for one in compared)
        largest_m = max(one.closeness.largest_m for one in compared)
        parts.append(
            f"until {until_s:.2g} s {does} what the native scheme of its name does, to {_metres(largest_m)}"
        )
    else:
        parts.append("no engine was compared in this way")
    silent = [
        one for one in horizon.engines if one.obstacle or one.outcome == outcomes.NOT_COMPARABLE
    ]
    parts += [f"{one.engine}: {one.outcome}, {(one.reason or '').rstrip('.')}" for one in silent]
    return "; ".join(parts) + "."


def _reach(horizon: Horizon) -> str:
    """Up to when a comparison means something: until the first horizon of any engine or native scheme."""
    grown = [
        growth for one in horizon.engines for growth in (one.growth, one.scheme_growth) if growth
    ]
    if not grown:
        return "nothing could be measured"
    known = [growth.horizon_s for growth in grown if growth.horizon_s is not None]
    if not known:
        return f"no run comes to its horizon within the {horizon.recorded_s:.3g} s recorded"
    return f"particle by particle a comparison means something up to {min(known):.2g} s"


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
        "noticed_m": NOTICED_M,
        "runs": list(horizon.runs),
        "engines": [_record(one) for one in horizon.engines],
    }


def _row(one: EngineHorizon, recorded_s: float) -> Row:
    outcome, remark = one.outcome or DASH, one.stray or one.reason or ""
    if not one.outcome:
        remark = "compared with its own twin only"
    if one.growth is None:
        return Row(one.engine, outcome, *[DASH] * 4, remark)
    difference, rate = DASH, one.growth.rate_1_s
    if one.closeness and one.closeness.frames:
        difference = f"{_metres(one.closeness.largest_m)} up to {one.closeness.until_s:.2g} s"
    return Row(
        one.engine,
        outcome,
        difference,
        f"{rate:.3g} /s" if rate is not None else DASH,
        _time(one.growth.noticed_s, recorded_s),
        _time(one.growth.horizon_s, recorded_s),
        remark,
    )


def _record(one: EngineHorizon) -> dict:
    entry = {"engine": one.engine, "outcome": one.outcome, "reason": one.stray or one.reason}
    if one.growth:
        entry |= {
            "growth_rate_1_s": one.growth.rate_1_s,
            "noticed_s": one.growth.noticed_s,
            "horizon_s": one.growth.horizon_s,
        }
    if one.scheme_growth:
        entry |= {
            "native_scheme_noticed_s": one.scheme_growth.noticed_s,
            "native_scheme_horizon_s": one.scheme_growth.horizon_s,
        }
    if one.closeness:
        entry |= {
            "native_scheme": one.closeness.scheme,
            "largest_difference_m": one.closeness.largest_m,
            "compared_until_s": one.closeness.until_s,
            "compared_frames": one.closeness.frames,
            "beyond_limit_s": one.closeness.beyond_s,
        }
    return entry


def _time(value_s: float | None, recorded_s: float) -> str:
    return f"later than {recorded_s:.3g} s" if value_s is None else f"{value_s:.3g} s"


def _metres(value_m: float) -> str:
    return "0 m, bit by bit" if value_m == 0 else wording.metres(value_m)
