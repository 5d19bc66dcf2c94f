"""Beds side by side as a figure: a row of pictures for each code or setting."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from crossdem.adapters.dataset import Dataset

from .. import motion
from ..beds import DRAWN_SHARE
from ..colours import LAYERS
from ..drawing import INK

CM = 100.0
DOTS_PER_INCH = (
    150  # of the discs, which are pixels also in an SVG: thousands of them would be megabytes
)


def draw_beds(rows: Sequence[Sequence[tuple[str, Dataset, float]]], figure: Figure) -> None:
    """`rows` of (title of the picture, run, time [s]); where a row's titles are all the same, it stands beside the row."""
    panels = figure.subplots(len(rows), len(rows[0]), squeeze=False)
    figure.set_dpi(DOTS_PER_INCH)
    for number, row in enumerate(rows):
        one_title = len({title for title, _, _ in row}) == 1 and len(row) > 1
        for place, (title, dataset, time_s) in enumerate(row):
            panel = panels[number][place]
            draw_bed(dataset, time_s, panel)
            if not one_title:
                panel.set_title(title, fontsize=9)
            elif number == 0:
                panel.set_title(f"{time_s:g} s", fontsize=9)
        if one_title:
            panels[number][0].set_ylabel(row[0][0])


def draw_bed(dataset: Dataset, time_s: float, panel: Axes) -> None:
    """The bed at the frame nearest to `time_s`, coloured by the layers in which its particles started, with the bar."""
    case, frame = dataset.case, int(np.argmin(np.abs(dataset.motion.time_s - time_s)))
    diameter_cm = CM * 2 * DRAWN_SHARE * dataset.radius_m
    colours = np.array(LAYERS)[motion.layers(dataset) % len(LAYERS)]
    discs = EllipseCollection(
        diameter_cm,
        diameter_cm,
        np.zeros_like(diameter_cm),
        units="xy",
        offsets=CM * dataset.motion.position_m[frame],
        transOffset=panel.transData,
        facecolors=colours,
        linewidths=0,
        rasterized=True,
    )
    panel.add_collection(discs)
    width_cm, height_cm = CM * case["container"]["width_m"], CM * case["container"]["height_m"]
    bar, tip_cm = case["bar"], CM * dataset.motion.bar_tip_m[frame]
    corner_cm = CM * (bar["centre_x_m"] - bar["width_m"] / 2), tip_cm
    panel.add_patch(
        Rectangle(
            corner_cm,
            CM * bar["width_m"],
            height_cm - tip_cm,
            facecolor="#9aa1ab",
            edgecolor=INK,
            linewidth=0.6,
        )
    )
    panel.plot([0, 0, width_cm, width_cm], [height_cm, 0, 0, height_cm], color=INK, linewidth=1)
    panel.set(
        xlim=(-0.2, width_cm + 0.2),
        ylim=(-0.2, height_cm + 0.2),
        aspect="equal",
        xticks=[],
        yticks=[],
    )
    panel.grid(False)
    for side in panel.spines.values():
        side.set_visible(False)
