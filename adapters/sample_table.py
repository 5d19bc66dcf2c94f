"""From an engine's samples and frames, counted in time steps, to the times that the case asks for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from .dataset import RESISTANCE_COLUMNS
from .dataset_faults import bar_speed_m_s, frame_times_s, sample_times_s
from .engine import EngineFailure
from .schedule import Schedule

SAMPLE_COLUMNS = (
    "step",
    *RESISTANCE_COLUMNS[2:],
)  # of an engine's samples; step 0 is the end of the rest


def whole_lines(path: Path) -> str:
    """The text of `path` without a torn last line, whose last number might look whole. Raises OSError."""
    text = path.read_text(encoding="ascii", errors="replace")
    return text[: text.rfind("\n") + 1]


def resistance_table(
    samples: pd.DataFrame, case: dict, schedule: Schedule, engine: str
) -> pd.DataFrame:
    """The dataset's resistance from SAMPLE_COLUMNS; those of the rest, with a step below 0, are left out.

    The times are counted in intervals, as adding up steps would give every engine others. Raises EngineFailure.
    """
    table = samples[samples["step"] >= 0].reset_index(drop=True)
    _check_steps(
        table["step"].to_numpy(), schedule.sample, schedule.samples, f"{engine} left", "samples"
    )
    if not np.isfinite(table.to_numpy(dtype=float)).all():
        raise EngineFailure(f"{engine} printed values that are not finite")
    table.insert(0, "time_s", sample_times_s(case))
    table.insert(1, "depth_m", bar_speed_m_s(case) * table["time_s"])
    return table[list(RESISTANCE_COLUMNS)].astype({"contacts": int})


def frame_times(steps: np.ndarray, case: dict, schedule: Schedule, engine: str) -> np.ndarray:
    """The times [s] of the frames at `steps`, counted from the start of the bar. Raises EngineFailure."""
    _check_steps(steps, schedule.frame, schedule.frames, f"{engine} left", "frames")
    return frame_times_s(case)


def _check_steps(steps: np.ndarray, interval: int, expected: int, who_left: str, what: str) -> None:
    if len(steps) < expected:
        raise EngineFailure(f"{who_left} {len(steps)} of {expected} {what}: disk full?")
    if not np.array_equal(steps, np.arange(expected) * interval):
        raise EngineFailure(f"{who_left} {what} at other steps than it was told")
