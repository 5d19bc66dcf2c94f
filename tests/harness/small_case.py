"""The reference case cut down to a narrow box of few particles and a short way."""

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
