"""One verdict from all runs, gates and checks, and the exit code that says the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from crossdem import ExitCode

from . import checks
from .checks import MOST_SEEDS, CheckResult
from .wording import explanation, listed, packings, plural, signed_difference

AGREES = "AGREES"
CONSISTENT = "CONSISTENT"
DIFFERS = "DIFFERS"
ENGINE_FAILED = "ENGINE FAILED OR MISSING"
INCONCLUSIVE = "INCONCLUSIVE"

EXIT_CODES = {
    AGREES: ExitCode.AGREES,
    CONSISTENT: ExitCode.AGREES,
    DIFFERS: ExitCode.DIFFERS,
    ENGINE_FAILED: ExitCode.ENGINE_FAILED,
    INCONCLUSIVE: ExitCode.INCONCLUSIVE,
}


@dataclass(frozen=True)
class Verdict:
    """What the whole comparison says."""

    word: str  # a key of EXIT_CODES
    sentence: str
    next_step: str  # what to do now
    seeds: int  # packings behind every check: the fewest of any pair of engines
    seeds_needed: int | None  # for a statement of equivalence in every open check; None: more than MOST_SEEDS, or none is

    @property
    def exit_code(self) -> ExitCode:
        return EXIT_CODES[self.word]


def decide(
    engines: Sequence[str],
    results: Sequence[CheckResult],
    failures: dict[tuple[str, int], str],
    failed_gates: Sequence[str] = (),
    strays: Sequence[str] = (),
    runs_each: Sequence[int] = (1,),
    recorded: tuple[str, int] | None = None,
) -> Verdict:
    """The verdict: a difference weighs more than an engine without result, and that more than an open question.

    `failed_gates` are lines that name the run and the gate; `strays` name the engines that differ particle by particle
    before the horizon, and when: that is no chance, and comes first. `runs_each` says how many runs the packings have,
    `recorded` from where runs come that were not made here, and how many packings there are.

    AGREES is the claim that every check is EQUIVALENT. Where every open check has fewer packings than that takes, no
    difference is as much as can be said, and it is called CONSISTENT. A check that stays open with packings enough to show
    equal engines as equivalent is a finding: INCONCLUSIVE.
    """
    outcomes = [result.outcome for result in results]
    seeds = min((len(result.seeds) for result in results), default=0)
    still_open = [result for result in results if result.outcome == checks.INCONCLUSIVE]
    needed = _most([result.seeds_needed for result in still_open])
    behind = packings(seeds, runs_each)

    if strays:
        word, sentence, next_step = DIFFERS, *_strayed(strays)
    elif checks.DIFFERENT in outcomes:
        word, sentence, next_step = DIFFERS, *_differs(results)
    elif failures:
        word, sentence, next_step = ENGINE_FAILED, *_failed(failures)
    elif not results and failed_gates:
        word, sentence, next_step = INCONCLUSIVE, *_not_comparable(failed_gates[0])
    elif not results:
        word, sentence, next_step = INCONCLUSIVE, *_nothing_to_compare(engines)
    elif checks.NOT_COMPARABLE in outcomes:
        word, sentence, next_step = INCONCLUSIVE, *_not_comparable(_first_obstacle(results))
    elif all(outcome == checks.EQUIVALENT for outcome in outcomes):
        word, sentence, next_step = AGREES, *_agrees(engines, results, behind)
    elif unsettled := [result for result in still_open if _planned_for(result)]:
        word, sentence, next_step = INCONCLUSIVE, *_unsettled(unsettled, results, behind, recorded)
    else:
        word, sentence, next_step = CONSISTENT, *_consistent(
            engines, results, behind, needed, recorded
        )
    return Verdict(word, sentence, next_step, seeds, needed)


def seeds_text(seeds_needed: int | None) -> str:
    if seeds_needed is None:
        return f"more than {MOST_SEEDS} packings"
    return plural(seeds_needed, "packing")


def _planned_for(result: CheckResult) -> bool:
    """Whether there are as many packings as equal engines need."""
    return result.seeds_needed is not None and len(result.seeds) >= result.seeds_needed


def _most(needed: list[int | None]) -> int | None:
    return None if not needed or None in needed else max(needed)


def _strayed(strays: Sequence[str]) -> tuple[str, str]:
    return (
        "; ".join(strays) + ".",
        "A fault in law, integrator or geometry, not chaos: `crossdem check reference_cases/micro` shows in which.",
    )


def _differs(results) -> tuple[str, str]:
    found = [result for result in results if result.outcome == checks.DIFFERENT]
    worst = max(found, key=_margins_apart)
    a, b = worst.pair
    sentence = (
        f"The engines differ in {len(found)} of {plural(len(results), 'check')}; most, against its margin, in the "
        f"{worst.check.quantity.title}: {a} {signed_difference(worst.check, worst.difference)} against {b}."
    )
    return sentence, "See the check table for what differs, then the displacement fields for where."


def _failed(failures) -> tuple[str, str]:
    (engine, seed), message = next(iter(sorted(failures.items())))
    more = f" (and {plural(len(failures) - 1, 'more run')})" if len(failures) > 1 else ""
    sentence = f"{engine}, seed {seed}, has no result: {message.rstrip('.')}{more}."
    return (
        sentence,
        "Read the log that it names; `crossdem doctor` shows which engines are here and what to install.",
    )


def _nothing_to_compare(engines) -> tuple[str, str]:
    if len(engines) < 2:
        who = engines[0] if engines else "no engine"
        return (
            f"Only {who} has results: one engine alone says nothing about agreement.",
            "Run the case with at least two engines.",
        )
    return (
        "The case has no checks: nothing says when its engines would agree.",
        "Add [[check]] tables.",
    )


def _first_obstacle(results) -> str:
    return next(
        result.obstacles[0] for result in results if result.outcome == checks.NOT_COMPARABLE
    )


def _not_comparable(obstacle: str) -> tuple[str, str]:
    told = obstacle.replace("not comparable: ", "").rstrip(".")  # once is enough
    return (
        f"Not comparable: {told}.",
        "See the gates and the missing runs; a bed that does not rest usually does at a smaller time step "
        "(engines.NAME.step_s).",
    )


def _agrees(engines, results, behind) -> tuple[str, str]:
    checked = len({result.check.quantity.name for result in results})
    return (
        f"{listed(engines)} are EQUIVALENT in {_all(checked)}, from {behind}: the 90 % interval of every "
        f"difference lies within its margin.",
        "Vary the case (--set key=value) to see how far the agreement reaches.",
    )


def _all(checked: int) -> str:
    return "the one quantity checked" if checked == 1 else f"all {checked} quantities"


def _consistent(engines, results, behind, needed, recorded) -> tuple[str, str]:
    shown = sum(result.outcome == checks.EQUIVALENT for result in results)
    sentence = (
        f"{behind} of {listed(engines)} show no check to be DIFFERENT, and every gate passed. This is no "
        f"statement of equivalence: {shown} of {plural(len(results), 'check')} {'is' if shown == 1 else 'are'} EQUIVALENT, "
        f"and for the others it takes about {seeds_text(needed)}, if the engines are equal."
    )
    if needed is None:
        return sentence, "Widen the margins that no reasonable number of packings can meet."
    next_step = f"For a statement of equivalence run the same with --seeds {needed}."
    return sentence, next_step + _beyond_record(needed, recorded)


def _unsettled(unsettled, results, behind, recorded) -> tuple[str, str]:
    """Of the checks that have packings enough and stay open all the same."""
    worst = max(unsettled, key=_margins_apart)
    a, b = worst.pair
    sentence = (
        f"{plural(len(unsettled), 'check')} of {len(results)} "
        f"{'stays' if len(unsettled) == 1 else 'stay'} INCONCLUSIVE, though {behind} would show equal engines as EQUIVALENT "
        f"in most cases; furthest apart, the {worst.check.quantity.title} of {a} against {b}: {explanation(worst)}."
    )
    apart = f"That difference is {_margins_apart(worst):.2g} margins"
    enough = worst.seeds_to_settle
    if enough is None:
        return (
            sentence,
            f"{apart}: no reasonable number of packings settles it; look for its cause.",
        )
    if enough <= len(worst.seeds):
        return sentence, f"{apart}, and scatters more than was planned for: run more packings."
    next_step = f"{apart}: if it is as measured, --seeds {enough} settles it in most cases."
    return sentence, next_step + _beyond_record(enough, recorded)


def _beyond_record(seeds: int, recorded: tuple[str, int] | None) -> str:
    """How to come to so many packings where the record has fewer."""
    if recorded is None or seeds <= recorded[1]:
        return ""
    source, there = recorded
    return (
        f" As {source} has {plural(there, 'packing')}, run all engines here for that, without it."
    )


def _margins_apart(result: CheckResult) -> float:
    return abs(result.difference) / result.margin
