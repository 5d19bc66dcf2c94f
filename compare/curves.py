"""Whole resistance curves of two codes: are they told apart, and at which depths?

Mean resistance per cm of depth, one curve per packing, paired by packing. No test uses the samples along the way as if
they were independent: neighbours are correlated over 0.4 cm, and a thousand of them are worth about twenty.

A difference found here is no disagreement: it may lie well within the margin. None found is no agreement: that needs the
band to lie within the margin.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats
from scipy.spatial.distance import cdist

from .margins import Check
from .pairing import ALPHA, BATCH, FEWEST_PACKINGS, RESAMPLES, SEED, shared_means, swap_test


@dataclass(frozen=True)
class CurveComparison:
    """What the curves of a pair say; differences are first engine - second."""

    pair: tuple[str, str]
    seeds: tuple[int, ...]  # of the packings that both ran
    p: float | None  # of the energy distance; None: too few packings
    # Indexed by depth_m, the bins' middles: difference_N, low_N and high_N (the band), margin_N (half width, NaN: none),
    # differs (the band leaves out 0), within and beyond (the whole band lies inside, outside the margin). None: too few
    # packings.
    table: pd.DataFrame | None
    identical: bool  # every curve of the one code is that of the other, to the last bit


def compare_curves(
    profiles: pd.DataFrame, pair: tuple[str, str], check: Check | None = None
) -> CurveComparison:
    """The `profiles` of an ensemble; `check` is that of the mean resistance, whose margin holds at each depth."""
    means = shared_means(profiles, pair)
    first, second = (means[engine].to_numpy(dtype=float) for engine in pair)
    seeds = tuple(int(seed) for seed in means[pair[0]].index)
    identical = bool(len(seeds) and np.array_equal(first, second))
    if len(seeds) < FEWEST_PACKINGS:
        return CurveComparison(pair, seeds, None, None, identical)
    table = band(first - second)
    table.index = profiles.columns.rename("depth_m")
    table["margin_N"] = margin_N(check, (first.mean(axis=0) + second.mean(axis=0)) / 2)
    table["differs"] = (table["low_N"] > 0) | (table["high_N"] < 0)
    table["within"] = (table["low_N"] > -table["margin_N"]) & (table["high_N"] < table["margin_N"])
    table["beyond"] = (table["low_N"] > table["margin_N"]) | (table["high_N"] < -table["margin_N"])
    return CurveComparison(pair, seeds, energy_test(first, second), table, identical)


def energy_test(first: np.ndarray, second: np.ndarray) -> float:
    """p value of the energy distance of paired samples of curves, a row each, the pairs swapped.

    E = 2 mean |a - b| - mean |a - a'| - mean |b - b'|, Euclidean, is 0 only for equal distributions (Szekely and Rizzo 2013).
    With s_i = -1 where pair i is swapped, E = -s M s / n^2, M_ij = |a_i - a_j| - |a_i - b_j| - |b_i - a_j| + |b_i - b_j|.
    """
    across = cdist(first, second)
    form = cdist(first, first) - across - across.T + cdist(second, second)

    def statistic(signs: np.ndarray) -> np.ndarray:
        energy = -((signs @ form) * signs).sum(axis=-1) / len(first) ** 2
        return np.maximum(energy, 0.0)  # but for round-off it is

    return float(swap_test(len(first), statistic).pvalue)


def band(differences_N: np.ndarray) -> pd.DataFrame:
    """Simultaneous band of the mean of `differences_N` (packings, depths): with 95 % all depths at once lie inside.

    mean -+ c standard errors, c the quantile of sup |mean* - mean| / standard error* of the bootstrap over packings.
    """
    mean_N, error_N = _mean_and_error(differences_N)
    largest = stats.bootstrap(
        (np.arange(len(differences_N)),),
        lambda rows, axis: _largest_t(differences_N, mean_N, np.moveaxis(rows, axis, -1)),
        vectorized=True,
        n_resamples=RESAMPLES,
        batch=BATCH,
        method="percentile",
        random_state=SEED,
    ).bootstrap_distribution
    half_N = np.quantile(largest, 1 - ALPHA) * error_N
    return pd.DataFrame(
        {"difference_N": mean_N, "low_N": mean_N - half_N, "high_N": mean_N + half_N}
    )


def margin_N(check: Check | None, mean_N: np.ndarray) -> np.ndarray:
    """Half width [N] of the margin about no difference, where the mean of both codes is `mean_N`."""
    if check is None:
        return np.full(len(mean_N), np.nan)
    if check.kind == "absolute":
        return np.full(len(mean_N), check.margin)
    share = check.margin
    if check.kind == "ratio":  # a = m b is a difference of 2 (m - 1) / (m + 1) of their mean
        share = 2 * (check.margin - 1) / (check.margin + 1)
    return share * np.abs(mean_N)


def _largest_t(differences_N: np.ndarray, mean_N: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """sup over depths of |t| of each resample, whose packings are `rows` (..., packings)."""
    resampled_N, error_N = _mean_and_error(differences_N[rows])
    off_N = np.abs(resampled_N - mean_N)
    return np.divide(off_N, error_N, out=np.zeros_like(off_N), where=error_N > 0).max(axis=-1)


def _mean_and_error(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean over the packings, the last axis but one, and its standard error."""
    return values.mean(axis=-2), values.std(axis=-2, ddof=1) / np.sqrt(values.shape[-2])
