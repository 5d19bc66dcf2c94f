"""The ensemble: one row per run, one mean per packing."""

import numpy as np
import pandas as pd
import pytest
import synthetic

from crossdem.compare.ensemble import Ensemble, packing_means


@pytest.fixture(scope="module")
def case():
    return synthetic.case()


def runs(case):
    return [
        synthetic.dataset(case, engine, seed, twin, factor=1 + 0.1 * twin)
        for engine in ("native", "yade")
        for seed in (1, 2)
        for twin in (0, 1)
    ]


def test_each_run_is_a_row_by_engine_seed_and_twin(case):
    ensemble = Ensemble.of(runs(case))
    assert ensemble.engines == ("native", "yade")
    assert list(ensemble.endpoints.index)[:3] == [
        ("native", 1, 0),
        ("native", 1, 1),
        ("native", 2, 0),
    ]
    for table in (ensemble.endpoints, ensemble.profiles, ensemble.fields):
        assert len(table) == len(ensemble.manifests) == 8
    assert list(ensemble.profiles.columns) == pytest.approx(np.arange(0.005, 0.09, 0.01))
    assert set(ensemble.fields.columns.get_level_values("component")) == {"x", "y"}


def test_its_numbers_are_those_of_the_dataset(case):
    [run] = [one for one in runs(case) if (one.engine, one.seed, one.twin) == ("yade", 2, 1)]
    ensemble = Ensemble.of(runs(case))
    force_N = run.resistance["force_y_N"]
    deep_N = force_N[run.resistance["depth_m"] >= 0.03 - 1e-9].mean()
    assert ensemble.endpoints.loc[("yade", 2, 1), "mean_resistance_N"] == pytest.approx(deep_N)
    moved_m = run.motion.position_m[-1] - run.motion.position_m[0]
    cell = ((run.motion.position_m[0] // 0.01) == (3, 5)).all(axis=1)
    of_cell = ensemble.fields.loc[("yade", 2, 1)].loc[("y", 0.035, 0.055)]
    assert of_cell == pytest.approx(moved_m[cell, 1].mean())


def test_a_packing_counts_once_with_the_mean_of_its_twins(case):
    endpoints = Ensemble.of(runs(case)).endpoints
    means = packing_means(endpoints)
    assert list(means.index) == [("native", 1), ("native", 2), ("yade", 1), ("yade", 2)]
    twins = endpoints.loc[("native", 2), "mean_resistance_N"]
    assert means.loc[("native", 2), "mean_resistance_N"] == pytest.approx(twins.mean())


def test_a_packing_has_no_value_where_one_of_its_twins_has_none():
    index = pd.MultiIndex.from_product(
        [["native"], [1, 2], [0, 1]], names=["engine", "seed", "twin"]
    )
    table = pd.DataFrame({"work_J": [1.0, np.nan, 3.0, 5.0]}, index=index)
    assert list(packing_means(table)["work_J"].isna()) == [True, False]


def test_ensembles_join_and_select_but_never_hold_a_run_twice(case):
    native, other = (
        Ensemble.of([run for run in runs(case) if run.engine == engine])
        for engine in ("native", "yade")
    )
    both = native.joined(other)
    assert both.engines == ("native", "yade") and len(both.manifests) == 8
    some = both.selected([("yade", 2, 0), ("native", 1, 1)])
    assert list(some.endpoints.index) == list(some.manifests) == [("yade", 2, 0), ("native", 1, 1)]
    with pytest.raises(ValueError):
        both.joined(other)
