"""The verdict: which of several findings wins, and what it takes to say AGREES."""

import gc
import weakref

import numpy as np
import pandas as pd
import pytest
import synthetic
from scipy import stats

from crossdem import ExitCode
from crossdem.compare import checks, tables, verdict
from crossdem.compare.comparison import ComparisonError, compare_runs
from crossdem.compare.ensemble import Ensemble
from crossdem.compare.margins import Check
from crossdem.compare.recorded import Record

ENGINES = ("native", "liggghts", "yade")
RUN_CASE = synthetic.case()
NOT_AT_REST = "the bed does not rest at this time step (2e-4 J)"


def runs(seeds=2, factors=(1.0, 1.0, 1.0), noise=0.0, engines=ENGINES):
    return [
        synthetic.dataset(RUN_CASE, engine, seed, factor=factor, noise=noise)
        for engine, factor in zip(engines, factors)
        for seed in range(1, seeds + 1)
    ]


def twins(number, seeds=5, engines=("native", "liggghts")):
    """`number` runs of each packing, each on a twin of its own."""
    return [
        synthetic.dataset(RUN_CASE, engine, seed, twin, packing_hash=f"{seed:02}{twin:02}" * 16)
        for engine in engines
        for seed in range(1, seeds + 1)
        for twin in range(number)
    ]


def test_two_identical_runs_are_consistent_as_two_seeds_prove_nothing():
    assert compare_runs(RUN_CASE, runs()).verdict.word == verdict.CONSISTENT


def test_identical_runs_of_enough_seeds_agree():
    comparison = compare_runs(RUN_CASE, runs(seeds=16))
    assert comparison.verdict.word == verdict.AGREES
    assert comparison.verdict.exit_code == ExitCode.AGREES
    assert "native, liggghts and yade are EQUIVALENT" in comparison.verdict.sentence


def test_two_noisy_seeds_are_consistent_and_it_says_how_many_seeds_a_statement_needs():
    comparison = compare_runs(RUN_CASE, runs(noise=0.3))
    said = comparison.verdict
    assert (said.word, said.exit_code) == (verdict.CONSISTENT, ExitCode.AGREES)
    assert (said.seeds, said.seeds_needed) == (2, 16)
    assert "no statement of equivalence" in said.sentence and "16 packings" in said.sentence
    assert "--seeds 16" in said.next_step
    assert tables.headlines(comparison)[-1].note.endswith("the open checks need 16 packings")


def test_a_shifted_resistance_differs():
    said = compare_runs(RUN_CASE, runs(factors=(1, 1, 1.6), noise=0.3)).verdict
    assert (said.word, said.exit_code) == (verdict.DIFFERS, ExitCode.DIFFERS)
    assert "in 2 of 3 checks" in said.sentence
    assert "mean resistance: yade +" in said.sentence


def test_enough_seeds_that_settle_nothing_are_inconclusive():
    shifted = runs(seeds=16, factors=(1, 1.1, 1), noise=0.05)
    said = compare_runs(RUN_CASE, shifted).verdict
    assert (said.word, said.exit_code) == (verdict.INCONCLUSIVE, ExitCode.INCONCLUSIVE)


@pytest.mark.parametrize("there, told", [(16, "--seeds 16."), (4, "run all engines here")])
def test_more_packings_than_the_record_has_are_not_asked_of_it(there, told):
    """Of 2 noisy ones; the record says how many more there would be."""
    yade = [run for run in runs(noise=0.3) if run.engine == "yade"]
    here = [run for run in runs(noise=0.3) if run.engine != "yade"]
    packings = dict.fromkeys(range(1, there + 1), "")
    recorded = Record(RUN_CASE, Ensemble.of(yade), packings, {}, {}, source="the package data")
    said = compare_runs(RUN_CASE, here, recorded=recorded).verdict
    assert (said.word, said.seeds_needed) == (verdict.CONSISTENT, 16)
    assert told in said.next_step
    assert ("As the package data has 4 packings" in said.next_step) == (there == 4)


