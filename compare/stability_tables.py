"""The stability map in words and rows of text: what page and terminal show alike, and what the files hold."""

from __future__ import annotations

import math
from dataclasses import asdict

import pandas as pd

from .provenance import provenance
from .stability import FAILED, OUTCOMES, Scheme, StabilityMap, Trial
from .wording import DASH, listed

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
    """Up to where a bed rests, scheme by scheme."""
    limit = microseconds(found.bounds.eq32_s)
    names: dict[str, list[str]] = {}  # by how far they are quiet
    nowhere = []
    for scheme in found.schemes:
        if quiet_s := found.quiet_up_to_s(scheme):
            at_least = "at least " if found.perhaps_further(scheme) else ""
            names.setdefault(at_least + microseconds(quiet_s), []).append(scheme.name)
        elif found.loud_from_s(scheme):
            nowhere.append(scheme.name)
    allowed = f"Eq (32) of the paper allows {limit}."
    if not names:
        return f"No bed is known to rest at any of these time steps; {allowed}"
    said = [f"{quiet} ({', '.join(schemes)})" for quiet, schemes in names.items()]
    unrested = f"; nowhere here under {listed(nowhere)}" if nowhere else ""
    return f"A packed bed rests up to {listed(said)}{unrested}; {allowed}"


def remarks(found: StabilityMap) -> list[tuple[str, str]]:
    """By scheme, what is not on the map: those left out, and runs that failed, each reason once."""
    left_out = [(name, f"left out: {why}") for name, why in found.left_out.items()]
    failed = [(trial.scheme, trial.why) for trial in found.trials if trial.outcome == FAILED]
    return left_out + list(dict.fromkeys(failed))


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
                "perhaps_further": found.perhaps_further(scheme),
                "blown_up_from_s": found.blown_up_from_s(scheme),
                "linear_bound_s": found.bounds.of(scheme),
            }
            for scheme in found.schemes
        ],
        "left_out": found.left_out,
        "provenance": asdict(provenance(found.manifests)),
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
    """ "100 µs"; a dash for a bound that there is not."""
    return f"{1e6 * step_s:.3g} \N{MICRO SIGN}s" if math.isfinite(step_s) else DASH


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
