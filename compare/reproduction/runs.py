"""The runs behind the studies: each setting on its packings, in the native solver and where it matters in the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from crossdem.adapters.case import Case, varied
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.packing import Packing
from crossdem.adapters.workspace import Workspace

from ..progress import ProgressDisplay
from ..runs import here, settle, where
from ..variants import Variant, run_many_variants
from .observation import Sample, observe
from .study import Setting


@dataclass(frozen=True)
class Size:
    """How many packings the engines run."""

    seeds: int  # native
    engine_seeds: int  # the others
    engines: tuple[str, ...]

    def of(self, engine: str) -> int:
        return self.seeds if engine == REFERENCE else min(self.seeds, self.engine_seeds)


@dataclass(frozen=True)
class Found:
    """The samples of all settings."""

    case: Case
    size: Size
    samples: dict[tuple[str, str], Sample]  # by setting's name and engine

    def of(self, setting: Setting, engine: str = REFERENCE) -> Sample:
        return self.samples[setting.name, engine]

    def engines_of(self, setting: Setting) -> list[str]:
        """Those that have results, native first."""
        return [
            engine
            for (name, engine), sample in self.samples.items()
            if name == setting.name and sample.packings
        ]


def run_settings(
    case: Case,
    settings: Sequence[Setting],
    size: Size,
    workspace: Workspace,
    jobs: int | None,
    display: ProgressDisplay,
    profile: str | None = None,
) -> Found:
    """Runs or reuses all of them in one go. Raises CaseError, SolverError."""
    settings = list(dict.fromkeys(settings))
    beds: dict[tuple[str, ...], list[Packing]] = {}
    unsettled: dict[tuple[str, ...], tuple[str, ...]] = {}
    first_on = {setting.bed: setting for setting in reversed(settings)}
    for bed, setting in first_on.items():
        display.say(f"beds: {setting.name}")
        of_case = varied(case, bed) if bed else case
        beds[bed], why = settle(of_case, size.seeds, workspace, here(jobs, profile), display)
        unsettled[bed] = tuple(f"seed {seed}: {reason}" for seed, reason in why.items())
    planned = [
        (setting, engine, varied(case, setting.overrides) if setting.overrides else case)
        for setting in settings
        for engine in (size.engines if setting.engines else [REFERENCE])
    ]
    pairs = [
        (Variant(setting.name, variant, engine), packing)
        for setting, engine, variant in planned
        for packing in beds[setting.bed][: size.of(engine)]
    ]
    display.say(f"{len(pairs)} runs, {where(jobs, profile)}")
    runs = run_many_variants(case, pairs, workspace, jobs, display, profile)
    grouped: dict[tuple[str, str], list] = {(one.name, engine): [] for one, engine, _ in planned}
    for run in runs:
        grouped[run.variant.name, run.variant.engine].append(run)
    samples = {}
    for number, (setting, engine, _) in enumerate(planned):
        key = setting.name, engine
        samples[key] = observe(grouped[key], unsettled[setting.bed])
        display.update("reading", (number + 1) / len(planned))
    return Found(case, size, samples)
