"""What each engine's contact law is as its time step vanishes: where the codes differ for good."""

from __future__ import annotations

from dataclasses import dataclass

from crossdem.adapters.engines import ENGINES
from crossdem.adapters.external import External

from .impact import ContactLaw


@dataclass(frozen=True)
class EngineLaw:
    """The law of contacts, and the shares of the overlap by which torque arms are shorter than the radius."""

    contact: ContactLaw
    wall_arm_share: float
    bar_arm_share: float

    def wall_arm(self, radius: float, overlap: float) -> float:
        return radius - self.wall_arm_share * overlap

    def bar_arm(self, radius: float, overlap: float) -> float:
        return radius - self.bar_arm_share * overlap


def engine_law(engine: str, case: dict) -> EngineLaw:
    """Of `engine` on the resolved `case`; what of its readings the engine does not know has no effect.

    A user's own has the law of the native scheme that its description names.
    """
    scheme = case["scheme"]
    if isinstance(own := ENGINES.get(engine), External):
        engine, scheme = "native", scheme | own.scheme
    name = scheme["name"].replace("_", "-") if engine == "native" else engine
    clipped = scheme["attraction"] == "clipped"
    if name == "paper":
        share = 0.5 if scheme["torque_arm"] == "contact_point" else 0.0
        return EngineLaw(ContactLaw(scheme["slip_cap"] == "total", clipped), share, share)
    # An averaged displacement is the integrator's, and vanishes with the time step.
    code = name.removesuffix("-averaged")
    if code == "liggghts":
        return EngineLaw(ContactLaw(cap_on_total=True, clipped=clipped), 0.5, 0.5)
    if code == "yade":  # at a wall it takes the contact point on the wall itself
        return EngineLaw(ContactLaw(cap_on_total=True, clipped=True), 1.0, 0.5)
    raise ValueError(f"the law of {engine} as its time step vanishes is not known")
