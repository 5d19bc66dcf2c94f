"""The engines by name, in the order in which people read of them."""

from .engine import Engine
from .liggghts import Liggghts, LiggghtsAveraged
from .native import Native
from .yade import Yade, YadeAveraged

ENGINES: dict[str, Engine] = {
    engine.name: engine
    for engine in (Native(), Liggghts(), Yade(), LiggghtsAveraged(), YadeAveraged())
}
DEFAULT_ENGINES = ("native", "liggghts", "yade")  # those that a command takes unless it is told


def unknown_engines(case: dict) -> list[str]:
    """A fault line for each table of `engines` that no engine would read; the rest is the schema's."""
    named = case.get("engines", {})
    others = [name for name in ENGINES if name != "native"]
    return [
        f"engines.{name}: "
        + (
            "its time step is time.step_s"
            if name == "native"
            else f"no such engine; known: {', '.join(others)}"
        )
        for name in (named if isinstance(named, dict) else ())
        if name not in others
    ]


def get_engine(name: str) -> Engine:
    """Raises KeyError for a name that is not one of ENGINES."""
    return ENGINES[name]
