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


def all_below(values: dict[str, Estimate], limit: float) -> str:
    """The other way round."""
    mirrored = {
        name: Estimate(-one.mean, -one.high, -one.low, one.packings) for name, one in values.items()
    }
    return all_above(mirrored, -limit)


def raised_enough(ratio: Estimate) -> str:
    """Whether a change of the resistance by `ratio` explains that it was too low: more than NO_EFFECT, or not."""
    if not ratio.known:
        return UNDECIDED
    if ratio.low > NO_EFFECT:
        return REPRODUCED
    if ratio.high < NO_EFFECT:
        return CORRECTED if ratio.low > 1.0 else NOT_REPRODUCED
    return UNDECIDED
