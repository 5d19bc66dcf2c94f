"""From a folder of cases to a ladder: refined time steps, twins, all runs in one go, rungs."""

from __future__ import annotations

import time
from collections.abc import Sequence
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path

from rich.console import Console

from crossdem.adapters.case import Case, CaseError, load_case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.engines import get_engine, unknown_engines
from crossdem.adapters.packing import Packing, make_packing
from crossdem.adapters.run import RunRequest, RunResult, run_all
from crossdem.adapters.workspace import Workspace

from .answers import ANSWERS
from .comparison import case_faults
from .ladder import Ladder, LadderCase
from .paper_reference import paper_reference
from .progress import ProgressDisplay
from .refinement import LEVELS
from .rungs import (
    CLOSED_FORM,
    NO_SUCH_LAW,
    NOT_COMPARABLE,
    TWIN,
    Rung,
    answer_rung,
    twin_rung,
    without_result,
)
from .twin_schemes import has_twin, native_twin_or_why, scheme_name
from .wording import plural

NATIVE = "native"
TRANSCRIPTION = "the paper's scheme in Python"
TRANSCRIBED = "paper"  # the scheme that TRANSCRIPTION knows
SEED = 1  # of a packing that is made, where the particles are not given


@dataclass
class Plan:
    """One case of the ladder with its variants and, in time, what became of them."""

    path: Path
    overrides: tuple[str, ...]
    case: Case
    levels: list[Case]  # at the case's time steps and at their halves
    twins: dict[
        str, Case | str
    ]  # of each engine that has one: the case in its native scheme, or why not
    packing: Packing | None = None
    requests: dict[tuple[str, int | str], RunRequest] = field(default_factory=dict)
    reference: Future | None = None

    @property
    def has_reference(self) -> bool:
        return self.case.resolved["scheme"]["name"] == TRANSCRIBED


def load_plans(
    where: Path, engines: Sequence[str], overrides: Sequence[str], jobs: int
) -> list[Plan]:
    """Every case of the folder `where`, or the one case that it is, with its variants.

    Raises CaseError with the faults of all of them.
    """
    paths = sorted(where.glob("*.toml")) if where.is_dir() else [where]
    if not paths:
        raise CaseError([f"{where}: holds no case (*.toml)"])

    def load(path: Path) -> Plan | CaseError:
        try:
            return _plan(path, engines, tuple(overrides))
        except CaseError as error:
            return error

    with ThreadPoolExecutor(jobs) as pool:
        found = list(pool.map(load, paths))
    faults = [line for error in found if isinstance(error, CaseError) for line in error.faults]
    plans = [plan for plan in found if isinstance(plan, Plan)]
    names: dict[str, Path] = {}
    for plan in plans:
        if plan.case.name in names:
            faults.append(
                f"{plan.path}: {names[plan.case.name]} has the name {plan.case.name!r} too"
            )
        names[plan.case.name] = plan.path
    if faults:
        raise CaseError(faults)
    return plans


def climb(
    name: str,
    plans: Sequence[Plan],
    engines: Sequence[str],
    workspace: Workspace,
    jobs: int,
    console: Console,
) -> Ladder:
    """Runs what is not there yet and judges every rung. Raises CaseError for a packing that cannot be made."""
    started = time.monotonic()
    with ProgressDisplay(console) as display, ProcessPoolExecutor(
        jobs, mp_context=get_context("spawn")
    ) as pool:
        for plan in plans:
            plan.packing = make_packing(plan.case, SEED, workspace.packing_folder(plan.case, SEED))
            _request(plan, engines)
            if NATIVE in engines and plan.has_reference:
                plan.reference = pool.submit(paper_reference, plan.case.resolved, plan.packing)
        results = _run(plans, workspace, jobs, display)
        rungs, versions = [], {}
        for plan in plans:
            for engine in engines:
                runs = _Runs(plan, engine, results)
                rungs += runs.rungs()
                versions |= runs.version()
    return Ladder(
        name,
        tuple(_shown(plan, engines) for plan in plans),
        tuple(engines),
        versions,
        tuple(rungs),
        time.monotonic() - started,
    )


def _plan(path: Path, engines: Sequence[str], overrides: tuple[str, ...]) -> Plan:
    case = load_case(
        path,
        overrides,
        lambda raw: case_faults(raw) + unknown_engines(raw),
    )
    refined = any(not ANSWERS[entry["quantity"]].own_step for entry in case.resolved["answer"])
    levels = [case]
    for level in range(1, LEVELS if refined else 1):
        steps = [f"time.step_s={case.resolved['time']['step_s'] / 2**level!r}"]
        steps += [
            f"engines.{engine}.step_s={settings['step_s'] / 2**level!r}"
            for engine, settings in case.resolved["engines"].items()
        ]
        levels.append(load_case(path, [*overrides, *steps]))
    twins = {engine: native_twin_or_why(case, engine) for engine in engines if has_twin(engine)}
    return Plan(path, overrides, case, levels, twins)


