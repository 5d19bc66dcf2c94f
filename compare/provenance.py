"""What runs were made with, from their manifests: programs, time steps, packings."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Program:
    """One engine in one version."""

    engine: str
    version: str
    compiler: str | None
    steps_s: tuple[float, ...]  # time steps, each once
    runs: int


@dataclass(frozen=True)
class Provenance:
    programs: tuple[Program, ...]
    packings: tuple[tuple[int, str], ...]  # seed, SHA-256 [hex]


def provenance(manifests: Iterable[dict]) -> Provenance:
    """Of these runs together."""
    by_program: dict[tuple, list[float]] = {}
    packings = set()
    for manifest in manifests:
        program = manifest["engine"], manifest["engine_version"], manifest["compiler"]
        by_program.setdefault(program, []).append(manifest["time_step_s"])
        packings.add((manifest["seed"], manifest["packing_hash"]))
    programs = tuple(
        Program(*program, tuple(sorted(set(steps_s))), len(steps_s))
        for program, steps_s in by_program.items()
    )
    return Provenance(programs, tuple(sorted(packings)))
