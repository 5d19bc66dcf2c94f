"""Fig. 11: resistance against depth, its fluctuation, and the reasons that the paper gives for both."""

from __future__ import annotations

from functools import partial

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from crossdem.adapters.case import Case

from ..colours import engine_styles
from ..resistance import FINE_BIN_M
from . import causes
from .changes import change_picture, ratios
from .estimates import mean_of
from .observation import SHARE, WAVELENGTH
from .runs import Found
from .scaling import scaled
from .study import AS_PRINTED, RESISTANCE, UNTESTABLE, Claim, Findings, Picture, Setting
from .verdicts import all_above

SLOPE = "resistance_slope_N_m"
FINER = {2: 1.0, 4: 1.5}  # parts of the diameters: how many times as long such a bed rests
STIFFER = (2, 10)  # times the springs
WIDER = (0.5, 2)  # times the bar
CONSIDERABLE = 0.1  # share of the mean resistance: what the paper's word is taken for


def settings(case: Case) -> list[Setting]:
    return [AS_PRINTED, *finer(case), *stiffer(case), *wider(case)]


def finer(case: Case) -> list[Setting]:
    rest_s = case.resolved["time"]["rest_s"]
    return [
        _of_beds(
            f"diameters / {parts}",
            scaled(case, size=1 / parts),
            (f"time.rest_s={times * rest_s!r}",),
        )
        for parts, times in FINER.items()
    ]


def stiffer(case: Case) -> list[Setting]:
    return [on_springs(case, times) for times in STIFFER]


def on_springs(case: Case, times: float) -> Setting:
    """As stiff as that, and the time step that goes with them."""
    return _of_beds(f"springs × {times:g}", scaled(case, stiffness=times))


def wider(case: Case) -> list[Setting]:
    width_m = case.resolved["bar"]["width_m"]
    return [
        _of_beds(f"bar of {100 * times * width_m:g} cm", (f"bar.width_m={times * width_m!r}",))
        for times in WIDER
    ]


def _of_beds(name: str, bed: tuple[str, ...], beside: tuple[str, ...] = ()) -> Setting:
    return Setting(name, bed + beside, bed)


def findings(found: Found) -> Findings:
    case = found.case
    varied = [*finer(case), *stiffer(case), *wider(case)]
    engines = found.engines_of(AS_PRINTED)
    claims = (
        _growth(found, engines),
        _fluctuation(found, engines),
        causes.of_fluctuation(
            found,
            finer(case),
            "The discs are large: that is one reason for the fluctuation.",
            "With the discs' diameters the fluctuation changes",
            f"discs of 1/{max(FINER)} of the diameters",
        ),
        causes.of_low_resistance(
            found,
            stiffer(case),
            "The springs are not stiff enough: that is one reason for the low resistance.",
            "The mean resistance changes with the stiffness",
            "springs ten times as stiff raise",
        ),
        Claim(
            "section 4.4, Fig. 11",
            "The simulated resistance is smaller than the measured one.",
            f"Simulated, over the deepest two thirds of the way: {mean_of(found.of(AS_PRINTED)[RESISTANCE]).shown(unit='N')}.",
            UNTESTABLE,
            "",
            "the measured curve is lost with the scans, and with it the width of the bar, which changes the resistance by "
            f"{_effect_of_width(found)}",
        ),
    )
    of_sizes = [AS_PRINTED, *finer(case)]
    pictures = (
        Picture(
            "fig11_resistance",
            "Fig. 11: resistance against depth",
            f"Means of {1000 * FINE_BIN_M:g} mm. Thin: each packing; thick: their mean.",
            (900, 340),
            partial(_draw_curves, found, engines),
            _curve_table(found, engines),
        ),
        Picture(
            "fig11_spectrum",
            "Spectrum of the fluctuation",
            "Power spectral density of the resistance about its trend, mean of the packings, native; the mean diameter "
            f"of the discs is marked. Half of the variance lies in longer waves than: {_wavelengths(found, of_sizes)}.",
            (900, 340),
            partial(_draw_spectra, found, of_sizes),
            _spectrum_table(found, of_sizes),
        ),
        change_picture("fig11_causes", "What discs, springs and bar change", "", found, varied),
    )
    return Findings("Resistance: Fig. 11", claims, pictures)


