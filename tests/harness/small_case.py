"""The reference case cut down to a narrow box of few particles and a short way."""

from pathlib import Path

from crossdem.adapters.case import Case, load_case
from synthetic import REFERENCE_CASE

SMALL = (
    "container.width_m=0.04",
    "container.height_m=0.06",
    "particles.count=40",
    "bar.centre_x_m=0.02",
    "time.rest_s=1.2",
    "time.penetration_s=0.1",
    "time.frame_interval_s=0.02",
)


def small_case(*overrides: str) -> Case:
    return load_case(REFERENCE_CASE, [*SMALL, *overrides])


def small_file(folder: Path) -> Path:
    """A file of a case smaller still, in `folder`: for commands that take a case and no overrides."""
    changes = {
        "width_m = 0.15 ": "width_m = 0.04 ",
        "count = 944 ": "count = 40 ",
        "centre_x_m = 0.075 ": "centre_x_m = 0.02 ",
        "rest_s = 1.2 ": "rest_s = 0.1 ",
        "penetration_s = 9.0 ": "penetration_s = 0.1 ",
    }
    text = REFERENCE_CASE.read_text(encoding="utf-8")
    for old, new in changes.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    path = folder / "small.toml"
    path.write_text(text, encoding="utf-8")
    return path
