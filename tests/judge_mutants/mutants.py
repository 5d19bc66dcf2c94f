"""Faults seeded in the judge: each is a text of its source replaced by another, and the tests that must notice."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Mutant:
    name: str
    file: str  # in the repository
    right: str  # stands there once
    wrong: str
    tests: str  # file in tests/harness/
    only: str = ""  # of its tests, as pytest's -k has it


def _of(file: str, tests: str, *entries: tuple[str, str, str], only: str = "") -> list[Mutant]:
    return [Mutant(name, file, right, wrong, tests, only) for name, right, wrong in entries]


MUTANTS = [
    *_of(
        "compare/equivalence.py",
        "test_equivalence.py",
        ("alpha_of_a_half", "ALPHA = 0.05", "ALPHA = 0.5"),
        ("interval_of_50_percent", "(alpha=2 * ALPHA)", "(alpha=10 * ALPHA)"),
        ("lower_margin_with_the_wrong_sign", "ttost_mean(-margins,", "ttost_mean(margins,"),
        ("one_of_the_two_tests", "ttost_mean(-margins, margins)", "ttost_mean(-margins, 9e9)"),
        ("sign_of_the_difference_kept", "< 0, -1.0, 1.0)", "< 0, 1.0, 1.0)"),
        ("one_tail_of_two", "return near + far", "return near"),
        ("scatter_over_n", "std_ddof(1)", "std_ddof(0)"),
        ("no_holm", "holm(np.where(usable, equivalent, 1.0))", "np.where(usable, equivalent, 1.0)"),
        ("holm_without_order", "np.maximum.accumulate(", "np.asarray("),
        ("holm_takes_the_least", "np.maximum.accumulate", "np.minimum.accumulate"),
        ("still_without_abs", "np.abs(mean) >= margins", "mean >= margins"),
        ("no_value_is_proof", "(usable, equivalent, 1.0)", "(usable, equivalent, 0.0)"),
        ("planned_from_the_hardest", "np.argsort(-ease,", "np.argsort(ease,"),
        ("planned_within_though_beyond", "if ends[0] < 0 else", "if False else"),
    ),
    *_of(
        "compare/equivalence.py",
        "test_checks.py",
        ("planned_for_one_test", "- missed(ends[0]) - missed(ends[1])", "- missed(ends[0])"),
    ),
    *_of(
        "compare/checks.py",
        "test_checks.py",
        (
            "paired_by_place",
            "seeds, *rows = np.intersect1d(*(one.index for one in runs), return_indices=True)",
            "seeds = np.intersect1d(*(one.index for one in runs)); rows = [np.arange(len(seeds))] * 2",
        ),
        ("first_column_for_all", "[check.quantity.name for", "[checks[0].quantity.name for"),
        (
            "first_margin_for_all",
            "[check.on_scale(check.margin) for",
            "[checks[0].on_scale(checks[0].margin) for",
        ),
        ("alarm_without_abs", "abs(self.difference) > self.alarm", "self.difference > self.alarm"),
        ("alarm_within_the_margin", "return self.margin + errors", "return errors"),
        ("alarm_of_a_known_scatter", "stdtrit(self.scatter_degrees,", "stdtrit(10**9,"),
        ("alarm_of_one_packing", "math.sqrt(2 / len(self.seeds))", "math.sqrt(2)"),
        (
            "alarm_instead_of_the_interval",
            "if not 0 < len(self.seeds) < SEEDS",
            "if not 0 < 1 < SEEDS",
        ),
        ("beyond_with_the_wrong_sign", "[1] < -self.margin\n", "[1] < self.margin\n"),
        ("within_below_only", "<= self.interval[1] < self.margin", "<= self.interval[1]"),
        ("chance_among_many", "result.within and result.p_equivalent <= ALPHA", "result.within"),
        ("two_packings_are_enough", "SEEDS_FOR_INTERVAL = 5", "SEEDS_FOR_INTERVAL = 2"),
        (
            "not_significant_is_equivalent",
            "return DIFFERENT\n    return INCONCLUSIVE",
            "return DIFFERENT\n    return EQUIVALENT",
        ),
        ("one_engine_scatters_alone", "math.sqrt(2) * np", "1.0 * np"),
        ("obstacles_forgotten", "result if result.obstacles else replace", "replace"),
    ),
    *_of(
        "compare/margins.py",
        "test_checks.py",
        (
            "quotient_without_log",
            "np.log(np.where(a > 0, a, np.nan)) - np.log(np.where(b > 0, b, np.nan))",
            "a / b - 1",
        ),
        ("margin_without_log", "return math.log(value) if", "return value if"),
        ("over_the_sum", "abs(a.mean() + b.mean()) / 2", "abs(a.mean() + b.mean())"),
        ("scatter_over_n_of_an_engine", "values.std(ddof=1)", "values.std(ddof=0)"),
        ("stated_scatter_for_sure", "STATED_DEGREES = 4", "STATED_DEGREES = 10**9"),
        ("measured_scatter_forgotten", "for one, known in measured]", "for one, known in []]"),
        ("wildness_is_an_excuse", "MOST_TIMES_CALMER = 3", "MOST_TIMES_CALMER = 1e9"),
        (
            "both_as_calm_as_stated",
            "max(stated, min(scatter for scatter, _ in measured))",
            "stated",
        ),
    ),
    *_of(
        "compare/ensemble.py",
        "test_checks.py",
        (
            "twins_as_packings",
            "    by_packing = ",
            "    table = table.set_axis(table.index.map(lambda r: (r[0], 9 * r[1] + r[2], 0)).set_names(RUN))\n"
            "    by_packing = ",
        ),
        ("first_twin_only", "by_packing.mean()", "by_packing.first()"),
    ),
    *_of(
        "compare/resistance.py",
        "test_resistance.py",
        (
            "mean_of_the_tip",
            'return float(deep_window(resistance)["force_y_N"]',
            'return float(deep_window(resistance)["tip_force_y_N"]',
        ),
        ("shaft_is_the_tip", 'window["shaft_force_y_N"]', 'window["tip_force_y_N"]'),
        ("window_from_the_middle", "DEEP_FROM = 1 / 3", "DEEP_FROM = 1 / 2"),
    ),
    *_of(
        "compare/motion.py",
        "test_motion.py",
        ("down_is_up", '"downward_m": -mean_m', '"downward_m": mean_m'),
        (
            "bump_sinks",
            "surface_profile(dataset, -1) - surface_profile(dataset, 0)\n    left",
            "surface_profile(dataset, 0) - surface_profile(dataset, -1)\n    left",
        ),
    ),
    *_of(
        "compare/chaos.py",
        "test_chaos.py",
        ("beds_with_their_chaos", "max(0.0, ratio - 1)", "ratio"),
        (
            "share_of_deviations",
            "return self.between**2 / variance",
            "return self.between / variance",
        ),
    ),
    *_of(
        "compare/verdict.py",
        "test_verdict.py",
        (
            "one_equivalence_is_enough",
            "all(outcome == checks.EQUIVALENT",
            "any(outcome == checks.EQUIVALENT",
        ),
        ("failures_forgiven", "    elif failures:\n", "    elif False:\n"),
        ("open_is_consistent", "len(result.seeds) >= result.seeds_needed", "False"),
        (
            "packings_that_all_checks_need",
            "_most([result.seeds_needed for result in still_open])",
            "_most([result.seeds_needed for result in results])",
        ),
        only="never_agreement or settle_nothing or stays_open or needs_more",
    ),
    *_of(
        "compare/intake.py",
        "test_verdict.py",
        (
            "gates_of_twins_forgotten",
            'if not gate["passed"]',
            'if not gate["passed"] and not run[2]',
        ),
        ("packings_not_compared", "if run[0] == first and", "if False and"),
        ("any_case_will_do", "if found != wanted:", "if False:"),
        only="gate_failed or different_packings or every_fault",
    ),
    *_of(
        "adapters/gates.py",
        "test_replay.py",
        (
            "contacts_gated_as_recorded",
            'if about["packing_hash"] not in native:',
            "if True:",
        ),
        (
            "contacts_of_any_native_run",
            'native[about["packing_hash"]], limit)',
            "max(native.values()), limit)",
        ),
        ("contacts_gated_twice", 'if gate["name"] != CONTACTS]', "]"),
        only="sets_the_gate",
    ),
]
