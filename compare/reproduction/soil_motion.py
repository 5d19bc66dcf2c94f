"""Figs. 8 and 9: the soil near the bar goes down with it."""

from __future__ import annotations

from functools import partial

import pandas as pd
from matplotlib.figure import Figure

from crossdem.adapters.case import Case

from ..colours import LAYERS, engine_styles
from ..wording import number
from .bed_pictures import draw_beds
from .estimates import mean_of
from .runs import Found
from .study import AS_PRINTED, UNTESTABLE, Claim, Findings, Picture, Setting
from .verdicts import all_above

TIMES_S = (1.0, 3.0, 5.0, 7.0, 9.0)
MM = 1000.0
MOVEMENT = "near_bar_movement_m"


def settings(case: Case) -> list[Setting]:
    return [AS_PRINTED]


def findings(found: Found) -> Findings:
    engines = found.engines_of(AS_PRINTED)
    movements = {engine: mean_of(found.of(AS_PRINTED, engine)[MOVEMENT]) for engine in engines}
    said = "; ".join(f"{engine} {one.shown(MM, 'mm')}" for engine, one in movements.items())
    near_mm = MM * found.case.resolved["marks"]["near_bar_m"]
    claims = (
        Claim(
            "sections 4.1, 4.2, Figs. 8 and 9",
            "Particles near the bar move down with it, as the soil did.",
            f"Those that start within {number(near_mm, 2)} mm of the bar's sides go down, by the end, by: {said}.",
            all_above(movements, 0.0),
            movements[engines[0]].shown(MM, "mm") if engines else "",
            "reproduced where the 95 % interval of the movement lies above 0 in every code",
        ),
        Claim(
            "Fig. 8",
            "The simulated layers look like the photographed ones.",
            "The layers at the photographs' times are drawn below.",
            UNTESTABLE,
            "",
            "the photographs are lost with the scans: no displacement of the soil is given as a number",
        ),
    )
    return Findings("Motion of the soil: Figs. 8 and 9", claims, _pictures(found, engines))


def _pictures(found: Found, engines: list[str]) -> tuple[Picture, ...]:
    rows = [
        (engine, dataset) for engine in engines if (dataset := found.of(AS_PRINTED, engine).first())
    ]
    if not rows:
        return ()
    end_s = rows[0][1].motion.time_s[-1]
    times_s = [time_s for time_s in TIMES_S if time_s <= end_s + 1e-9] or [end_s]
    return (
        Picture(
            "fig9_beds",
            "Fig. 9: the bed and its layers",
            f"The bed of seed {rows[0][1].seed} in each code, layers of 3 cm, at the times of the paper's figure.",
            (220 * len(times_s) + 60, 190 * len(rows) + 30),
            partial(draw_beds, [[(engine, data, t) for t in times_s] for engine, data in rows]),
        ),
        Picture(
            "fig9_layers",
            "Figs. 8 and 9: how far the layers go down near the bar",
            "Mean downward movement of the particles of each layer that start near the bar, mean of the packings; layers "
            "are counted from the floor.",
            (900, 320),
            partial(_draw_layers, found, engines),
            _layer_table(found, engines),
        ),
    )


def _layer_table(found: Found, engines: list[str]) -> pd.DataFrame:
    columns = {
        (engine, layer): MM * movement
        for engine in engines
        for layer, movement in found.of(AS_PRINTED, engine).layers.items()
    }
    table = pd.DataFrame(columns)
    table.columns = [f"{engine}_layer_{layer + 1}_mm" for engine, layer in columns]
    return table.reset_index()


def _draw_layers(found: Found, engines: list[str], figure: Figure) -> None:
    panels = figure.subplots(1, len(engines), sharey=True, squeeze=False)[0]
    for panel, engine in zip(panels, engines):
        for layer, movement in found.of(AS_PRINTED, engine).layers.items():
            colour = LAYERS[layer % len(LAYERS)]
            panel.plot(
                movement.index, MM * movement, color=colour, linewidth=2, label=f"layer {layer + 1}"
            )
        panel.set_title(engine, color=engine_styles(engines)[engine].colour, fontsize=10)
        panel.set(xlabel="time, s", xlim=(0, None))
    panels[0].set_ylabel("downward movement, mm")
    panels[0].legend(fontsize=8)