def settled(mean_resistance, work=(0.0, 0.125), packings=16, stated=0.08):
    """The verdict on two checks of a margin of 0.1, whose differences have this mean and standard deviation."""
    scores = stats.norm.ppf((np.arange(packings) + 0.5) / packings)
    scores /= scores.std(ddof=1)
    rng = np.random.default_rng(1)
    index = pd.MultiIndex.from_product([ENGINES[:2], range(packings)], names=["engine", "seed"])
    endpoints = pd.DataFrame(1.0, index, ["mean_resistance_N", "work_J"])
    for name, (mean, scatter) in zip(endpoints, (mean_resistance, work)):
        endpoints.loc["liggghts", name] = 1 + mean + scatter * rng.permutation(scores)
    entry = synthetic.MEAN_RESISTANCE | {"kind": "absolute", "seed_scatter": stated}
    case = synthetic.case([entry, entry | {"quantity": "work_J"}])
    results = checks.evaluate(Check.of_case(case.resolved), ENGINES[1::-1], endpoints)
    return results, verdict.decide(ENGINES[:2], results, {})


def test_a_check_that_stays_open_with_packings_enough_is_inconclusive_whatever_the_others_need():
    (found, other), said = settled((0.104, 0.048))
    assert (found.outcome, other.outcome) == (checks.INCONCLUSIVE, checks.EQUIVALENT)
    assert found.interval == pytest.approx((0.083, 0.125), abs=1e-3)
    assert found.seeds_needed < len(found.seeds) < other.seeds_needed
    assert said.word == verdict.INCONCLUSIVE
    assert said.sentence.startswith("1 check of 2 stays INCONCLUSIVE, though 16 packings would")
    assert "the mean resistance of liggghts against native: the 90 % interval" in said.sentence


def test_an_open_check_that_needs_more_packings_is_consistent_whatever_the_others_need():
    (found, other), said = settled((0.0, 0.17), work=(0.06, 0.125))
    assert (found.outcome, other.outcome) == (checks.EQUIVALENT, checks.INCONCLUSIVE)
    assert len(other.seeds) < other.seeds_needed < found.seeds_needed
    assert (said.word, said.seeds_needed) == (verdict.CONSISTENT, other.seeds_needed)
    assert (
        f"1 of 2 checks is EQUIVALENT, and for the others it takes about {other.seeds_needed}"
        in (said.sentence)
    )
    assert said.next_step.endswith(f"--seeds {other.seeds_needed}.")


@pytest.mark.parametrize(
    "mean, told",
    [
        (0.085, "0.85 margins: if it is as measured, --seeds {} settles"),
        (0.115, "1.1 margins: if it is as measured, --seeds {} settles"),
        (0.1001, "1 margins: no reasonable number of packings settles it"),
    ],
)
def test_the_next_step_for_an_open_check_follows_from_what_was_measured(mean, told):
    (found, _), said = settled((mean, 0.048), work=(0.0, 0.01))
    assert said.word == verdict.INCONCLUSIVE
    assert told.format(found.seeds_to_settle) in said.next_step
    assert found.seeds_to_settle is None or found.seeds_to_settle > 16


def test_an_open_check_that_scatters_more_than_planned_asks_for_more_packings():
    """Of fewer than 10 packings the scatter planned with is the one that the case states."""
    (found, _), said = settled((0.04, 0.15), work=(0.0, 0.001), packings=8, stated=0.02)
    assert (found.outcome, said.word) == (checks.INCONCLUSIVE, verdict.INCONCLUSIVE)
    assert found.seeds_to_settle <= 8
    assert "scatters more than was planned for: run more packings" in said.next_step


def test_an_engine_that_cannot_express_the_case_has_not_failed():
    why = {("yade", 1): "yade: it cannot", ("yade", 2): "yade: it cannot"}
    both = runs(engines=ENGINES[:2])
    said = compare_runs(RUN_CASE, both, why, frozenset(why)).verdict
    assert (said.word, said.exit_code) == (verdict.INCONCLUSIVE, ExitCode.INCONCLUSIVE)
    assert said.sentence.startswith("Not comparable: yade, seed 1: yade: it cannot")
    assert compare_runs(RUN_CASE, both, why).verdict.word == verdict.ENGINE_FAILED