def _request(plan: Plan, engines: Sequence[str]) -> None:
    for engine in engines:
        for level, case in enumerate(plan.levels):
            plan.requests[engine, level] = RunRequest(case, plan.packing, engine)
        twin = plan.twins.get(engine)
        if isinstance(twin, Case):
            plan.requests[engine, TWIN] = RunRequest(twin, plan.packing, NATIVE)


def _run(
    plans: Sequence[Plan], workspace: Workspace, jobs: int, display: ProgressDisplay
) -> dict[int, RunResult]:
    """Every run of every plan, by the identity of its request; progress is told by engine."""
    requests = [request for plan in plans for request in plan.requests.values()]
    shares = {id(request): 0.0 for request in requests}
    ours: dict[str, list[int]] = {}
    for request in requests:
        ours.setdefault(request.engine_name, []).append(id(request))

    def told(request: RunRequest, share: float, seconds_left: float | None) -> None:
        shares[id(request)] = share
        of_engine = [shares[key] for key in ours[request.engine_name]]
        display.update(request.engine_name, sum(of_engine) / len(of_engine))

    display.say(f"{plural(len(plans), 'case')}, {plural(len(requests), 'run')}, {jobs} at a time")
    results = run_all(requests, workspace.root, jobs, told)
    if reused := sum(result.status == "reused" for result in results):
        display.say(f"{reused} of these were there already")
    return {id(result.request): result for result in results}


class _Runs:
    """What one engine left on one case, and the rungs that can be judged from it."""

    def __init__(self, plan: Plan, engine: str, results: dict[int, RunResult]):
        self.plan = plan
        self.engine = engine
        self.case = plan.case.resolved
        self._results = {
            key: results[id(request)]
            for (name, key), request in plan.requests.items()
            if name == engine
        }
        self._datasets: dict[int | str, Dataset] = {}

    def version(self) -> dict[str, str]:
        found = next((run for key, run in self._datasets.items() if key != TWIN), None)
        return {self.engine: found.manifest["engine_version"]} if found else {}

    def rungs(self) -> list[Rung]:
        return [*self._twin(), *self._answers()]

    def _twin(self) -> list[Rung]:
        if self.engine == NATIVE:
            return self._against_transcription() if self.plan.has_reference else []
        twin = self.plan.twins.get(self.engine)
        if twin is None:
            return []
        about = f"native in the scheme {scheme_name(self.engine)}"
        if missing := self._missing(TWIN, about, [0]):
            return [missing]
        if isinstance(twin, str):
            return [self._without(TWIN, about, twin, NOT_COMPARABLE)]
        if missing := self._missing(TWIN, about, [TWIN]):
            return [missing]
        run, other = self._dataset(0), self._dataset(TWIN)
        return [twin_rung(self.case, self.engine, about, run, other.motion)]

    def _against_transcription(self) -> list[Rung]:
        if missing := self._missing(TWIN, TRANSCRIPTION, [0]):
            return [missing]
        try:
            motion, forces = self.plan.reference.result()
        except ArithmeticError as error:  # such as a centre that came to lie within the bar
            return [self._without(TWIN, TRANSCRIPTION, f"{TRANSCRIPTION} came to an end: {error}")]
        return [twin_rung(self.case, self.engine, TRANSCRIPTION, self._dataset(0), motion, forces)]

    def _answers(self) -> list[Rung]:
        found = []
        for entry in self.case["answer"]:
            answer = ANSWERS[entry["quantity"]]
            levels = [0] if answer.own_step else list(range(LEVELS))
            missing = self._missing(CLOSED_FORM, answer.title, levels)
            runs = [] if missing else [self._dataset(level) for level in levels]
            found.append(missing or answer_rung(self.case, self.engine, entry, runs))
        return found

    def _dataset(self, key: int | str) -> Dataset:
        if key not in self._datasets:
            self._datasets[key] = Dataset.read(self._results[key].dataset_folder)
        return self._datasets[key]

    def _missing(self, kind: str, about: str, keys: list[int | str]) -> Rung | None:
        """The rung that says why one of these runs is not there."""
        for key in keys:
            result = self._results[key]
            if result.failure is None:
                continue
            if result.status == "unsupported":
                return self._without(kind, about, f"not comparable: {result.failure}", NO_SUCH_LAW)
            whose = "its twin: " if key == TWIN else ""
            return self._without(kind, about, f"{whose}{result.failure}")
        return None

    def _without(self, *args) -> Rung:
        return without_result(self.plan.case.name, self.engine, *args)


def _shown(plan: Plan, engines: Sequence[str]) -> LadderCase:
    case = plan.case
    steps = {engine: get_engine(engine).step_s(case) for engine in engines}
    return LadderCase(case.name, case.resolved["title"], case.hash, steps)
