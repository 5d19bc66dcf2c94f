"""What of an ensemble two or more codes can be compared by, and how their labels are swapped.

Codes meet on the runs that each of them made from the same bed: same packing, same twin. Packings are independent of one
another, so they are what is counted; the twins of a packing are averaged, and equally many of each code, for a mean over
three twins scatters less than one run and would look like another code.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd
from scipy import stats

from .ensemble import PACKING, Ensemble, of_engine, packing_means

# With 5 packings 2 of the 32 ways to swap two codes within them look at least as unlike as the runs do: p cannot fall
# below 0.06, and nothing could ever be found. With 6 it can fall to 0.03.
FEWEST_PACKINGS = 6
ALPHA = 0.05  # false alarms of each test on two equal codes
RESAMPLES = 9999
SEED = 1  # of the resamples: the same runs give the same numbers
BATCH = 1000  # resamples held in memory at once
DIGITS = 9  # of a statistic: all packings swapped is the same pair the other way round, and must count as equal to it


def sound(ensemble: Ensemble) -> Ensemble:
    """Without the runs in which a gate failed, and without the beds that are not the same for all codes."""
    beds = defaultdict(set)
    for run, manifest in ensemble.manifests.items():
        beds[run[1:]].add(manifest["packing_hash"])
    return ensemble.selected(
        run
        for run, manifest in ensemble.manifests.items()
        if all(gate["passed"] for gate in manifest["gates"]) and len(beds[run[1:]]) == 1
    )


def shared_means(table: pd.DataFrame, engines: Sequence[str]) -> dict[str, pd.DataFrame]:
    """For each of `engines` the packing means of `table` by seed, over the (seed, twin) that all of them ran."""
    runs = {engine: of_engine(table, engine) for engine in engines}
    shared = sorted(set.intersection(*(set(rows.index) for rows in runs.values())))
    means = {}
    for engine, rows in runs.items():
        rows = pd.concat({engine: rows.loc[shared]}, names=PACKING[:1])
        means[engine] = packing_means(rows).droplevel("engine")
    return means


def swap_test(packings: int, statistic: Callable[[np.ndarray], np.ndarray]):
    """The permutation test that swaps the two codes of a pair within packings (scipy's PermutationTestResult).

    `statistic` maps signs, +-1 (-1: swapped), of shape (..., packings) to values >= 0 of shape (...); large: unlike.
    The result has them in units of the observed one, as scipy counts what is within 1e-14 as equal, and to DIGITS.
    Exact under the hypothesis that the codes are equal, whatever the scatter and however depths or cells correlate.
    """
    observed = float(statistic(np.ones(packings))) or 1.0
    return stats.permutation_test(
        (np.ones(packings),),
        lambda signs, axis: np.round(statistic(np.moveaxis(signs, axis, -1)) / observed, DIGITS),
        permutation_type="samples",
        vectorized=True,
        n_resamples=RESAMPLES,
        batch=BATCH,
        alternative="greater",
        random_state=SEED,
    )