def test_the_gate_on_contacts_is_set_anew_for_a_run_made_without_native():
    native, other = runs(1, engines=("native", "liggghts"))
    other.resistance.loc[0, "contacts"] *= 2
    assert "contacts_share" not in {gate["name"] for gate in other.manifest["gates"]}
    comparison = compare_runs(RUN_CASE, [native, other])
    assert comparison.verdict.word == verdict.INCONCLUSIVE
    assert "the rested bed is another one" in comparison.verdict.sentence


def test_a_failed_gate_is_inconclusive_whatever_the_numbers_say():
    agitated = synthetic.dataset(RUN_CASE, "yade", 1, factor=5, failed_gate=NOT_AT_REST)
    comparison = compare_runs(RUN_CASE, [*runs(1, engines=ENGINES[:2]), agitated])
    said = comparison.verdict
    assert (said.word, said.exit_code) == (verdict.INCONCLUSIVE, ExitCode.INCONCLUSIVE)
    assert said.sentence == f"Not comparable: yade, seed 1: {NOT_AT_REST}."
    outcomes = {result.pair: result.outcome for result in comparison.results}
    assert outcomes[("yade", "native")] == outcomes[("yade", "liggghts")] == checks.NOT_COMPARABLE
    assert outcomes[("liggghts", "native")] != checks.NOT_COMPARABLE


def test_a_missing_engine_is_never_agreement():
    failures = {("yade", seed): "yade is not installed: apt install yade" for seed in (1, 2)}
    comparison = compare_runs(RUN_CASE, runs(engines=ENGINES[:2]), failures)
    said = comparison.verdict
    assert (said.word, said.exit_code) == (verdict.ENGINE_FAILED, ExitCode.ENGINE_FAILED)
    assert "apt install yade" in said.sentence and "1 more run" in said.sentence
    assert comparison.engines == ENGINES


def test_one_failed_run_keeps_its_pairs_from_being_compared():
    failures = {("liggghts", 2): "ended with status 1 while resting"}
    present = [run for run in runs() if (run.engine, run.seed) != ("liggghts", 2)]
    comparison = compare_runs(RUN_CASE, present, failures)
    outcomes = {result.pair: result.outcome for result in comparison.results}
    assert outcomes[("liggghts", "native")] == checks.NOT_COMPARABLE
    assert outcomes[("yade", "native")] == checks.INCONCLUSIVE


def test_engines_are_compared_on_the_packings_that_both_were_asked_to_run():
    present = [run for run in runs(7) if (run.engine, run.seed) != ("liggghts", 2)]
    comparison = compare_runs(RUN_CASE, present)
    assert (comparison.verdict.word, comparison.verdict.seeds) == (verdict.AGREES, 6)
    shared = {result.pair: result.seeds for result in comparison.results}
    assert shared[("liggghts", "native")] == (1, 3, 4, 5, 6, 7)
    assert shared[("yade", "native")] == (1, 2, 3, 4, 5, 6, 7)


def test_a_difference_wins_over_a_failure_and_a_failure_over_an_open_question():
    failures = {("yade", 1): "lost 3 particles"}
    different = runs(1, factors=(1, 2), engines=ENGINES[:2])
    assert compare_runs(RUN_CASE, different, failures).verdict.exit_code == ExitCode.DIFFERS
    alone = runs(1, engines=ENGINES[:1])
    assert compare_runs(RUN_CASE, alone, failures).verdict.exit_code == ExitCode.ENGINE_FAILED
    assert compare_runs(RUN_CASE, alone).verdict.exit_code == ExitCode.INCONCLUSIVE


def test_one_engine_alone_is_inconclusive():
    said = compare_runs(RUN_CASE, runs(engines=ENGINES[:1])).verdict
    assert said.word == verdict.INCONCLUSIVE
    assert "Only native" in said.sentence


def test_a_case_without_checks_is_inconclusive():
    bare = synthetic.case(checks=[])
    said = compare_runs(bare, [synthetic.dataset(bare, engine) for engine in ENGINES]).verdict
    assert said.word == verdict.INCONCLUSIVE
    assert "no checks" in said.sentence


def test_a_failed_gate_is_named_even_where_one_engine_is_alone():
    agitated = synthetic.dataset(RUN_CASE, "native", 1, failed_gate=NOT_AT_REST)
    said = compare_runs(RUN_CASE, [agitated]).verdict
    assert (said.word, said.exit_code) == (verdict.INCONCLUSIVE, ExitCode.INCONCLUSIVE)
    assert NOT_AT_REST.removeprefix("not comparable: ") in said.sentence
    assert said.sentence.lower().count("not comparable") == 1


