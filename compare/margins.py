"""What a case declares about its quantities: [[check]] tables, their margins, and the scale of their differences."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .quantities import QUANTITIES, Quantity, check_tables

# What the stated scatter weighs beside the measured one, in degrees of freedom. Known by four, a scatter is twice as large
# 1 time in 10, as that of a user's case may well be.
STATED_DEGREES = 4
# An engine counts as scattering at most this many times as much as the other, or as is stated: that one of two codes
# scatters wildly is a difference, and no excuse for another.
MOST_TIMES_CALMER = 3


@dataclass(frozen=True)
class Check:
    """One [[check]] table of the case.

    kind "relative": difference over the mean of both engines' means; "absolute": in the quantity's unit; "ratio": the
    quotient, for which margin and seed_scatter are factors above 1 (1.33: within 1/1.33 .. 1.33).
    """

    quantity: Quantity
    kind: str
    margin: float
    seed_scatter: float  # standard deviation from seed to seed of one run: above that of a mean over twins
    reason: str

    @staticmethod
    def of_case(case: dict) -> list[Check]:
        """The checks of a resolved case without faults."""
        return [
            Check(**{**entry, "quantity": QUANTITIES[entry["quantity"]]})
            for entry in case.get("check", [])
        ]

    def on_scale(self, value: float) -> float:
        """A margin or scatter on the scale of the differences: the logarithm for quotients."""
        return math.log(value) if self.kind == "ratio" else value

    def scatter(self, *engines: np.ndarray) -> tuple[float, int]:
        """Standard deviation of one run from seed to seed, on the scale of the differences, and its degrees of freedom.

        The one stated, pooled with those of each engine's values: what the case states was measured on the case as it
        stands, and a variant of it may scatter more.
        """
        stated = self.on_scale(self.seed_scatter)
        measured = [self._scatter_of(values) for values in engines]
        most = MOST_TIMES_CALMER * max(stated, min(scatter for scatter, _ in measured))
        pooled = [(stated, STATED_DEGREES)] + [(min(one, most), known) for one, known in measured]
        degrees = sum(known for _, known in pooled)
        return math.sqrt(sum(known * one**2 for one, known in pooled) / degrees), degrees

    def _scatter_of(self, values: np.ndarray) -> tuple[float, int]:
        """That of one engine's packings, and its degrees of freedom, which are 0 where they do not tell."""
        values = values[values > 0 if self.kind == "ratio" else np.isfinite(values)]
        if len(values) < 2:
            return 0.0, 0
        scatter = np.log(values).std(ddof=1) if self.kind == "ratio" else values.std(ddof=1)
        unit = abs(values.mean()) if self.kind == "relative" else 1.0
        told = unit > 0 and np.isfinite(scatter)
        return (float(scatter / unit), len(values) - 1) if told else (0.0, 0)

    def differences(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Paired differences a - b, on the scale of the kind; NaN or infinite where it has no meaning."""
        if self.kind == "absolute" or not len(a):
            return a - b
        if self.kind == "ratio":
            return np.log(np.where(a > 0, a, np.nan)) - np.log(np.where(b > 0, b, np.nan))
        mean = abs(a.mean() + b.mean()) / 2
        return (a - b) / (mean if mean > 0 else np.nan)


def check_faults(case: dict) -> list[str]:
    """A fault line for each factor of a ratio check that is not above 1, which the units of the schema cannot see."""
    return [
        f"check[{number}].{key}: {entry[key]:g} is not a factor above 1, as kind 'ratio' needs"
        for number, entry in check_tables(case)
        if entry.get("kind") == "ratio"
        for key in ("margin", "seed_scatter")
        if isinstance(entry.get(key), (int, float)) and 0 < entry[key] <= 1
    ]
