"""The engines by name, in the order in which people read of them; users' own are attached behind them."""

import importlib.util
import sys
from collections.abc import Iterable
from pathlib import Path

from .engine import Engine
from .engine_file import EngineFileError, read_engine
from .engine_file_faults import CLASS_KEYS, NAME, class_faults
from .external import External
from .liggghts import Liggghts, LiggghtsAveraged
from .native import Native
from .yade import Yade, YadeAveraged

OURS = (Native(), Liggghts(), Yade(), LiggghtsAveraged(), YadeAveraged())
ENGINES: dict[str, Engine] = {engine.name: engine for engine in OURS}
DEFAULT_ENGINES = ("native", "liggghts", "yade")  # those that a command takes unless it is told


def attach(description: str) -> str:
    """Adds the engine that `description`, FILE.toml or FILE.py:CLASS, names; returns its name. Raises EngineFileError.

    A Python file is code of its user's and is run as such.
    """
    engine = (
        _of_class(description)
        if not description.endswith(".toml") and ":" in description
        else read_engine(Path(description))
    )
    if any(engine.name == ours.name for ours in OURS):
        raise EngineFileError(
            f"{description}: name: {engine.name} is the name of one of crossdem's own engines"
        )
    other = ENGINES.get(engine.name)
    if other and other.source != engine.source:
        raise EngineFileError(f"{description}: name: {other.source} has the name {engine.name} too")
    ENGINES[engine.name] = engine
    return engine.name


def attached(names: Iterable[str]) -> list[str]:
    """What `attach` has to be told in another process, for those of these engines that are users' own."""
    found = (get_engine(name) for name in sorted(set(names)))
    return [engine.description for engine in found if isinstance(engine, External)]


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


def _of_class(description: str) -> External:
    path, _, class_name = description.rpartition(":")
    source = Path(path).resolve()
    if source.suffix != ".py" or not source.is_file():
        raise EngineFileError(
            f"{description}: give FILE.toml or FILE.py:CLASS; {source} is no Python file"
        )
    spec = importlib.util.spec_from_file_location(f"crossdem_engine_{source.stem}", source)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # as dataclasses look there
    try:
        spec.loader.exec_module(module)
        found = getattr(module, class_name, None)
        if not (isinstance(found, type) and issubclass(found, External)):
            raise EngineFileError(
                f"{description}: {source.name} holds no class {class_name} derived from crossdem.adapters.external.External"
            )
        engine = found(source)
    except EngineFileError:
        raise
    except Exception as error:
        raise EngineFileError(f"{description}: {type(error).__name__}: {error}") from error
    if not NAME.fullmatch(str(getattr(engine, "name", ""))):
        raise EngineFileError(
            f"{description}: its class has no `name` of small letters, digits and hyphens"
        )
    said = {key: getattr(engine, key) for key in CLASS_KEYS if hasattr(engine, key)}
    said = {key: value for key, value in said.items() if value is not None}
    if found := class_faults(said, description, source.parent):
        raise EngineFileError("\n".join(found))
    return engine
