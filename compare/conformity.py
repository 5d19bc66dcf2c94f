"""Where a user's code stands: the contract, the ladder, the bed, and what to look at first."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from crossdem import ExitCode

from . import checks, rungs
from .checks import CheckResult
from .comparison import Comparison
from .ladder import Ladder
from .rungs import AnswerRung, Rung, TwinRung
from .runs import TIERS
from .verdict import AGREES, CONSISTENT, DIFFERS, ENGINE_FAILED, EXIT_CODES, INCONCLUSIVE
from .wording import plural

# What an answer hangs on, by its name in ANSWERS: where to look in a code that misses it.
HINTS = {
    "fall_m": "gravity and the integration of places",
    "fall_speed_m_s": "gravity and the integration of velocities",
    "floor_force_over_weight": "mass (pi r^2 rho h), gravity, and the force on the floor: > 0 is upwards",
    "floor_force_over_weight_at_rest": "mass, gravity, walls and bar: what the bed weighs must reach floor, walls and bar",
    "column_top_m": "normal stiffness of discs and walls, and the sum of forces in a column",
    "rebound_over_impact_speed": "normal spring and dashpot of the walls",
    "restitution": "normal spring and dashpot; whether the dashpot may pull",
    "restitution_at_step": "the integrator: whether it adds or takes energy at the step it runs at",
    "sideways_speed_ratio": "shear spring, slip cap, and the moment of inertia of a disc, m r^2 / 2",
    "rolling_over_slip": "moment of inertia of a disc, m r^2 / 2, and the arm of the shear force",
    "momentum_change": "that a contact's force acts on both discs, opposite and equal",
    "energy_gain": "signs of dashpots and of the shear force",
    "rolling_speed_over_slip": "moment of inertia of a disc, m r^2 / 2, and friction that ends when slip does",
    "rolling_slowing_over_g": "the spring against rolling and its cap",
    "parting_over_pulling_speed": "the joint: up to which force its spring carries tension",
    "sink_over_bar_speed": "the motion of the bar, and friction on its sides",
    "rolling_over_bar_speed": "the arms of the shear force on bar and wall",
    "bar_side_force_N": "the force on the bar's sides",
    "bar_load_over_weight": "the force on the bar: > 0 is upwards",
    "push_over_corner_speed": "the corner of the bar: discs touch it as a point",
    "sideways_over_corner_speed": "the direction of the force at the bar's corner",
    "corner_restitution": "that floor and wall act at once in a corner",
    "corner_asymmetry": "that floor and wall have the same law",
    "pull_over_push": "whether the dashpot may pull while discs part",
    "floor_force_when_parted_N": "that a contact ends where the overlap does",
}
COLOURS = {
    AGREES: "brightgreen",
    CONSISTENT: "green",
    DIFFERS: "red",
    ENGINE_FAILED: "lightgrey",
    INCONCLUSIVE: "yellow",
}


@dataclass(frozen=True)
class Conformity:
    """Everything that the page of a code says, computed."""

    engine: str
    version: str
    ladder: Ladder
    particles: dict[str, int]  # in each case of the ladder
    bed: Comparison | None  # None: `why_no_bed`
    why_no_bed: str = ""
    tier: str = ""

    @property
    def word(self) -> str:
        """The ladder's, as long as that does not agree; then the bed's."""
        return self.bed.verdict.word if self.bed else self.ladder.word

    @property
    def exit_code(self) -> ExitCode:
        return EXIT_CODES[self.word]

    @property
    def rungs_held(self) -> int:
        """Without those that hold by a declared difference."""
        agreeing = sum(rung.outcome == rungs.AGREES for rung in self.ladder.compared)
        return agreeing - len(self.declared)

    @property
    def declared(self) -> list[AnswerRung]:
        """The rungs on which the code differs by what its description declares."""
        answers = [rung for rung in self.ladder.rungs if isinstance(rung, AnswerRung)]
        return [rung for rung in answers if rung.declared]

    @property
    def own_results(self) -> list[CheckResult]:
        """Of the bed's checks, those with the code in them."""
        checked = self.bed.results if self.bed else ()
        return [result for result in checked if self.engine in result.pair]

    @property
    def bed_is_comparable(self) -> bool:
        return any(result.outcome != checks.NOT_COMPARABLE for result in self.own_results)

    @property
    def differing(self) -> list[Rung]:
        """The rungs that tell most first: with the fewest particles, then the furthest off, counted in what is allowed."""
        found = [rung for rung in self.ladder.rungs if rung.outcome == rungs.DIFFERS]
        return sorted(found, key=lambda rung: (self.particles[rung.case], -_times_allowed(rung)))

    @property
    def look_first(self) -> str:
        """One sentence: what to do next."""
        failed = [rung for rung in self.ladder.rungs if rung.outcome == rungs.NO_RESULT]
        if failed:
            return f"{failed[0].case}: {failed[0].sentence}"
        if self.differing:
            first = self.differing[0]
            return f"{first.case}, {first.name}: {first.sentence}. {hint(first)}".rstrip()
        if self.bed:
            return f"{self.bed.verdict.sentence} {self._after_bed()}"
        return self.why_no_bed

    @property
    def message(self) -> str:
        """Of the badge."""
        lacking = len(self.ladder.rungs) - len(self.ladder.compared)
        climbed = f"ladder {self.rungs_held}/{len(self.ladder.compared)}"
        if self.declared:
            climbed += f" + {len(self.declared)} declared"
        bed = f", bed {self.bed.verdict.word.lower()}" if self.bed else ""
        return climbed + (f" ({lacking} not offered)" if lacking else "") + bed

    @property
    def colour(self) -> str:
        """Of the badge, as shields.io names it."""
        return COLOURS[self.word]

    def _after_bed(self) -> str:
        larger = dict(pairwise(TIERS)).get(self.tier)
        if not self.bed_is_comparable:
            return (
                "Where the code does not offer the bed, --no-bed leaves the verdict to the ladder."
            )
        if self.bed.verdict.word == CONSISTENT and larger:
            return f"For a statement of equivalence take a larger ensemble: --tier {larger}."
        return self.bed.verdict.next_step


def hint(rung: Rung) -> str:
    """Where to look, after a rung that differs."""
    if isinstance(rung, AnswerRung):
        return f"It hangs on {HINTS[rung.answer.name]}."
    return "Its closed forms are the next to look at." if isinstance(rung, TwinRung) else ""


def not_run(ladder: Ladder) -> str:
    """Why no bed is run after this ladder; empty if it is to be."""
    if ladder.word == DIFFERS:
        apart = sum(rung.outcome == rungs.DIFFERS for rung in ladder.rungs)
        return (
            f"The bed was not run: {plural(apart, 'rung')} of the ladder {'does' if apart == 1 else 'do'} not hold, and a "
            "bed of the same law would only say so less clearly."
        )
    if ladder.word == ENGINE_FAILED:
        return "The bed was not run: there are runs of the ladder without a result."
    return ""


def _times_allowed(rung: Rung) -> float:
    if isinstance(rung, AnswerRung):
        return rung.share
    if isinstance(rung, TwinRung) and rung.limit_m > 0:
        return rung.difference_m / rung.limit_m
    return 0.0
