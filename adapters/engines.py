"""The engines by name, in the order in which people read of them."""

from .engine import Engine
from .liggghts import Liggghts
from .native import Native
from .yade import Yade

ENGINES: dict[str, Engine] = {engine.name: engine for engine in (Native(), Liggghts(), Yade())}


def get_engine(name: str) -> Engine:
    """Raises KeyError for a name that is not one of ENGINES."""
    return ENGINES[name]