def test_runs_from_different_packings_are_not_comparable():
    other = synthetic.dataset(RUN_CASE, "yade", packing_hash="0" * 64)
    comparison = compare_runs(RUN_CASE, [synthetic.dataset(RUN_CASE), other])
    assert comparison.verdict.word == verdict.INCONCLUSIVE
    assert "did not start from the same packing" in comparison.verdict.sentence


def test_what_is_no_comparison_is_refused_with_every_fault():
    other_case = synthetic.case(gravity_m_s2=1.62)
    wrong = [*runs(1), synthetic.dataset(RUN_CASE), synthetic.dataset(other_case, "esys")]
    with pytest.raises(ComparisonError) as refused:
        compare_runs(RUN_CASE, wrong)
    assert len(refused.value.faults) == 2
    assert "native, seed 1: given more than once" in refused.value.faults
    assert any("run of another case" in fault for fault in refused.value.faults)


def test_runs_are_of_this_case_whatever_margin_they_were_made_under():
    wider = synthetic.case([{**synthetic.MEAN_RESISTANCE, "margin": 0.5}], title="Another title")
    made_then = [synthetic.dataset(wider, engine) for engine in ENGINES]
    assert compare_runs(RUN_CASE, made_then).verdict.word == verdict.CONSISTENT


def test_twins_are_averaged_and_a_packing_counts_once():
    comparison = compare_runs(RUN_CASE, twins(3))
    assert comparison.verdict.word == verdict.AGREES
    assert "from 5 packings \N{MULTIPLICATION SIGN} 3 runs" in comparison.verdict.sentence
    assert comparison.results[0].seeds == (1, 2, 3, 4, 5)
    assert len(comparison.ensemble.manifests) == 30 and len(comparison.endpoints) == 10
    assert {run.twin for run in comparison.datasets} == {0} and len(comparison.datasets) == 10


def test_a_twin_whose_gate_failed_keeps_its_engine_from_being_compared():
    agitated = synthetic.dataset(
        RUN_CASE, "liggghts", 5, 2, failed_gate=NOT_AT_REST, packing_hash="0502" * 16
    )
    comparison = compare_runs(RUN_CASE, [*twins(2), agitated])
    assert comparison.results[0].outcome == checks.NOT_COMPARABLE
    assert comparison.verdict.sentence.startswith("Not comparable: liggghts, seed 5, twin 2:")


def test_recorded_runs_take_part_and_none_may_be_there_twice():
    recorded = Record(RUN_CASE, Ensemble.of(twins(2, engines=("yade",))), {}, {}, {})
    comparison = compare_runs(RUN_CASE, iter(twins(2)), recorded=recorded)
    assert comparison.engines == ENGINES and comparison.verdict.word == verdict.AGREES
    assert ("yade", "native") in comparison.pairs and comparison.of("yade") == []
    assert len(comparison.packings("yade")) == 5
    with pytest.raises(ComparisonError, match="yade, seed 1, twin 1: given more than once"):
        compare_runs(RUN_CASE, twins(2, engines=ENGINES), recorded=recorded)


def test_datasets_are_read_one_by_one():
    """None but twin 0 of each packing is still there when the next one is read."""
    made = []

    def read():
        for engine in ENGINES[:2]:
            for seed in (1, 2):
                for twin in range(3):
                    run = synthetic.dataset(
                        RUN_CASE, engine, seed, twin, packing_hash=f"{seed:02}{twin:02}" * 16
                    )
                    made.append(weakref.ref(run.motion))
                    yield run

    comparison = compare_runs(RUN_CASE, read())
    gc.collect()
    assert len(comparison.datasets) == sum(motion() is not None for motion in made) == 4


def test_enough_packings_that_show_every_check_equivalent_agree_whatever_was_planned():
    comparison = compare_runs(RUN_CASE, runs(seeds=6))
    assert comparison.results[0].seeds_needed == 16
    assert tables.headlines(comparison)[-1].note == "no check is open"
    assert (comparison.verdict.word, comparison.verdict.seeds) == (verdict.AGREES, 6)
