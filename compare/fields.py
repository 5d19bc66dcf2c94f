"""Displacement fields of two codes: how unlike are their means, compared with those of two sets of packings of one code?

Fields are those of an ensemble: displacement at the end, mean of the particles that started in each cell of 1 cm, one
field per packing, paired by packing. A cell counts where both codes have it filled in at least FILLED_SHARE of the
packings, in the mean of the packings that fill it: cells at the surface are empty in some beds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from .pairing import DIGITS, FEWEST_PACKINGS, SEED, shared_means, swap_test

FILLED_SHARE = 0.75
SPLITS = 500
# Of the squares of a cell's differences, what its scatter is at least: differences without scatter give a large t, not
# an infinite one.
LEAST_REST = 1e-12


@dataclass(frozen=True)
class FieldComparison:
    """What the fields of a pair say; differences are first engine - second."""

    pair: tuple[str, str]
    seeds: tuple[int, ...]  # of the packings that both ran
    share: float  # norm of the difference of the two mean fields over that of their mean; NaN without packings
    # Root mean square, over random halves, of the same share between two halves of the packings: of the two codes, and
    # of one code (both in turn). Their ratio is 1 on average where the codes are equal. NaN: too few packings.
    share_of_codes: float
    share_of_packings: float
    p: float | None  # of the largest |t| of any cell; None: too few packings
    # Indexed by (component, x_m, y_m) of the cells that count: difference_m, t of the paired differences, and p,
    # with which the cell stands out among all cells (family-wise). None: too few packings.
    cells: pd.DataFrame | None
    left_out: int  # cells that are too often empty

    @property
    def ratio(self) -> float:
        return self.share_of_codes / self.share_of_packings if self.share_of_packings else np.nan


def compare_fields(fields: pd.DataFrame, pair: tuple[str, str]) -> FieldComparison:
    """The `fields` of an ensemble."""
    means = shared_means(fields, pair)
    seeds = tuple(int(seed) for seed in means[pair[0]].index)
    first, second = (means[engine].to_numpy(dtype=float) for engine in pair)
    filled = np.isfinite(first) & np.isfinite(second)
    counts = filled.mean(axis=0) >= FILLED_SHARE if seeds else np.zeros(fields.shape[1], bool)
    first, second = (np.where(filled, one, np.nan)[:, counts] for one in (first, second))
    left_out = _cells(fields.columns[~counts])
    if not counts.any():
        return FieldComparison(pair, seeds, np.nan, np.nan, np.nan, None, None, left_out)
    mean_first, mean_second = np.nanmean(first, axis=0), np.nanmean(second, axis=0)
    share = _share(mean_first - mean_second, (mean_first + mean_second) / 2)
    if len(seeds) < FEWEST_PACKINGS:
        return FieldComparison(pair, seeds, share, np.nan, np.nan, None, None, left_out)
    p, p_cells = largest_t_test(first - second)
    cells = pd.DataFrame(
        {"difference_m": mean_first - mean_second, "t": cell_t(first - second), "p": p_cells},
        index=fields.columns[counts],
    )
    return FieldComparison(pair, seeds, share, *split_shares(first, second), p, cells, left_out)


def split_shares(first: np.ndarray, second: np.ndarray) -> tuple[float, float]:
    """(share_of_codes, share_of_packings) of fields (packings, cells): see FieldComparison.

    Each split compares the first half of one code with the second half of the other, and of itself. So all these means
    are of equally many packings, and of different ones: nothing has to be scaled, and paired beds do not flatter.
    """
    rng, half = np.random.default_rng(SEED), len(first) // 2
    place = np.argsort(rng.random((SPLITS, len(first))), axis=1)  # in a random order of packings
    here, there = place < half, (place >= half) & (place < 2 * half)
    a_here, a_there = (_mean_of(first, members) for members in (here, there))
    b_here, b_there = (_mean_of(second, members) for members in (here, there))
    size = np.linalg.norm((np.nanmean(first, axis=0) + np.nanmean(second, axis=0)) / 2)
    codes = _root_mean_square(a_here - b_there, b_here - a_there) / size
    packings = _root_mean_square(a_here - a_there, b_here - b_there) / size
    return float(codes), float(packings)


def cell_t(differences: np.ndarray) -> np.ndarray:
    """Student's t of the mean of `differences` (packings, cells), NaN where empty; 0 where nothing differs."""
    return _swapped_t(differences)(np.ones(len(differences)))


def largest_t_test(differences: np.ndarray) -> tuple[float, np.ndarray]:
    """p value of max |t| over all cells with codes swapped within packings, and p of each cell against that maximum.

    A cell whose p is at most 5 % stands out: with two equal codes, 19 times in 20 none of them does.
    """
    t = _swapped_t(differences)
    found = swap_test(len(differences), lambda signs: np.abs(t(signs)).max(axis=-1))
    own = np.abs(cell_t(differences))
    own = np.round(own / (own.max() or 1.0), DIGITS)
    at_least = (found.null_distribution >= own[:, np.newaxis]).mean(axis=1)
    return float(found.pvalue), np.maximum(at_least, found.pvalue)


def _swapped_t(differences: np.ndarray):
    """t of each cell (..., cells) as a function of the packings' signs (..., packings)."""
    filled = np.isfinite(differences)
    counts, differences = filled.sum(axis=0), np.where(filled, differences, 0.0)
    squares = (differences**2).sum(axis=0)  # no swap changes them

    def t(signs: np.ndarray) -> np.ndarray:
        means = signs @ differences / counts
        rest = np.maximum(squares - counts * means**2, LEAST_REST * squares)
        errors = np.sqrt(rest / (counts - 1) / counts)
        return np.divide(means, errors, out=np.zeros_like(means), where=errors > 0)

    return t


def _mean_of(fields: np.ndarray, members: np.ndarray) -> np.ndarray:
    """Mean field (splits, cells) of the `members` (splits, packings) of `fields`, each cell over those that fill it."""
    filled = np.isfinite(fields)
    return members @ np.where(filled, fields, 0.0) / (members @ filled.astype(float))


def _root_mean_square(*differences: np.ndarray) -> float:
    """Of the norms of all rows of `differences`."""
    return float(np.sqrt(np.mean(np.sum(np.square(differences), axis=-1))))


def _share(difference: np.ndarray, mean: np.ndarray) -> float:
    size = np.linalg.norm(mean)
    return float(np.linalg.norm(difference) / size) if size > 0 else np.nan


def _cells(columns: pd.MultiIndex) -> int:
    """How many cells the `columns`, of two components, are."""
    return len({(x_m, y_m) for _, x_m, y_m in columns})
