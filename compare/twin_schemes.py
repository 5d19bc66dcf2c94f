"""Which native scheme does what an engine does, step by step: the engine's twin."""

from __future__ import annotations

from crossdem.adapters.case import Case, CaseError, varied_table

TWIN_SCHEMES = {
    "liggghts": "liggghts",
    "yade": "yade",
    "liggghts-averaged": "liggghts_averaged",
    "yade-averaged": "yade_averaged",
}
# The readings of a case that an engine follows; of the others its law has its own, and so has its twin.
FOLLOWED_READINGS = {"liggghts": ("attraction",), "liggghts-averaged": ("attraction",)}


def native_twin_or_why(case: Case, engine: str) -> Case | str:
    """As native_twin; or the sentence that says why there is none."""
    try:
        return native_twin(case, engine)
    except CaseError as error:
        return f"no native twin: {'; '.join(error.faults)}"


def native_twin(case: Case, engine: str) -> Case:
    """The `case` for the native solver in the scheme that does what `engine` does, at the engine's time step.

    Raises KeyError for an engine without such a scheme, CaseError where the solver refuses it.
    """
    scheme = case.resolved["scheme"]
    followed = {key: scheme[key] for key in FOLLOWED_READINGS.get(engine, ())}
    time = case.resolved["time"] | {"step_s": case.step_s(engine)}
    return varied_table(case, scheme={"name": TWIN_SCHEMES[engine], **followed}, time=time)
