"""The runs of a comparison in rows of text: gates, and where each came from."""

from __future__ import annotations

from typing import NamedTuple

from .comparison import Comparison
from .intake import run_name


class GateRow(NamedTuple):
    """One gate over all runs of an engine."""

    engine: str
    name: str
    worst: float  # the largest value of any run
    limit: float
    passed: int
    runs: int
    failures: list[str]  # the run and what its gate says


def gate_rows(comparison: Comparison) -> list[GateRow]:
    rows = []
    for engine in comparison.engines:
        by_name: dict[str, list] = {}
        for run, manifest in comparison.manifests(engine).items():
            for gate in manifest["gates"]:
                by_name.setdefault(gate["name"], []).append((run, gate))
        for name, found in by_name.items():
            failed = [(run, gate) for run, gate in found if not gate["passed"]]
            rows.append(
                GateRow(
                    engine=engine,
                    name=name.replace("_", " "),
                    worst=max(gate["value"] for _, gate in found),
                    limit=found[0][1]["limit"],
                    passed=len(found) - len(failed),
                    runs=len(found),
                    failures=[f"{run_name(run)}: {gate['message']}" for run, gate in failed],
                )
            )
    return rows


def run_rows(comparison: Comparison) -> list[dict]:
    """Of every run its manifest, and whether it was read from a record."""
    return [
        manifest | {"recorded": run in comparison.recorded}
        for run, manifest in comparison.ensemble.manifests.items()
    ]
