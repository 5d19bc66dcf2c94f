"""The ladder: every rung of every case in a folder, and one verdict."""

from __future__ import annotations

from dataclasses import dataclass

from crossdem import ExitCode

from . import rungs
from .rungs import Rung
from .verdict import AGREES, DIFFERS, ENGINE_FAILED, EXIT_CODES, INCONCLUSIVE
from .wording import listed, plural


@dataclass(frozen=True)
class LadderCase:
    """A case of the ladder, as its page shows it."""

    name: str
    title: str
    hash: str
    steps_s: dict[str, float]  # of each engine


@dataclass(frozen=True)
class Ladder:
    """Everything the ladder's report says, computed."""

    name: str
    cases: tuple[LadderCase, ...]
    engines: tuple[str, ...]
    versions: dict[str, str]  # of the engines with results
    rungs: tuple[Rung, ...]
    seconds: float  # wall time

    def of(self, case: str, engine: str) -> list[Rung]:
        return [rung for rung in self.rungs if (rung.case, rung.engine) == (case, engine)]

    @property
    def compared(self) -> list[Rung]:
        """The rungs whose engine offers what they ask for."""
        return [rung for rung in self.rungs if rung.outcome != rungs.NO_SUCH_LAW]

    @property
    def word(self) -> str:
        """An engine may lack the law of some cases, but not of all: agreement is never said of nothing."""
        outcomes = {rung.outcome for rung in self.compared}
        for outcome, word in (
            (rungs.DIFFERS, DIFFERS),
            (rungs.NO_RESULT, ENGINE_FAILED),
            (rungs.NOT_COMPARABLE, INCONCLUSIVE),
        ):
            if outcome in outcomes:
                return word
        idle = {rung.engine for rung in self.rungs} - {rung.engine for rung in self.compared}
        return AGREES if self.compared and not idle else INCONCLUSIVE

    @property
    def exit_code(self) -> ExitCode:
        return EXIT_CODES[self.word]

    @property
    def sentence(self) -> str:
        """Names case, engine and rung of the lowest rung that does not hold: an engine's law before its limit."""
        wanted = {
            DIFFERS: rungs.DIFFERS,
            ENGINE_FAILED: rungs.NO_RESULT,
            INCONCLUSIVE: rungs.NOT_COMPARABLE,
        }.get(self.word)
        found = [rung for rung in self.rungs if rung.outcome == wanted]
        lacking = [rung for rung in self.rungs if rung.outcome == rungs.NO_SUCH_LAW]
        if self.word == INCONCLUSIVE and not found:
            found = lacking
        if not self.rungs:
            return "There is nothing to compare: no case has a twin or an answer."
        if not found:
            unasked = " No case has an [[answer]]: each engine was held against its twin alone."
            asked = any(rung.kind == rungs.CLOSED_FORM for rung in self.rungs)
            apart = sorted({f"{rung.engine} on {rung.case}" for rung in lacking})
            return (
                f"{listed(self.engines)}: every one of {plural(len(self.compared), 'rung')} on "
                f"{plural(len(self.cases), 'case')} holds."
                + (f" Not comparable: {listed(apart)}." if apart else "")
                + ("" if asked else unasked)
            )
        first = found[0]
        return (
            f"{first.case}, {first.engine}, {first.name}: {first.sentence.rstrip('.')}"
            + (f" (and {plural(len(found) - 1, 'more rung')})" if len(found) > 1 else "")
            + "."
        )

    @property
    def next_step(self) -> str:
        return {
            AGREES: "crossdem check reference_cases/bar_penetration.toml compares whole beds.",
            DIFFERS: "See the ladder's page for the rungs: a twin that differs shows a wrong number or operation, a "
            "closed form alone a wrong law.",
            ENGINE_FAILED: "Read the log that it names; crossdem doctor shows which engines are here and what to "
            "install.",
            INCONCLUSIVE: "See the ladder's page for what could not be compared, and why.",
        }[self.word]
