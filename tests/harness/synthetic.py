"""Made-up runs with known properties: the shape of real ones, none of the mechanics."""

from __future__ import annotations

import hashlib
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd

from crossdem.adapters.case import Case
from crossdem.adapters.dataset import Dataset, Motion
from crossdem.adapters.engines import ENGINES

REFERENCE_CASE = Path(__file__).parents[2] / "reference_cases" / "bar_penetration.toml"
SLOPE_N_M = 16.0
SHAFT_SHARE = 0.2

MEAN_RESISTANCE = {
    "quantity": "mean_resistance_N",
    "kind": "relative",
    "margin": 0.10,
    "seed_scatter": 0.08,
    "reason": "a tenth is what the experiment could tell apart",
}


def case(checks: list[dict] | None = None, **changes) -> Case:
    """The reference case with these `checks` (default: of the mean resistance alone) and top-level `changes`.

    Its file writes out every value, so that it needs no solver to be resolved.
    """
    resolved = tomllib.loads(REFERENCE_CASE.read_text(encoding="utf-8"))
    resolved |= {"check": [MEAN_RESISTANCE] if checks is None else checks} | changes
    return Case.from_resolved(resolved)


def resistance_table(force_N, depth_m=None, shaft_share: float = SHAFT_SHARE) -> pd.DataFrame:
    """A resistance table with these forces at these depths (default: 0 to 9 cm in even steps), 1 cm/s."""
    force_N = np.asarray(force_N, dtype=float)
    depth_m = np.linspace(0, 0.09, len(force_N)) if depth_m is None else np.asarray(depth_m)
    shaft_N = shaft_share * force_N
    return pd.DataFrame(
        {
            "time_s": depth_m / 0.01,
            "depth_m": depth_m,
            "force_x_N": 0.0,
            "force_y_N": force_N,
            "tip_force_y_N": force_N - shaft_N,
            "shaft_force_y_N": shaft_N,
            "floor_force_y_N": -2.2,
            "contacts": 1700,
            "kinetic_energy_J": 7e-6,
        }
    )


def dataset(
    run_case: Case,
    engine: str = "native",
    seed: int = 1,
    twin: int = 0,
    *,
    factor: float = 1.0,  # of the resistance
    noise: float = 0.0,  # fluctuation along the way, share of the resistance
    drag: float = 0.5,  # share of the bar's way that particles beside it follow
    failed_gate: str | None = None,  # message
    packing_hash: str | None = None,
) -> Dataset:
    """A run whose resistance grows by SLOPE_N_M x `factor`; beds differ with `seed`, noise with engine and seed."""
    resolved = run_case.resolved
    samples = round(resolved["time"]["penetration_s"] / resolved["time"]["sample_interval_s"]) + 1
    time_s = np.arange(samples) * resolved["time"]["sample_interval_s"]
    depth_m = resolved["bar"]["speed_m_s"] * time_s
    own = np.random.default_rng([seed, *engine.encode()])
    waves = np.convolve(own.normal(size=samples + 60), np.ones(30) / 30**0.5, "same")[30:-30]
    force_N = SLOPE_N_M * factor * depth_m * (1 + noise * waves)
    radius_m, motion = bed_motion(resolved, seed, drag)
    gates = [
        {
            "name": "rest_kinetic_energy_J",
            "value": 3e-11,
            "limit": 1e-8,
            "passed": True,
            "message": "the bed rests: 3e-11 J",
        },
    ]
    if failed_gate:
        gates[0] |= {"value": 2e-4, "passed": False, "message": failed_gate}
    manifest = {
        "schema_version": 1,
        "case_name": run_case.name,
        "case_hash": run_case.hash,
        "packing_hash": packing_hash or hashlib.sha256(b"packing %d" % seed).hexdigest(),
        "seed": seed,
        "twin": twin,
        "engine": engine,
        "engine_version": f"{engine} 1.0",
        "compiler": "g++ 12.2.0 -O3" if engine == "native" else None,
        "time_step_s": ENGINES.get(engine, ENGINES["native"]).step_s(run_case),
        "command": [engine, "inputs"],
        "started_utc": "2024-01-01T00:00:00Z",
        "wall_s": 30.0,
        "cpu_s": 29.0,
        "particles": len(radius_m),
        "frames": len(motion.time_s),
        "samples": samples,
        "limitations": [] if engine == "native" else ["slip cap from the total normal force"],
        "gates": gates,
        "run_key": hashlib.sha256(f"{engine} {seed}".encode()).hexdigest(),
    }
    return Dataset(resolved, manifest, radius_m, motion, resistance_table(force_N, depth_m))


def bed_motion(resolved: dict, seed: int, drag: float) -> tuple[np.ndarray, Motion]:
    """Radii and motion of a bed of rows, pushed aside by the bar, dragged along beside it and heaved further out."""
    rng = np.random.default_rng(seed)
    count, width_m = resolved["particles"]["count"], resolved["container"]["width_m"]
    radius_m = rng.choice(resolved["particles"]["diameters_m"], count) / 2
    in_row = int(width_m // 0.005)
    row, column = np.divmod(np.arange(count), in_row)
    start_m = np.column_stack(
        [(column + 0.5 + 0.25 * (-1.0) ** row) * width_m / in_row, (row + 0.6) * 0.0039]
    )
    start_m += rng.uniform(-2e-4, 2e-4, start_m.shape)

    bar = resolved["bar"]
    half_m = bar["width_m"] / 2
    frames = round(resolved["time"]["penetration_s"] / resolved["time"]["frame_interval_s"]) + 1
    time_s = np.arange(frames) * resolved["time"]["frame_interval_s"]
    tip_m = start_m[:, 1].max() + radius_m.max() - bar["speed_m_s"] * time_s
    aside_m = start_m[:, 0] - bar["centre_x_m"]
    outward_m = half_m * np.sign(aside_m) - aside_m * half_m / (width_m / 2)
    passed_m = np.clip(start_m[:, 1] - tip_m[:, np.newaxis], 0, None)
    below_m = np.clip(tip_m[:, np.newaxis] - start_m[:, 1], 0, None)
    pushed = np.exp(-below_m / 0.004) * (below_m < 0.012)
    beside = np.exp(-np.clip(np.abs(aside_m) - half_m, 0, None) / 0.008)
    sunk_m = drag * beside * (passed_m + 0.004 * pushed)
    heave_m = 0.15 * passed_m * (1 - beside) * np.exp(-np.abs(aside_m) / 0.03)
    position_m = np.empty((frames, count, 2))
    position_m[..., 0] = start_m[:, 0] + pushed * outward_m
    position_m[..., 1] = np.maximum(start_m[:, 1] - sunk_m + heave_m, 0.001)
    still = np.zeros((frames, count))
    return radius_m, Motion(time_s, position_m, np.zeros_like(position_m), still, None, tip_m)


def bed_of(run_case: Case, positions_m, radius_m, bar_tip_m) -> Dataset:
    """A whole run of few particles at given `positions_m` (F, N, 2): for hand-computed motions."""
    positions_m = np.asarray(positions_m, dtype=float)
    frames, count, _ = positions_m.shape
    still = np.zeros((frames, count))
    time_s = np.linspace(0, run_case.resolved["time"]["penetration_s"], frames)
    motion = Motion(
        time_s, positions_m, np.zeros_like(positions_m), still, None, np.asarray(bar_tip_m)
    )
    whole = dataset(run_case)
    manifest = whole.manifest | {"particles": count, "frames": frames}
    return Dataset(run_case.resolved, manifest, np.asarray(radius_m), motion, whole.resistance)
