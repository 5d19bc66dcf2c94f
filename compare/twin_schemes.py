"""Which native scheme does what an engine does, step by step: the engine's twin."""

from __future__ import annotations

from crossdem.adapters.case import Case, CaseError, varied_table
from crossdem.adapters.engines import get_engine
from crossdem.adapters.external import External

TWIN_SCHEMES = {
    "liggghts": "liggghts",
    "yade": "yade",
    "liggghts-averaged": "liggghts_averaged",
    "yade-averaged": "yade_averaged",
}
# The readings of a case that an engine follows; of the others its law has its own, and so has its twin.
FOLLOWED_READINGS = {"liggghts": ("attraction",), "liggghts-averaged": ("attraction",)}


def has_twin(engine: str) -> bool:
    """Users' engines have one where their description says how close they are to it."""
    return engine in TWIN_SCHEMES or own_limit_m(engine) is not None


def own_limit_m(engine: str) -> float | None:
    """How far [m] a user's engine says that its particles may be from those of its twin."""
    found = get_engine(engine)
    return found.twin_limit_m if isinstance(found, External) else None


def scheme_name(engine: str) -> str:
    """Of an engine that has a twin, for people."""
    if engine in TWIN_SCHEMES:
        return TWIN_SCHEMES[engine]
    readings = dict(get_engine(engine).scheme)
    name = readings.pop("name", "paper")
    return " ".join([name, *(f"{key} = {value}" for key, value in readings.items())])


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
    asked = case.resolved["scheme"]
    if engine in TWIN_SCHEMES:
        followed = {key: asked[key] for key in FOLLOWED_READINGS.get(engine, ())}
        scheme = {"name": TWIN_SCHEMES[engine], **followed}
    else:
        own = get_engine(engine).scheme
        scheme = dict(own) if "name" in own else asked | own
    time = case.resolved["time"] | {"step_s": get_engine(engine).step_s(case)}
    return varied_table(case, scheme=scheme, time=time)
