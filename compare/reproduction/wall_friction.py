"""Fig. 10: what the friction between particle and bar does to the motion and to the surface."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy import stats

from crossdem.adapters.case import Case
from crossdem.adapters.gates import REFERENCE

from ..colours import engine_styles
from ..quantities import QUANTITIES
from ..wording import quantity_value
from .bed_pictures import draw_beds
from .estimates import Estimate, difference_of, mean_of
from .runs import Found
from .study import (
    CORRECTED,
    NOT_REPRODUCED,
    REPRODUCED,
    RESISTANCE,
    UNDECIDED,
    UNTESTABLE,
    Claim,
    Findings,
    Picture,
    Setting,
)

COEFFICIENTS = (0.0, 0.25, 0.5, 0.75)  # Table 2, of both kinds
PARTICLES = 0.75  # section 4.3, while the wall's varies
LEVEL = 0.05
MOVEMENT, BUMP = "near_bar_movement_m", "surface_bump_m"


def setting(particles: float, wall: float) -> Setting:
    """On the beds of the case, which come to rest anew under these coefficients before the bar starts: a bed whose discs
    have no friction could not be made from falling ones, as nothing takes the spin from a disc in its middle.
    """
    overrides = (
        f"contact.particle_particle.friction={particles}",
        f"contact.particle_wall.friction={wall}",
    )
    name = f"friction {particles:g}, of the wall {wall:g}"
    return Setting(name, overrides, engines=particles == PARTICLES)


ROW = tuple(setting(PARTICLES, wall) for wall in COEFFICIENTS)


def settings(case: Case) -> list[Setting]:
    return [setting(particles, wall) for particles in COEFFICIENTS for wall in COEFFICIENTS]


def findings(found: Found) -> Findings:
    claims = (
        _claim(
            found,
            MOVEMENT,
            "The rougher the wall, the larger the movement of the particles near the bar.",
        ),
        _claim(found, BUMP, "The rougher the wall, the clearer the bump of the surface."),
        Claim(
            "section 4.3, Fig. 10",
            "A wall friction of 0.25 resembles the soil most.",
            "By how much the motion differs from one coefficient to the next is told above.",
            UNTESTABLE,
            "",
            "what the soil did is only in photographs, which are lost with the scans",
        ),
    )
    return Findings("Friction of the wall: Fig. 10", claims, _pictures(found))


def verdict_of(means: Sequence[float], steps: Sequence[Estimate], p: float) -> str:
    """Of a quantity that is to grow from setting to setting: Page's trend test over the packings, and each step by itself."""
    if p >= LEVEL or not np.isfinite(p):
        falls = all(step.known and step.high < 0 for step in steps)
        return NOT_REPRODUCED if falls or means[-1] <= means[0] else UNDECIDED
    if any(step.known and step.high < 0 for step in steps):
        return CORRECTED
    return REPRODUCED if all(np.diff(means) > 0) else CORRECTED


def _claim(found: Found, quantity: str, says: str) -> Claim:
    values = _values(found, quantity, REFERENCE)
    means = values.mean()
    steps = [
        difference_of(values[after], values[before])
        for before, after in zip(values, values.columns[1:])
    ]
    p = stats.page_trend_test(values.to_numpy()).pvalue if len(values) > 2 else float("nan")
    whole = difference_of(values.iloc[:, -1], values.iloc[:, 0])
    factor, unit = QUANTITIES[quantity].shown_unit
    grows = " then ".join(f"{factor * step.mean:+.2f}" for step in steps)
    others = "; ".join(
        f"{engine} {difference_of(theirs.iloc[:, -1], theirs.iloc[:, 0]).shown(factor, unit)}"
        for engine in found.engines_of(ROW[0])[1:]
        for theirs in [_values(found, quantity, engine)]
    )
    shown = ", ".join(quantity_value(QUANTITIES[quantity], mean) for mean in means)
    return Claim(
        "section 4.3, Fig. 10",
        says,
        f"{shown} at wall frictions of {', '.join(f'{one:g}' for one in COEFFICIENTS)} ({grows} {unit}); from the "
        f"smoothest to the roughest {whole.shown(factor, unit)} in native{'; ' + others if others else ''}.",
        verdict_of(list(means), steps, p),
        f"{whole.shown(factor, unit)}, p of the trend {p:.2g}",
        "reproduced where Page's test finds the trend over the packings (p < 0.05) and every step goes up; with a "
        "correction where some step does not",
    )


def _values(found: Found, quantity: str, engine: str) -> pd.DataFrame:
    """A row per packing that ran at every coefficient, a column per coefficient."""
    columns = {wall: found.of(one, engine)[quantity] for wall, one in zip(COEFFICIENTS, ROW)}
    return pd.DataFrame(columns).dropna()


