"""The comparison as plain data: report.json, for other programs."""

from __future__ import annotations

import json
import math
from importlib import metadata

from . import chaos, horizon_tables, opinion_tables
from .comparison import Comparison
from .quantities import QUANTITIES
from .wording import explanation

SCHEMA_VERSION = 2
LIBRARIES = ("numpy", "pandas", "scipy", "statsmodels")  # that the numbers come from
# Of a run's manifest; the rest stays with the run.
PROVENANCE = (
    "engine",
    "seed",
    "twin",
    "engine_version",
    "compiler",
    "time_step_s",
    "particles",
    "frames",
    "samples",
    "wall_s",
    "cpu_s",
    "started_utc",
    "case_hash",
    "packing_hash",
    "run_key",
    "gates",
    "limitations",
)


def record(comparison: Comparison) -> dict:
    """Everything but the series; numbers in SI, null where there is none. Of a ratio, differences are logarithms."""
    verdict = comparison.verdict
    return plain(
        {
            "schema_version": SCHEMA_VERSION,
            "case": {
                "name": comparison.case.name,
                "title": comparison.case.resolved["title"],
                "hash": comparison.case.hash,
                "changes": comparison.case.changes,
            },
            "verdict": vars(verdict) | {"exit_code": int(verdict.exit_code)},
            "engines": comparison.engines,
            "seeds": comparison.seeds,
            "checks": [check_record(result) for result in comparison.results],
            "scatter": {
                name: {
                    engine: scatter and vars(scatter) | {"share_of_beds": scatter.share_of_beds}
                    for engine, scatter in chaos.scatters(
                        comparison.ensemble.endpoints, name
                    ).items()
                }
                for name in comparison.ensemble.endpoints
            },
            "quantities": {
                name: {
                    "title": quantity.title,
                    "unit": quantity.unit,
                    "definition": quantity.definition,
                }
                for name, quantity in QUANTITIES.items()
            },
            "runs": [
                {key: manifest.get(key) for key in PROVENANCE}
                | {
                    "recorded": run in comparison.recorded,
                    "values": comparison.ensemble.endpoints.loc[run].to_dict(),
                }
                for run, manifest in comparison.ensemble.manifests.items()
            ],
            "failures": [
                {"engine": engine, "seed": seed, "message": message}
                for (engine, seed), message in comparison.failures.items()
            ],
            **opinion_tables.record(comparison.opinions),
            "horizon": horizon_tables.record(comparison.horizon) if comparison.horizon else None,
            "libraries": libraries(),
        }
    )


def record_text(comparison: Comparison) -> str:
    """report.json."""
    text = json.dumps(record(comparison), indent=2, ensure_ascii=False, allow_nan=False)
    return text + "\n"


def libraries() -> dict[str, str]:
    return {name: metadata.version(name) for name in LIBRARIES}


def check_record(result) -> dict:
    check = result.check
    return {
        "quantity": check.quantity.name,
        "pair": result.pair,
        "outcome": result.outcome,
        "explanation": explanation(result),
        "kind": check.kind,
        "margin": check.margin,
        "seed_scatter": check.seed_scatter,
        "reason": check.reason,
        "seeds": result.seeds,
        "means": result.means,
        "difference": result.difference,
        "interval_90": result.interval,
        "p_equivalent": result.p_equivalent,
        "p_different": result.p_different,
        "family": result.family,
        "scatter": result.scatter,
        "scatter_degrees": result.scatter_degrees,
        "alarm": result.alarm,
        "seeds_needed": result.seeds_needed,
        "seeds_to_settle": result.seeds_to_settle,
    }


def plain(value):
    """What strict JSON can hold: no tuples, no NaN."""
    if isinstance(value, dict):
        return {key: plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
