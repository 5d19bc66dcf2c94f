"""One colour per engine, the same in every figure and table; legible on white and on black."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class EngineStyle:
    colour: str
    marker: str  # of Matplotlib; tells engines apart without colour
    dash: tuple[float, ...]  # lengths of a line's strokes and gaps; empty: solid


KNOWN = {
    "native": EngineStyle("#3b82d6", "o", ()),
    "liggghts": EngineStyle("#e0752d", "s", (6, 2)),
    "yade": EngineStyle("#1fa187", "^", (2, 1.5)),
    "lammps": EngineStyle("#8a5a3c", "p", (8, 2, 2, 2)),
    "liggghts-averaged": EngineStyle("#b565c9", "D", (6, 2, 1.5, 2)),
    "yade-averaged": EngineStyle("#c9a227", "v", (4, 1)),
}
OTHERS = (
    EngineStyle("#d1477a", "P", (1, 1)),
    EngineStyle("#7d8590", "X", (8, 2)),
    EngineStyle("#7a9a2e", "*", (3, 3)),
)
LAYERS = (
    "#c8a165",
    "#8c6d46",
    "#d9c39a",
    "#6f7f8f",
    "#a9856b",
)  # soils, from the floor up, then again


def engine_styles(engines: Sequence[str]) -> dict[str, EngineStyle]:
    others = [engine for engine in engines if engine not in KNOWN]
    return {
        engine: KNOWN[engine] if engine in KNOWN else OTHERS[others.index(engine) % len(OTHERS)]
        for engine in engines
    }
