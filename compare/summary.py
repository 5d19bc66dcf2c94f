"""The verdict on the terminal."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from . import checks, horizon_tables, tables, verdict
from .comparison import Comparison
from .wording import MINUS, printable, signed_difference

COLOURS = {
    verdict.AGREES: "green",
    verdict.CONSISTENT: "green",
    verdict.DIFFERS: "red",
    verdict.ENGINE_FAILED: "magenta",
    verdict.INCONCLUSIVE: "yellow",
}
TONES = {
    checks.EQUIVALENT: "green",
    checks.DIFFERENT: "red",
    checks.INCONCLUSIVE: "yellow",
    checks.NOT_COMPARABLE: "magenta",
}


def print_summary(
    comparison: Comparison, report: Path | None = None, console: Console | None = None
) -> None:
    """Print the verdict, the mean of each quantity for each engine, and where the report is.

    No text of a case or dataset is taken as rich's markup.
    """
    console = console or Console()
    result = comparison.verdict
    table = Table(box=None, pad_edge=False, header_style="dim")
    table.add_column("mean ± standard deviation from packing to packing")
    for engine in comparison.engines:
        table.add_column(Text(printable(engine)), justify="right")
    for title, _, cells in tables.quantity_rows(comparison):
        table.add_row(title, *cells)
    console.print(table)
    if comparison.results:
        console.print()
        console.print(_outcomes(comparison))
    for (engine, seed), message in comparison.failures.items():
        console.print(Text(printable(f"{engine}, seed {seed}: {message}"), style="magenta"))
    if comparison.horizon:
        console.print()
        console.print(Text(printable(horizon_tables.sentence(comparison.horizon)), style="dim"))
    console.print()
    console.print(Text(result.word, style=f"bold {COLOURS[result.word]}"))
    console.print(Text(printable(result.sentence)))
    console.print(Text(f"Next: {result.next_step}"))
    if report is not None:
        console.print(Text(f"Report: {report}"), soft_wrap=True)


def _outcomes(comparison: Comparison) -> Table:
    """A line for each check, a column for each pair: outcome and difference."""
    table = Table(box=None, pad_edge=False, header_style="dim")
    table.add_column(f"outcome, and difference first {MINUS} second")
    for pair in comparison.pairs:
        table.add_column(Text(printable(" against ".join(pair))))
    for title, results in tables.outcome_rows(comparison):
        cells = [
            Text(f"{result.outcome} ", style=TONES[result.outcome]).append(
                signed_difference(result.check, result.difference), style="dim"
            )
            for result in results
        ]
        table.add_row(title, *cells)
    return table
