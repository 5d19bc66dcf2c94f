"""The fluctuation of the resistance: how strong it is beside the resistance, and over which lengths of the way."""

from __future__ import annotations

import numpy as np
import pandas as pd
from scipy import signal

from ..resistance import deep_window, fluctuation_N, mean_resistance_N


def fluctuation_share(resistance: pd.DataFrame) -> float:
    """Fluctuation over the mean resistance (no unit), both over the deep window; NaN without a resistance."""
    mean_N = mean_resistance_N(resistance)
    return fluctuation_N(resistance) / mean_N if mean_N else float("nan")


def spectrum(resistance: pd.DataFrame) -> pd.Series:
    """Power spectral density [N^2 m] of the resistance about its trend over the deep window, indexed by per_m: cycles
    per m of depth, one-sided, so that its sum times their spacing is the variance."""
    window = deep_window(resistance)
    depth_m = window["depth_m"].to_numpy()
    if len(depth_m) < 3:
        return pd.Series(dtype=float, index=pd.Index([], name="per_m"))
    spacing_m = (depth_m[-1] - depth_m[0]) / (len(depth_m) - 1)
    per_m, density = signal.periodogram(window["force_y_N"], fs=1 / spacing_m, detrend="linear")
    return pd.Series(density[1:], index=pd.Index(per_m[1:], name="per_m"))


def median_wavelength_m(resistance: pd.DataFrame) -> float:
    """Wavelength [m] of depth on either side of which half of the fluctuation's variance lies; NaN without fluctuation."""
    density = spectrum(resistance)
    share = density.cumsum() / density.sum()  # up to the upper end of each frequency's bin
    if density.empty or not np.isfinite(share.iloc[-1]):
        return float("nan")
    return float(1 / np.interp(0.5, share, density.index + density.index[0] / 2))
