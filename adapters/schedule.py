"""A run in whole time steps: when it rests, moves the bar, takes samples and frames."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Schedule:
    """Counts of time steps. Step 0 is the packing; the bar starts at step `rest`."""

    step_s: float
    rest: int
    penetration: int
    sample: int  # from one sample to the next
    frame: int  # from one frame to the next

    @classmethod
    def of(cls, case: dict, step_s: float) -> Schedule:
        """The schedule of the resolved `case` at `step_s`; a valid case has one at every time step that it names."""
        time = case["time"]
        return cls(
            step_s,
            rest=round(time["rest_s"] / step_s),
            penetration=round(time["penetration_s"] / step_s),
            sample=round(time["sample_interval_s"] / step_s),
            frame=round(time["frame_interval_s"] / step_s),
        )

    @property
    def steps(self) -> int:
        return self.rest + self.penetration

    @property
    def samples(self) -> int:
        return self.penetration // self.sample + 1

    @property
    def frames(self) -> int:
        return self.penetration // self.frame + 1
