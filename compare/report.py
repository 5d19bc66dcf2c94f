"""The report of a comparison: report.html (self-contained), report.md, report.json and junit.xml."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from markupsafe import Markup

from crossdem.adapters.files import write_whole

from . import (
    beds,
    chaos_tables,
    figures,
    horizon_report,
    horizon_tables,
    opinion_figures,
    opinion_tables,
    run_tables,
    tables,
    wording,
)
from .checks import ALARM_LEVEL, SEEDS_FOR_INTERVAL
from .colours import engine_styles
from .comparison import Comparison
from .curve_data import curve_data
from .drawing import svg
from .figure_files import write_figures
from .junit import junit_xml
from .pages import embedded, render
from .record import libraries, record_text
from .recorded import DATE
from .viewer import viewer_data

WIDE_PX, NARROW_PX, PANEL_PX = (900, 400), (380, 320), (440, 320)
FIELD_PX = (400, 460)
ASSETS = (
    "uPlot.min.css",
    "uPlot.iife.min.js",
    "overlaps.js",
    "viewer.js",
    "curves.js",
    "filter.js",
)
SECTIONS = {
    "beds": "Motion",
    "resistance": "Resistance",
    "checks": "Checks",
    "horizon": "Horizon",
    "ladder": "Ladder and attribution",
    "provenance": "Provenance",
}


def write_report(comparison: Comparison, out_dir: Path) -> Path:
    """Write the four files and figures/ into `out_dir`, each whole or not at all; returns the path of report.html, written last."""
    out_dir = Path(out_dir)
    out_dir.mkdir(parents=True, exist_ok=True)
    values = _values(comparison)
    write_whole(out_dir / "report.json", record_text(comparison).encode())
    write_whole(out_dir / "junit.xml", junit_xml(comparison))
    write_whole(out_dir / "report.md", render("report.md", values).encode())
    write_figures(comparison, out_dir)
    values |= _pictures(comparison) | {"neighbours": _neighbours(out_dir)}
    write_whole(out_dir / "report.html", render("report.html", values, ASSETS).encode())
    return out_dir / "report.html"


def _values(comparison: Comparison) -> dict:
    """What both templates show."""
    return {
        "title": comparison.case.resolved["title"],
        "case": comparison.case,
        "comparison": comparison,
        "verdict": comparison.verdict,
        "engines": comparison.engines,
        "versions": _versions(comparison),
        "headlines": tables.headlines(comparison),
        "profile_rows": tables.profile_rows(comparison),
        "quantity_rows": tables.quantity_rows(comparison),
        "check_blocks": tables.check_blocks(comparison),
        "outcome_rows": tables.outcome_rows(comparison),
        "pair_matrix": tables.pair_matrix(comparison),
        "scatter_engines": chaos_tables.engines_with_twins(comparison),
        "scatter_rows": chaos_tables.scatter_rows(comparison),
        "gate_rows": run_tables.gate_rows(comparison),
        "run_rows": run_tables.run_rows(comparison),
        "fewest": SEEDS_FOR_INTERVAL,
        "alarm_level": ALARM_LEVEL,
        "limitations": {
            engine: next(iter(manifests.values()))["limitations"]
            for engine in comparison.engines
            if (manifests := comparison.manifests(engine))
        },
        "horizon": horizon_tables.values(comparison.horizon) if comparison.horizon else None,
        "opinions": opinion_tables.values(comparison.opinions),
        "libraries": libraries(),
    }


def _pictures(comparison: Comparison) -> dict:
    """What only the page shows."""
    runs = {
        engine: comparison.of(engine)[0] for engine in comparison.engines if comparison.of(engine)
    }
    shared = _shared_seed(comparison)
    runs = {
        engine: next((run for run in comparison.of(engine) if run.seed == shared), first)
        for engine, first in runs.items()
    }
    times_s = [
        f"{comparison.case.resolved['time']['penetration_s'] * stage:.3g} s"
        for stage in beds.STAGES
    ]
    seen, curves = viewer_data(runs), curve_data(comparison)
    return {
        "sections": SECTIONS.items(),
        "absent": ([] if runs else ["beds"])
        + ([] if comparison.ensemble.manifests else ["resistance"]),
        "viewer": embedded(seen) if seen else None,
        "curves": embedded(curves) if curves else None,
        "colours": {
            engine: style.colour for engine, style in engine_styles(comparison.engines).items()
        },
        "resistance_wide": _plot(figures.draw_resistance, comparison, WIDE_PX),
        "resistance_narrow": _plot(figures.draw_resistance, comparison, NARROW_PX),
        "fields": {
            engine: Markup(svg(draw, FIELD_PX))
            for engine, draw in figures.draw_fields(
                comparison, figures.displacement_fields(comparison)
            ).items()
        },
        "surface": _plot(figures.draw_surface, comparison, PANEL_PX) if runs else "",
        "movement": _plot(figures.draw_movement, comparison, PANEL_PX),
        "beds": {
            engine: (
                run.seed,
                [
                    (time, Markup(beds.bed_picture(run, frame)))
                    for time, frame in zip(times_s, beds.stage_frames(run))
                ],
            )
            for engine, run in runs.items()
        },
        "horizon": horizon_report.page_values(comparison.horizon) if comparison.horizon else None,
        "opinions": opinion_tables.values(comparison.opinions)
        | opinion_figures.pictures(comparison.opinions, comparison.case.resolved),
    }


def _neighbours(out_dir: Path) -> list[str]:
    """The other pages of this case that the commands wrote into the report's folder, as paths from there."""
    return sorted(
        page.relative_to(out_dir).as_posix()
        for name in ("ladder.html", "horizon/horizon.html", "explain-*/explain.html")
        for page in out_dir.glob(name)
    )


def _plot(draw: Callable, comparison: Comparison, size_px: tuple[int, int]) -> Markup:
    return Markup(svg(lambda axes: draw(axes, comparison), size_px))


def _versions(comparison: Comparison) -> dict[str, str]:
    """What each engine says of itself; of several versions, all."""
    return {
        engine: _version(comparison, comparison.manifests(engine)) for engine in comparison.engines
    }


def _version(comparison: Comparison, manifests: dict) -> str:
    versions = ", ".join(dict.fromkeys(one["engine_version"] for one in manifests.values()))
    if manifests and manifests.keys() <= comparison.recorded:
        days = sorted({one.get(DATE, "").split("T")[0] for one in manifests.values()} - {""})
        return f"{' '.join(['recorded', *days])}: {versions}"
    return versions or "no result"


def _shared_seed(comparison: Comparison) -> int | None:
    """The first seed that every engine with results has, to show the same bed in all of them."""
    seeds = [{run.seed for run in runs} for e in comparison.engines if (runs := comparison.of(e))]
    return min(set.intersection(*seeds), default=None) if seeds else None
