"""The stability map in words and rows of text: what page and terminal show alike, and what the files hold."""

from __future__ import annotations

from dataclasses import asdict

import pandas as pd

from .stability import OUTCOMES, Scheme, StabilityMap, Trial
from .wording import listed

DASH = "\N{EN DASH}"
NOWHERE = "nowhere here"
TITLES = (
    "scheme",
    "quiet up to",
    "not quiet from",
    "linear bound",
    "blown up from",
    "quiet up to, share of Eq (32)",
)


def rows(found: StabilityMap) -> list[tuple[str, ...]]:
    """Of each scheme: TITLES."""
    return [_row(found, scheme) for scheme in found.schemes]


def sentence(found: StabilityMap) -> str:
    limit = microseconds(found.bounds.eq32_s)
    names: dict[str, list[str]] = {}  # by the time step up to which they are quiet
    for scheme in found.schemes:
        if quiet_s := found.quiet_up_to_s(scheme):
            names.setdefault(microseconds(quiet_s), []).append(scheme.name)
    if not names:
        return f"Nothing rests at any of these time steps; Eq (32) of the paper allows {limit}."
    said = [f"{quiet} ({', '.join(schemes)})" for quiet, schemes in names.items()]
    return f"A packed bed rests up to {listed(said)}; Eq (32) of the paper allows {limit}."


def table(found: StabilityMap) -> pd.DataFrame:
    """Every bed, for stability.csv."""
    return pd.DataFrame([asdict(trial) for trial in found.trials])


def record(found: StabilityMap) -> dict:
    return {
        "rest_s": found.rest_s,
        "bounds": asdict(found.bounds),
        "schemes": [
            {
                "name": scheme.name,
                "overrides": scheme.overrides,
                "quiet_up_to_s": found.quiet_up_to_s(scheme),
                "blown_up_from_s": found.blown_up_from_s(scheme),
                "linear_bound_s": found.bounds.of(scheme),
            }
            for scheme in found.schemes
        ],
        "trials": [asdict(trial) for trial in found.trials],
    }


def trial_rows(found: StabilityMap) -> list[tuple[str, list[str]]]:
    """Of each time step: what became of the beds of each scheme."""
    steps = sorted({trial.step_s for trial in found.trials})
    return [
        (
            microseconds(step_s),
            [
                _told([t for t in found.of(scheme) if t.step_s == step_s])
                for scheme in found.schemes
            ],
        )
        for step_s in steps
    ]


def microseconds(step_s: float) -> str:
    return f"{1e6 * step_s:.3g} \N{MICRO SIGN}s"


def _row(found: StabilityMap, scheme: Scheme) -> tuple[str, ...]:
    quiet_s, loud_s = found.quiet_up_to_s(scheme), found.loud_from_s(scheme)
    blown_s = found.blown_up_from_s(scheme)
    return (
        scheme.name,
        microseconds(quiet_s) if quiet_s else NOWHERE,
        microseconds(loud_s) if loud_s else NOWHERE,
        microseconds(found.bounds.of(scheme)),
        microseconds(blown_s) if blown_s else NOWHERE,
        f"{quiet_s / found.bounds.eq32_s:.2f}" if quiet_s else DASH,
    )


def _told(trials: list[Trial]) -> str:
    """ "quiet, 3e-11 J": the worst of the beds."""
    worst = max(trials, key=lambda trial: (OUTCOMES.index(trial.outcome), trial.kinetic_energy_J))
    if worst.why:
        return worst.outcome
    return f"{worst.outcome}, {worst.kinetic_energy_J:.1e} J"