def _effect_of_width(found: Found) -> str:
    changes = ratios(found, RESISTANCE, wider(found.case))
    return ", ".join(f"{change.as_change()} for a {name}" for name, change in changes.items())


def _growth(found: Found, engines: list[str]) -> Claim:
    slopes = {engine: mean_of(found.of(AS_PRINTED, engine)[SLOPE]) for engine in engines}
    said = "; ".join(f"{engine} {one.shown(unit='N/m')}" for engine, one in slopes.items())
    return Claim(
        "section 4.4, Fig. 11",
        "The resistance grows with depth.",
        f"Slope of its trend: {said}.",
        all_above(slopes, 0.0),
        slopes[engines[0]].shown(unit="N/m") if engines else "",
        "reproduced where the 95 % interval of the slope lies above 0 in every code",
    )


def _fluctuation(found: Found, engines: list[str]) -> Claim:
    shares = {engine: mean_of(found.of(AS_PRINTED, engine)[SHARE]) for engine in engines}
    said = "; ".join(f"{engine} {one.shown(100, '%')}" for engine, one in shares.items())
    return Claim(
        "section 4.4, Fig. 11",
        "The simulated resistance fluctuates considerably.",
        f"Standard deviation about its trend, as a share of its mean: {said}.",
        all_above(shares, CONSIDERABLE),
        shares[engines[0]].shown(100, "%") if engines else "",
        f"considerable is taken for more than {100 * CONSIDERABLE:g} % of the mean",
    )


def _curve_table(found: Found, engines: list[str]) -> pd.DataFrame:
    profiles = {
        f"{engine}_seed{seed}_N": profile
        for engine in engines
        for seed, profile in found.of(AS_PRINTED, engine).profiles.iterrows()
    }
    return pd.DataFrame(profiles).rename_axis("depth_m").reset_index()


def _draw_curves(found: Found, engines: list[str], figure: Figure) -> None:
    panel = figure.subplots()
    for engine, style in engine_styles(engines).items():
        profiles = found.of(AS_PRINTED, engine).profiles
        for _, profile in profiles.iterrows():
            panel.plot(
                100 * profile.index,
                profile,
                color=style.colour,
                linewidth=0.6,
                alpha=min(0.5, 4 / len(profiles)),
            )
        mean = profiles.mean()
        dash = (0, style.dash) if style.dash else "-"
        panel.plot(
            100 * mean.index, mean, color=style.colour, linewidth=2, linestyle=dash, label=engine
        )
    panel.set(xlabel="depth of the tip, cm", ylabel="resistance, N", xlim=(0, None), ylim=(0, None))
    panel.legend()


def _wavelengths(found: Found, settings: list[Setting]) -> str:
    return "; ".join(
        f"{one.name} {mean_of(found.of(one)[WAVELENGTH]).shown(1000, 'mm')}" for one in settings
    )


def _spectrum_table(found: Found, settings: list[Setting]) -> pd.DataFrame:
    means = {f"{one.name}, N2_m": found.of(one).spectra.mean() for one in settings}
    return pd.DataFrame(means).rename_axis("cycles_per_m").reset_index()


def _draw_spectra(found: Found, settings: list[Setting], figure: Figure) -> None:
    panel = figure.subplots()
    diameter_mm = 1000 * np.mean(found.case.resolved["particles"]["diameters_m"])
    for number, setting in enumerate(settings):
        mean = found.of(setting).spectra.mean()
        if mean.empty:
            continue
        (line,) = panel.loglog(1000 / mean.index, mean, linewidth=1.4, label=setting.name)
        parts = (1, *FINER)[number]
        panel.axvline(diameter_mm / parts, color=line.get_color(), linestyle="--", linewidth=0.9)
    panel.set(xlabel="wavelength of depth, mm", ylabel="power spectral density, N²m")
    panel.legend()
