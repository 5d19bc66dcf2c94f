"""What follows from estimates, by rules that several claims share."""

from __future__ import annotations

from .estimates import Estimate
from .study import CORRECTED, NOT_REPRODUCED, REPRODUCED, UNDECIDED

NO_EFFECT = 1.1  # a factor on the resistance: a change within it does not explain an "apparently smaller" one


def all_above(values: dict[str, Estimate], limit: float) -> str:
    """REPRODUCED where every interval lies above `limit`, NOT_REPRODUCED where one lies below."""
    known = [one for one in values.values() if one.known]
    if any(one.high < limit for one in known):
        return NOT_REPRODUCED
    return REPRODUCED if known and all(one.low > limit for one in known) else UNDECIDED


def raised(ratio: Estimate) -> str:
    """Whether the resistance rises by `ratio`: with a correction where that is by too little to explain anything."""
    if not ratio.known:
        return UNDECIDED
    if ratio.low > 1.0:
        return CORRECTED if ratio.high < NO_EFFECT else REPRODUCED
    return NOT_REPRODUCED if ratio.high < NO_EFFECT else UNDECIDED


def lowered(share: Estimate, force: Estimate) -> str:
    """Whether the fluctuation falls: by `share` of the resistance, and by `force` in newtons; with a correction where only
    the former does."""
    if not share.known or not force.known or share.low < 1.0 < share.high:
        return UNDECIDED
    if share.low >= 1.0:
        return NOT_REPRODUCED
    return REPRODUCED if force.high < 1.0 else CORRECTED if force.low > 1.0 else UNDECIDED
