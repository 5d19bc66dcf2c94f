"""Pictures of the bed, as SVG text: a disc is a dot of a round-ended stroke, a layer one path, so that a bed takes 10 kB."""

from __future__ import annotations

import numpy as np

from crossdem.adapters.dataset import Dataset

from . import motion
from .colours import LAYERS

STAGES = (0, 1 / 3, 2 / 3, 1)  # of the penetration: 0, 3, 6, 9 s in the paper
DRAWN_SHARE = 0.9  # of a disc's diameter, so that neighbours can be told apart
UNITS_PER_M = 10_000  # of the drawing: tenths of a millimetre, in whole numbers


def stage_frames(dataset: Dataset) -> list[int]:
    """The frames nearest to the stages."""
    time_s = dataset.motion.time_s
    return [int(np.argmin(np.abs(time_s - stage * time_s[-1]))) for stage in STAGES]


def bed_picture(dataset: Dataset, frame: int) -> str:
    """The bed at `frame`, coloured by the layers in which its particles started, with the bar; an <svg> element."""
    case = dataset.case
    width, height = _units(case["container"]["width_m"]), _units(case["container"]["height_m"])
    bar = case["bar"]
    left, bar_width = _units(bar["centre_x_m"] - bar["width_m"] / 2), _units(bar["width_m"])
    tip = height - _units(dataset.motion.bar_tip_m[frame])
    length = _units(bar["length_m"])
    return "".join(
        [
            f'<svg class="bed" viewBox="-8 0 {width + 16} {height + 8}" role="img">',
            *_discs(dataset, frame, height),
            f'<rect class="bar" x="{left}" y="{tip - length}" width="{bar_width}" height="{length}"/>',
            f'<path class="box" d="M0 0V{height}H{width}V0"/></svg>',
        ]
    )


def _discs(dataset: Dataset, frame: int, height: int):
    centres = np.rint(dataset.motion.position_m[frame] * UNITS_PER_M).astype(int)
    diameters = np.rint(2 * dataset.radius_m * UNITS_PER_M).astype(int)
    layers = motion.layers(dataset)
    for layer in np.unique(layers):
        colour = LAYERS[layer % len(LAYERS)]
        for diameter in np.unique(diameters[layers == layer]):
            dots = centres[(layers == layer) & (diameters == diameter)]
            path = "".join(f"M{x} {height - y}h0" for x, y in dots)
            yield f'<path d="{path}" stroke="{colour}" stroke-width="{DRAWN_SHARE * diameter:.0f}"/>'


def _units(length_m: float) -> int:
    return round(float(length_m) * UNITS_PER_M)
