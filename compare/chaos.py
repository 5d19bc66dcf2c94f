"""How much of the scatter is the bed, and how much is chaos: packings against their twins.

Twins start 1e-12 m apart and drift apart within a second, so that what they scatter is chaos alone. A one-way analysis
of variance splits the scatter of single runs into that within packings and that between them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats

from .ensemble import PACKING


@dataclass(frozen=True)
class Scatter:
    """Of one quantity in one engine; standard deviations in its unit."""

    between: float  # from bed to bed, without chaos; 0 where chaos alone explains what is seen
    within: float  # from twin to twin

    @property
    def share_of_beds(self) -> float:
        """Intraclass correlation: the share of the beds in the variance of single runs, 0 to 1; NaN without scatter."""
        variance = self.between**2 + self.within**2
        return self.between**2 / variance if variance > 0 else math.nan


def scatter(values: pd.Series) -> Scatter | None:
    """`values` by seed and twin; None where fewer than two packings have twins, or a run has no value."""
    groups = [group.to_numpy(dtype=float) for _, group in values.groupby(level="seed")]
    sizes = np.array([len(group) for group in groups])
    if (sizes > 1).sum() < 2 or values.isna().any():
        return None
    runs, beds = sizes.sum(), len(groups)
    within = sum(((group - group.mean()) ** 2).sum() for group in groups) / (runs - beds)
    if within <= 0:
        return Scatter(float(np.std([group.mean() for group in groups], ddof=1)), 0.0)
    runs_per_bed = (runs - (sizes**2).sum() / runs) / (
        beds - 1
    )  # the mean, but for unequal numbers
    ratio = stats.f_oneway(*groups).statistic
    return Scatter(math.sqrt(within * max(0.0, ratio - 1) / runs_per_bed), math.sqrt(within))


def scatters(endpoints: pd.DataFrame, quantity: str) -> dict[str, Scatter | None]:
    """By engine, of an ensemble's endpoints."""
    return {
        engine: scatter(values.droplevel("engine"))
        for engine, values in endpoints[quantity].groupby(level=PACKING[0], sort=False)
    }
