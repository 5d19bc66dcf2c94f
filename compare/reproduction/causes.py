"""Section 4.4: the reasons that the paper gives for what it sees, tested by taking them away."""

from __future__ import annotations

from collections.abc import Sequence

from .changes import ratios
from .observation import SHARE
from .runs import Found
from .study import RESISTANCE, Claim, Setting
from .verdicts import NO_EFFECT, all_below, raised_enough

SECTION = "section 4.4"


def of_fluctuation(
    found: Found,
    settings: Sequence[Setting],
    says: str,
    how: str,
    also: tuple[str, str],
    why: str,
) -> Claim:
    """`settings` lack the reason: less of it from each to the next. `also`: another quantity, and what it is called."""
    shares = ratios(found, SHARE, settings)
    others = ratios(found, also[0], settings)
    changes = "; ".join(
        f"{name} {share.as_change()}, {also[1]} {others[name].as_change()}"
        for name, share in shares.items()
    )
    return Claim(
        SECTION,
        says,
        f"{how}: {changes}.",
        all_below(shares, 1.0),
        list(shares.values())[-1].as_change(),
        f"reproduced where {why}, each interval below no change",
    )


def of_low_resistance(
    found: Found, settings: Sequence[Setting], says: str, how: str, farthest: str
) -> Claim:
    """As above; the last of `settings` tells, and `farthest` calls it by its name."""
    changes = ratios(found, RESISTANCE, settings)
    last = list(changes.values())[-1]
    said = "; ".join(f"{name} {ratio.as_change()}" for name, ratio in changes.items())
    return Claim(
        SECTION,
        says,
        f"{how}: {said}.",
        raised_enough(last),
        last.as_change(),
        f"reproduced where {farthest} the resistance by more than {100 * (NO_EFFECT - 1):.0f} %; not where the interval lies "
        "below that; with a correction where it is raised, but by less",
    )
