"""Tables as those of an ensemble, made up: a bed's own part, common to both engines, and each run's own part."""

from __future__ import annotations

import numpy as np
import pandas as pd

from crossdem.compare.ensemble import RUN

PAIR = ("liggghts", "native")
DEPTHS_M = np.arange(0.005, 0.09, 0.01)
RESISTANCE_N = 16.0 * DEPTHS_M


def table(rows: dict[tuple[str, int, int], np.ndarray], columns) -> pd.DataFrame:
    """`rows` by (engine, seed, twin)."""
    index = pd.MultiIndex.from_tuples(rows, names=RUN)
    return pd.DataFrame(np.array(list(rows.values()), dtype=float), index=index, columns=columns)


def curves(rng, packings: int, shift_N=0.0, engines=PAIR, twins: int = 1) -> pd.DataFrame:
    """Resistance per cm [N] that scatters by 6 % from bed to bed and 14 % from run to run; the first engine's by
    `shift_N` more."""
    beds = 1 + 0.06 * rng.normal(size=(packings, 1))
    rows = {}
    for engine in engines:
        for seed in range(1, packings + 1):
            for twin in range(twins):
                own = 1 + 0.14 * rng.normal(size=len(DEPTHS_M))
                shift = shift_N if engine == engines[0] else 0.0
                rows[engine, seed, twin] = RESISTANCE_N * beds[seed - 1] * own + shift
    return table(rows, pd.Index(DEPTHS_M, name="depth_m"))


def cells(columns: int = 5, rows: int = 4) -> pd.MultiIndex:
    places = [(0.005 + 0.01 * x, 0.005 + 0.01 * y) for x in range(columns) for y in range(rows)]
    names = ["component", "x_m", "y_m"]
    return pd.MultiIndex.from_tuples([(c, *place) for c in "xy" for place in places], names=names)


def fields(rng, packings: int, shift_m=0.0, engines=PAIR, bed_m=0.001, own_m=0.001) -> pd.DataFrame:
    """Displacements [m] about a common field, neighbours correlated; the first engine's by `shift_m` more."""
    columns = cells()
    common_m = 0.01 * np.cos(np.arange(len(columns)) / 7)
    smooth = np.ones(4) / 2

    def noise() -> np.ndarray:
        return np.convolve(rng.normal(size=len(columns) + 3), smooth, "valid")

    beds_m = [bed_m * noise() for _ in range(packings)]
    rows = {
        (engine, seed, 0): common_m
        + beds_m[seed - 1]
        + own_m * noise()
        + (shift_m if engine == engines[0] else 0.0)
        for engine in engines
        for seed in range(1, packings + 1)
    }
    return table(rows, columns)
