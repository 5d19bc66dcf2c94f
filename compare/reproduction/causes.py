"""Section 4.4: the reasons that the paper gives for what it sees, tested by taking them away."""

from __future__ import annotations

from collections.abc import Sequence

from .changes import ratios
from .observation import FLUCTUATION, SHARE
from .runs import Found
from .study import RESISTANCE, Claim, Setting
from .verdicts import NO_EFFECT, lowered, raised

SECTION = "section 4.4"


def of_fluctuation(
    found: Found, settings: Sequence[Setting], says: str, how: str, farthest: str
) -> Claim:
    """`settings` lack the reason, each more than the one before; the last tells, and `farthest` calls it by its name."""
    shares = ratios(found, SHARE, settings)
    forces = ratios(found, FLUCTUATION, settings)
    last = settings[-1].name
    said = "; ".join(
        f"{name} {share.as_change()}, in newtons {forces[name].as_change()}"
        for name, share in shares.items()
    )
    return Claim(
        SECTION,
        says,
        f"{how}, as a share of the resistance: {said}.",
        lowered(shares[last], forces[last]),
        shares[last].as_change(),
        f"reproduced where {farthest} fluctuate less, both as a share of the resistance and in newtons, the interval below no "
        "change; with a correction where only the share is less",
    )


def of_low_resistance(
    found: Found, settings: Sequence[Setting], says: str, how: str, farthest: str
) -> Claim:
    """As above."""
    changes = ratios(found, RESISTANCE, settings)
    last = changes[settings[-1].name]
    said = "; ".join(f"{name} {ratio.as_change()}" for name, ratio in changes.items())
    return Claim(
        SECTION,
        says,
        f"{how}: {said}.",
        raised(last),
        last.as_change(),
        f"reproduced where {farthest} the resistance, the interval above no change; with a correction where that is by less than "
        f"{100 * (NO_EFFECT - 1):.0f} %",
    )
