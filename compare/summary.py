"""The verdict on the terminal."""

from __future__ import annotations

import textwrap
from pathlib import Path

from rich.console import Console, ConsoleOptions, RenderResult
from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

from . import checks, horizon_tables, tables, verdict
from .comparison import Comparison
from .wording import MINUS, glued, glued_sentence, printable, signed_difference

NO_BREAK = "\N{NO-BREAK SPACE}"  # kept by textwrap; rich breaks there as anywhere

COLOURS = {
    verdict.AGREES: "green",
    verdict.CONSISTENT: "cyan",
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


class Pieces:
    """A cell that a narrow column parts between its pieces alone."""

    def __init__(self, *pieces: Text):
        self._pieces = pieces
        self._whole = Text(" ").join(pieces)

    @classmethod
    def of(cls, numbers: str) -> Pieces:
        return cls(*(Text(piece.replace(NO_BREAK, " ")) for piece in glued(numbers).split(" ")))

    def __rich_measure__(self, console: Console, options: ConsoleOptions) -> Measurement:
        return Measurement(max(piece.cell_len for piece in self._pieces), self._whole.cell_len)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        fits = self._whole.cell_len <= options.max_width
        yield from [self._whole] if fits else self._pieces


def print_summary(
    comparison: Comparison,
    report: Path | None = None,
    console: Console | None = None,
    replaced: str | None = None,
) -> None:
    """Print the verdict, the mean of each quantity for each engine, where the report is, and what it replaced.

    No text of a case or dataset is taken as rich's markup.
    """
    console = console or Console()
    result = comparison.verdict
    table = Table(box=None, pad_edge=False, header_style="dim")
    table.add_column("mean ± standard deviation from packing to packing")
    for engine in comparison.engines:
        table.add_column(Text(printable(engine)), justify="right")
    for title, _, cells in tables.quantity_rows(comparison):
        table.add_row(title, *map(Pieces.of, cells))
    if comparison.case.changes:
        _say(console, f"The case with {', '.join(comparison.case.changes)}:")
    console.print(table)
    if comparison.results:
        console.print()
        console.print(_outcomes(comparison))
    for (engine, seed), message in comparison.failures.items():
        _say(console, f"{engine}, seed {seed}: {message}", "magenta")
    if comparison.horizon:
        console.print()
        _say(console, horizon_tables.sentence(comparison.horizon), "dim")
    console.print()
    console.print(Text(result.word, style=f"bold {COLOURS[result.word]}"))
    _say(console, result.sentence)
    _say(console, f"Next: {result.next_step}")
    if report is not None:
        console.print(Text(f"Report: {report}"), soft_wrap=True)
    if replaced:
        _say(console, replaced, "yellow")


def _say(console: Console, text: str, style: str = "") -> None:
    lines = textwrap.wrap(
        glued_sentence(printable(text)),
        console.width,
        break_long_words=False,
        break_on_hyphens=False,
    )
    shown = "\n".join(lines).replace(NO_BREAK, " ")
    console.print(Text(shown, style=style), soft_wrap=True)


def _outcomes(comparison: Comparison) -> Table:
    """A line for each check, a column for each pair: outcome and difference."""
    table = Table(box=None, pad_edge=False, header_style="dim")
    table.add_column(f"outcome, and difference first {MINUS} second")
    for pair in comparison.pairs:
        table.add_column(Text(printable(" against ".join(pair))))
    for title, results in tables.outcome_rows(comparison):
        cells = [
            Pieces(
                Text(result.outcome, style=TONES[result.outcome]),
                Text(signed_difference(result.check, result.difference), style="dim"),
            )
            for result in results
        ]
        table.add_row(title, *cells)
    return table
