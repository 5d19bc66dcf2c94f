"""What is said of several codes beside the verdict, and changes nothing in it: where they differ, and what theory expects.

A verdict is about margins. What is significant here may lie well within them, and then is no disagreement: it says where
to look.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

from crossdem.adapters.case import Case

from . import theory
from .checks import CheckResult
from .consensus import leave_one_out
from .curves import CurveComparison, compare_curves
from .ensemble import Ensemble
from .fields import FieldComparison, compare_fields
from .intake import obstacles
from .margins import Check
from .pairing import sound


@dataclass(frozen=True)
class Opinions:
    """All of them, of one comparison. Runs that failed a gate take no part, and are no consensus."""

    engines: tuple[str, ...]  # with runs
    margin: Check | None  # that of the mean resistance, which holds for the curves, too
    curves: tuple[CurveComparison, ...]  # of each pair of engines
    fields: tuple[FieldComparison, ...]  # likewise
    consensus: tuple[CheckResult, ...]  # nothing for fewer than three engines
    theory: tuple[theory.Opinion, ...]

    @classmethod
    def of(cls, case: Case, ensemble: Ensemble, failures: dict[tuple[str, int], str]) -> "Opinions":
        """`failures` says for each (engine, seed) without result why."""
        manifests, ensemble = ensemble.manifests, sound(ensemble)
        engines = ensemble.engines
        # the later engine first, as the checks have it
        pairs = [(first, second) for second, first in itertools.combinations(engines, 2)]
        checks = Check.of_case(case.resolved)
        margin = next((one for one in checks if one.quantity.name == "mean_resistance_N"), None)
        return cls(
            engines,
            margin,
            tuple(compare_curves(ensemble.profiles, pair, margin) for pair in pairs),
            tuple(compare_fields(ensemble.fields, pair) for pair in pairs),
            tuple(
                leave_one_out(
                    checks, ensemble.endpoints, engines, obstacles(engines, manifests, failures)
                )
            ),
            tuple(theory.opinions(ensemble.endpoints, engines)),
        )