def _pictures(found: Found) -> tuple[Picture, ...]:
    runs = [(wall, found.of(one).first()) for wall, one in zip(COEFFICIENTS, ROW)]
    beds = [
        (f"wall friction {wall:g}", data, data.motion.time_s[-1]) for wall, data in runs if data
    ]
    pictures = [
        Picture(
            "fig10_friction",
            "Fig. 10: movement, bump and resistance against the friction of the wall",
            "Mean of the packings and its 95 % interval, at a friction between particles of 0.75.",
            (960, 300),
            partial(_draw_row, found),
            _row_table(found),
        ),
        Picture(
            "fig10_map",
            "All combinations of Table 2",
            "Native, mean of the packings: movement near the bar, height of the bump, mean resistance. An asterisk: some of "
            "the beds do not rest, as nothing takes the spin from a disc without friction in its middle; their values are shown "
            "here, and in no claim.",
            (960, 300),
            partial(_draw_map, found),
            _map_table(found),
        ),
    ]
    if beds:
        says = f"Native, seed {beds[0][1].seed}, layers of 3 cm, at the end of the penetration."
        draw = partial(draw_beds, [beds])
        pictures.insert(
            0, Picture("fig10_beds", "Fig. 10: the bed at the end", says, (960, 260), draw)
        )
    return tuple(pictures)


def _row_table(found: Found) -> pd.DataFrame:
    rows = [
        {
            "engine": engine,
            "wall_friction": wall,
            "quantity": quantity,
            **vars(mean_of(found.of(one, engine)[quantity])),
        }
        for quantity in (MOVEMENT, BUMP, RESISTANCE)
        for wall, one in zip(COEFFICIENTS, ROW)
        for engine in found.engines_of(one)
    ]
    return pd.DataFrame(rows)


def _draw_row(found: Found, figure: Figure) -> None:
    table = _row_table(found)
    engines = list(table["engine"].unique())
    for panel, quantity in zip(figure.subplots(1, 3), (MOVEMENT, BUMP, RESISTANCE)):
        factor, unit = QUANTITIES[quantity].shown_unit
        for number, (engine, style) in enumerate(engine_styles(engines).items()):
            one = table[(table["engine"] == engine) & (table["quantity"] == quantity)]
            aside = 0.012 * (number - (len(engines) - 1) / 2)
            panel.errorbar(
                one["wall_friction"] + aside,
                factor * one["mean"],
                yerr=factor * np.array([one["mean"] - one["low"], one["high"] - one["mean"]]),
                color=style.colour,
                marker=style.marker,
                linestyle=(0, style.dash) if style.dash else "-",
                capsize=3,
                label=engine,
            )
        panel.set(
            xlabel="friction of the wall",
            ylabel=f"{QUANTITIES[quantity].title}, {unit}",
            xticks=COEFFICIENTS,
        )
    panel.legend(fontsize=8)


def _map_table(found: Found) -> pd.DataFrame:
    rows = [
        {
            "particle_friction": particles,
            "wall_friction": wall,
            "quantity": quantity,
            **vars(mean_of(sample.with_restless[quantity])),
            "restless": len(sample.restless),
        }
        for particles in COEFFICIENTS
        for wall in COEFFICIENTS
        for sample in [found.of(setting(particles, wall))]
        for quantity in (MOVEMENT, BUMP, RESISTANCE)
    ]
    return pd.DataFrame(rows)


def _draw_map(found: Found, figure: Figure) -> None:
    table = _map_table(found)
    for panel, quantity in zip(figure.subplots(1, 3), (MOVEMENT, BUMP, RESISTANCE)):
        factor, unit = QUANTITIES[quantity].shown_unit
        values = factor * table[table["quantity"] == quantity].pivot(
            index="particle_friction", columns="wall_friction", values="mean"
        )
        panel.imshow(values, origin="lower", cmap="viridis", aspect="auto")
        middle = np.nanmean([np.nanmin(values), np.nanmax(values)])
        for (row, column), value in np.ndenumerate(values.to_numpy()):
            restless = found.of(setting(COEFFICIENTS[row], COEFFICIENTS[column])).restless
            colour = "white" if value < middle else "black"
            panel.text(
                column,
                row,
                f"{value:.3g}{'*' if restless else ''}",
                ha="center",
                va="center",
                color=colour,
                fontsize=9,
            )
        ticks = range(len(COEFFICIENTS))
        panel.set_xticks(ticks, [f"{one:g}" for one in COEFFICIENTS])
        panel.set_yticks(ticks, [f"{one:g}" for one in COEFFICIENTS])
        panel.set(xlabel="friction of the wall", ylabel="friction between particles")
        panel.set_title(f"{QUANTITIES[quantity].title}, {unit}", fontsize=9)
        panel.grid(False)
