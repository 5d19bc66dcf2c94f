"""Quantities of the particles' motion. x to the right, y upwards, displacements since t = 0; frame -1 is the last one."""

from __future__ import annotations

import numpy as np
import pandas as pd

from crossdem.adapters.dataset import Dataset

# Of the points at which the surface is read: a sixteenth of the paper's smaller disc.
OUTLINE_SPACING_M = 0.00025


def displacement_m(dataset: Dataset, frame: int = -1) -> np.ndarray:
    """(N, 2) displacement [m] of each particle from t = 0 to `frame`."""
    position_m = dataset.motion.position_m
    return position_m[frame] - position_m[0]


def displacement_field(dataset: Dataset, frame: int = -1) -> pd.DataFrame:
    """Mean displacement [m] of the particles whose centres started in each square cell, and their number.

    Indexed by the cells' middles (x_m, y_m); cells of marks.cell_size_m; cells that were empty are left out.
    """
    cell_m = dataset.case["marks"]["cell_size_m"]
    start_m = dataset.motion.position_m[0]
    moved_m = displacement_m(dataset, frame)
    cells = pd.DataFrame(
        {
            "x_m": _middle_m(start_m[:, 0], cell_m),
            "y_m": _middle_m(start_m[:, 1], cell_m),
            "displacement_x_m": moved_m[:, 0],
            "displacement_y_m": moved_m[:, 1],
            "particles": 1,
        }
    )
    how = {"displacement_x_m": "mean", "displacement_y_m": "mean", "particles": "sum"}
    return cells.groupby(["x_m", "y_m"]).agg(how)


def field_over_seeds(fields: list[pd.DataFrame]) -> pd.DataFrame:
    """Displacement field [m] of several runs of one engine: the mean of the particles of all of them in each cell."""
    every = pd.concat(fields)
    moved_m = every[["displacement_x_m", "displacement_y_m"]].mul(every["particles"], axis="index")
    sums = moved_m.assign(particles=every["particles"]).groupby(["x_m", "y_m"]).sum()
    means_m = sums[list(moved_m)].div(sums["particles"], axis="index")
    return means_m.assign(particles=sums["particles"])


def near_bar(dataset: Dataset) -> np.ndarray:
    """(N,) which particles the bar's sides pass closely.

    Their centres started within marks.near_bar_m of the bar's sides, outside its width, above the bar's final tip.
    """
    bar, near_m = dataset.case["bar"], dataset.case["marks"]["near_bar_m"]
    start_m = dataset.motion.position_m[0]
    beside_m = np.abs(start_m[:, 0] - bar["centre_x_m"]) - bar["width_m"] / 2
    passed = start_m[:, 1] >= dataset.motion.bar_tip_m[-1]
    return (beside_m >= 0) & (beside_m <= near_m) & passed


def near_bar_history(dataset: Dataset) -> pd.DataFrame:
    """Mean displacement [m] of the particles near the bar at each frame; downward_m > 0 is down, with the bar.

    Indexed by time_s.
    """
    moved_m = (dataset.motion.position_m - dataset.motion.position_m[0])[:, near_bar(dataset)]
    mean_m = moved_m.mean(axis=1) if moved_m.size else np.full((len(moved_m), 2), np.nan)
    time_s = pd.Index(dataset.motion.time_s, name="time_s")
    return pd.DataFrame({"sideways_m": mean_m[:, 0], "downward_m": -mean_m[:, 1]}, index=time_s)


def near_bar_movement_m(dataset: Dataset) -> float:
    """Mean downward displacement [m] at the end of the particles near the bar (the case's marks.near_bar_m); > 0 is down, with the bar."""
    return float(near_bar_history(dataset)["downward_m"].iloc[-1])


def surface_profile(dataset: Dataset, frame: int = -1) -> pd.Series:
    """Height [m] of the bed's surface in columns of marks.cell_size_m, indexed by the columns' middles x_m.

    The surface is the upper outline of the discs, read at points across the column and averaged; what lies within the
    bar's width is left out, so that columns inside the bar are NaN at every frame, whether the bar is there yet or not.
    """
    case = dataset.case
    cell_m, width_m, bar = case["marks"]["cell_size_m"], case["container"]["width_m"], case["bar"]
    points = round(width_m / OUTLINE_SPACING_M)
    x_m = (np.arange(points) + 0.5) * width_m / points
    outline_m = _outline_m(dataset.motion.position_m[frame], dataset.radius_m, x_m)
    outline_m[np.abs(x_m - bar["centre_x_m"]) < bar["width_m"] / 2] = np.nan
    surface_m = pd.Series(outline_m).groupby(_middle_m(x_m, cell_m)).mean()
    return surface_m.rename("surface_m").rename_axis("x_m")


def surface_bump_m(dataset: Dataset) -> float:
    """Height of the bump that the bar raises [m]: the largest rise of a column of the surface, mean of both sides."""
    rise_m = surface_profile(dataset, -1) - surface_profile(dataset, 0)
    left = rise_m.index < dataset.case["bar"]["centre_x_m"]
    return float((rise_m[left].max() + rise_m[~left].max()) / 2)


def surface_heave_m(dataset: Dataset) -> float:
    """Rise of the surface that the bar causes [m]: mean over all columns beside the bar; > 0 is up."""
    return float((surface_profile(dataset, -1) - surface_profile(dataset, 0)).mean())


def layers(dataset: Dataset) -> np.ndarray:
    """(N,) number of the layer, from 0 at the floor, in which each particle started: the chalk lines' layers."""
    height_m = dataset.case["marks"]["layer_height_m"]
    return np.floor(dataset.motion.position_m[0, :, 1] / height_m).astype(int)


def _middle_m(coordinate_m: np.ndarray, cell_m: float) -> np.ndarray:
    """Middle [m] of the cell that holds each coordinate; the same cell gives the same bits."""
    return (np.floor(coordinate_m / cell_m) + 0.5) * cell_m


def _outline_m(centre_m: np.ndarray, radius_m: np.ndarray, x_m: np.ndarray) -> np.ndarray:
    """Height [m] of the topmost disc's upper rim at each of the evenly spaced x_m; NaN where there is no disc.

    Each disc is held against the few points within the largest radius of its own: all pairs are most of a comparison's time.
    """
    reach = np.searchsorted(x_m, x_m[0] + radius_m.max()) + 1
    near = np.searchsorted(x_m, centre_m[:, 0])[:, np.newaxis] + np.arange(-reach, reach + 1)
    point = near.clip(0, len(x_m) - 1)
    aside_m2 = (x_m[point] - centre_m[:, :1]) ** 2
    disc, column = np.nonzero(radius_m[:, np.newaxis] ** 2 >= aside_m2)
    point = point[disc, column]
    rim_m = np.sqrt(radius_m[disc] ** 2 - aside_m2[disc, column])
    highest_m = np.full(len(x_m), -np.inf)
    np.maximum.at(highest_m, point, centre_m[disc, 1] + rim_m)
    return np.where(np.isfinite(highest_m), highest_m, np.nan)
