"""What a study of the paper's claims consists of: settings of the case that are run, claims, figures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import pandas as pd
from matplotlib.figure import Figure

REPRODUCED = "reproduced"
CORRECTED = "reproduced with a correction"
NOT_REPRODUCED = "not reproduced"
UNTESTABLE = "cannot be tested"
UNDECIDED = "not decided by these runs"  # an interval too wide, or no run at all
VERDICTS = (REPRODUCED, CORRECTED, NOT_REPRODUCED, UNTESTABLE, UNDECIDED)


IN_A_PACKING = (
    "bar.",
    "container.",
    "packing.",
    "particles.",
)  # what a packing is made by, where the bar starts among it


@dataclass(frozen=True)
class Setting:
    """The case with some values changed, in the native solver and, where `engines`, in the others too.

    Raises ValueError where its beds would be made for another bar, container or particles than it has.
    """

    name: str  # as people read it, and the only one of that name
    overrides: tuple[str, ...] = ()
    bed: tuple[
        str, ...
    ] = ()  # those of `overrides` under which its beds settle; none: the beds of the case itself
    engines: bool = False

    def __post_init__(self) -> None:
        if astray := [
            one for one in self.overrides if one.startswith(IN_A_PACKING) and one not in self.bed
        ]:
            raise ValueError(f"{self.name}: its beds know nothing of {', '.join(astray)}")


AS_PRINTED = Setting("as the paper has it", engines=True)
RESISTANCE = "mean_resistance_N"  # of the quantities, the one that most studies look at


@dataclass(frozen=True)
class Claim:
    """A statement of the paper that runs can test."""

    source: str  # section, equation or figure of the paper
    says: str
    found: str
    verdict: str  # of VERDICTS
    number: str  # that carries the verdict
    why: str = ""  # how the verdict follows from the number, or why it cannot be tested


@dataclass(frozen=True)
class Picture:
    """A figure, and the numbers that are drawn in it."""

    name: str  # of its files
    title: str
    says: str  # what is drawn
    size_px: tuple[int, int]
    draw: Callable[[Figure], None]
    table: pd.DataFrame | None = None


@dataclass(frozen=True)
class Findings:
    """What a study found."""

    title: str
    claims: tuple[Claim, ...] = ()
    pictures: tuple[Picture, ...] = ()
