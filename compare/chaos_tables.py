"""How much of the scatter is chaos, in rows of text."""

from __future__ import annotations

from typing import NamedTuple

from . import wording
from .chaos import Scatter, scatters
from .comparison import Comparison
from .quantities import QUANTITIES, Quantity


class ScatterRow(NamedTuple):
    """One quantity: for each engine what beds and what chaos scatter, and the share of the beds in the variance."""

    title: str
    cells: list[tuple[str, str, str]]


def engines_with_twins(comparison: Comparison) -> list[str]:
    """Those whose packings have twins enough to tell."""
    first = next(iter(QUANTITIES))
    found = scatters(comparison.ensemble.endpoints, first) if comparison.ensemble.engines else {}
    return [engine for engine in comparison.engines if found.get(engine)]


def scatter_rows(comparison: Comparison) -> list[ScatterRow]:
    engines = engines_with_twins(comparison)
    if not engines:
        return []
    return [
        ScatterRow(quantity.title, [_cells(quantity, found.get(engine)) for engine in engines])
        for quantity in QUANTITIES.values()
        for found in [scatters(comparison.ensemble.endpoints, quantity.name)]
    ]


def _cells(quantity: Quantity, scatter: Scatter | None) -> tuple[str, str, str]:
    if scatter is None:
        return (wording.DASH,) * 3
    share = scatter.share_of_beds
    return (
        wording.quantity_value(quantity, scatter.between, digits=2),
        wording.quantity_value(quantity, scatter.within, digits=2),
        wording.DASH if share != share else f"{100 * share:.0f} %",
    )
