"""Means over packings with their 95 % intervals by Student's t: the packing is what is independent."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats

from ..wording import MINUS, number

LEVEL = 0.95


@dataclass(frozen=True)
class Estimate:
    """A mean and the ends of its interval; NaN where there are too few values for them."""

    mean: float
    low: float
    high: float
    packings: int

    @property
    def known(self) -> bool:
        return math.isfinite(self.low)

    def shown(self, factor: float = 1.0, unit: str = "") -> str:
        """ "0.954 (0.93 to 0.98) N"."""
        ends = (
            f" ({number(factor * self.low)} to {number(factor * self.high)})" if self.known else ""
        )
        return f"{number(factor * self.mean)}{ends} {unit}".rstrip()

    def as_change(self) -> str:
        """Of a ratio: "+12 % (+3 to +21)"."""
        shown = [
            f"{100 * (value - 1):+.0f}".replace("-", MINUS)
            for value in (self.mean, self.low, self.high)
        ]
        return f"{shown[0]} % ({shown[1]} to {shown[2]})" if self.known else f"{shown[0]} %"


def mean_of(values: pd.Series) -> Estimate:
    """Of one value per packing; those that are not finite are left out."""
    values = values[np.isfinite(values)].to_numpy(dtype=float)
    if len(values) < 2:
        mean = float(values[0]) if len(values) else math.nan
        return Estimate(mean, math.nan, math.nan, len(values))
    half = stats.t.ppf((1 + LEVEL) / 2, len(values) - 1) * stats.sem(values)
    return Estimate(values.mean(), values.mean() - half, values.mean() + half, len(values))


def difference_of(values: pd.Series, base: pd.Series) -> Estimate:
    """Of `values` less `base`, packing by packing: both are indexed by the seed of the same beds."""
    return mean_of((values - base).dropna())


def ratio_of(values: pd.Series, base: pd.Series) -> Estimate:
    """Of the means of two independent samples: Welch's t of the means' relative errors, on a logarithmic scale.

    NaN where a mean is not above 0; without an interval where a sample has fewer than two packings.
    """
    samples = [one[np.isfinite(one)].to_numpy(dtype=float) for one in (values, base)]
    packings = min(map(len, samples))
    means = [sample.mean() if len(sample) else math.nan for sample in samples]
    if not all(mean > 0 for mean in means):
        return Estimate(math.nan, math.nan, math.nan, packings)
    ratio = means[0] / means[1]
    if packings < 2:
        return Estimate(ratio, math.nan, math.nan, packings)
    parts = [(stats.sem(sample) / mean) ** 2 for sample, mean in zip(samples, means)]
    if sum(parts) == 0:
        return Estimate(ratio, ratio, ratio, packings)
    freedom = sum(parts) ** 2 / sum(part**2 / (len(one) - 1) for part, one in zip(parts, samples))
    half = math.exp(stats.t.ppf((1 + LEVEL) / 2, freedom) * math.sqrt(sum(parts)))
    return Estimate(ratio, ratio / half, ratio * half, packings)
