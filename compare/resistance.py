"""Quantities of the penetration resistance. Each reads a resistance table (adapters/dataset.py), one row per sample.

The resistance is force_y_N, the vertical force of the particles on the bar, > 0 upwards, against the bar's motion.
"""

from __future__ import annotations

import numpy as np
import pandas as pd

from crossdem.adapters.dataset import Dataset

# Share of the final depth at which the deep window starts: 3 of 9 cm, past the start-up of the bar.
DEEP_FROM = 1 / 3
FINE_BIN_M = 0.001  # of depth: bins that show the fluctuation with few points
ROUND_OFF_M = 1e-9  # depths are multiples of the sample interval up to round-off


def deep_window(resistance: pd.DataFrame) -> pd.DataFrame:
    """The rows from a third of the final depth to the final depth, both included."""
    depth_m = resistance["depth_m"]
    return resistance[depth_m >= DEEP_FROM * depth_m.iloc[-1] - ROUND_OFF_M]


def resistance_profile(resistance: pd.DataFrame, bin_depth_m: float = 0.01) -> pd.DataFrame:
    """Mean and scatter (standard deviation of the samples) of the resistance [N] in bins of depth [m].

    Indexed by the bins' middles. A bin holds its lower end; the last one its upper end too.
    """
    depth_m = resistance["depth_m"]
    bins = max(1, int(np.ceil(depth_m.iloc[-1] / bin_depth_m - ROUND_OFF_M)))
    depth_bin = np.floor(depth_m / bin_depth_m + ROUND_OFF_M).astype(int).clip(upper=bins - 1)
    profile = resistance.groupby(depth_bin)["force_y_N"].agg(["mean", "std", "count"])
    profile.index = (profile.index + 0.5) * bin_depth_m
    return profile.rename_axis("depth_m").rename(columns={"mean": "mean_N", "std": "scatter_N"})


def mean_resistance_N(resistance: pd.DataFrame) -> float:
    """Mean of the resistance [N] over the last two thirds of the depth."""
    return float(deep_window(resistance)["force_y_N"].mean())


def work_J(resistance: pd.DataFrame) -> float:
    """Work [J] of the bar against the resistance: its integral over the whole depth (trapezoids)."""
    return float(np.trapz(resistance["force_y_N"], resistance["depth_m"]))


def trend(resistance: pd.DataFrame) -> np.poly1d:
    """Least-squares straight line of the resistance [N] over the depth [m]."""
    return np.poly1d(np.polyfit(resistance["depth_m"], resistance["force_y_N"], deg=1))


def resistance_slope_N_m(resistance: pd.DataFrame) -> float:
    """Growth of the resistance with depth [N/m]: slope of its trend over the whole penetration."""
    return float(trend(resistance).coeffs[0])


def fluctuation_N(resistance: pd.DataFrame) -> float:
    """Standard deviation [N] of the resistance about its trend, line and deviation both over the last two thirds of the depth."""
    window = deep_window(resistance)
    deviation_N = window["force_y_N"] - trend(window)(window["depth_m"])
    return float(deviation_N.std(ddof=2))


def tip_share(resistance: pd.DataFrame) -> float:
    """Share of the mean resistance that the tip (bottom face and its corners) carries, over the last two thirds of the depth."""
    window = deep_window(resistance)
    return float(window["tip_force_y_N"].mean() / window["force_y_N"].mean())


def shaft_share(resistance: pd.DataFrame) -> float:
    """Share of the mean resistance that the shaft (the bar's sides) carries, over the last two thirds of the depth."""
    window = deep_window(resistance)
    return float(window["shaft_force_y_N"].mean() / window["force_y_N"].mean())


def kinetic_energy_J(resistance: pd.DataFrame) -> float:
    """Kinetic energy of all particles, rotation included [J], mean over the last two thirds of the depth."""
    return float(deep_window(resistance)["kinetic_energy_J"].mean())


def resistance_exponent(resistance: pd.DataFrame) -> float:
    """Exponent n of a resistance that grows as depth^n (no unit): slope of its logarithm, per cm, over that of the depth.

    NaN where the mean of some cm is not above 0.
    """
    mean_N = resistance_profile(resistance)["mean_N"]
    if len(mean_N) < 2 or not (mean_N > 0).all():
        return float("nan")
    return float(np.polyfit(np.log(mean_N.index), np.log(mean_N), deg=1)[0])


def contacts_per_particle(dataset: Dataset) -> float:
    """Overlapping pairs of particles over the number of particles, mean over the penetration."""
    return float(dataset.resistance["contacts"].mean() / len(dataset.radius_m))


def bulk_unit_weight_N_m3(dataset: Dataset) -> float:
    """Weight of the bed at t = 0 over the volume it takes up, voids included [N/m^3].

    Volume = container width x thickness x bed height; bed height = twice the height of the centre of mass, exact for
    a level, even bed and free of the question where a surface of discs lies.
    """
    case = dataset.case
    area_m2 = np.pi * dataset.radius_m**2
    height_m = 2 * np.average(dataset.motion.position_m[0, :, 1], weights=area_m2)
    solid_share = area_m2.sum() / (case["container"]["width_m"] * height_m)
    return float(case["particles"]["density_kg_m3"] * case["gravity_m_s2"] * solid_share)


def bearing_factor(dataset: Dataset) -> float:
    """Growth of the resistance over the depth, in units of gamma w b (no unit).

    gamma = bulk unit weight of the bed, w = width of the bar, b = thickness of the container.
    """
    gamma_w_b_N_m = (
        bulk_unit_weight_N_m3(dataset)
        * dataset.case["bar"]["width_m"]
        * dataset.case["container"]["thickness_m"]
    )
    return resistance_slope_N_m(dataset.resistance) / gamma_w_b_N_m
