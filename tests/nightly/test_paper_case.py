"""What the paper's case must show on four packings: the orders of magnitude, and the claim of its Fig. 10."""

import sys
from pathlib import Path

import pytest

from crossdem import ExitCode
from crossdem.adapters.dataset import Dataset
from crossdem.compare.ensemble import Ensemble

sys.path.insert(0, str(Path(__file__).parents[1] / "harness"))  # command_line.py
from command_line import REFERENCE, crossdem  # noqa: E402

SEEDS = 4
WALL_FRICTIONS = (0.0, 0.25, 0.5, 0.75)


def means(folder, command="run", engines="native", friction=0.25):
    """Mean over the packings of every quantity, by engine."""
    options = [f"--engines={engines}", f"--seeds={SEEDS}", f"--out={folder}"]
    override = f"--set=contact.particle_wall.friction={friction}"
    done = crossdem(command, REFERENCE, *options, override, timeout=3000)
    assert done.returncode == ExitCode.AGREES, done.stderr
    runs = Ensemble.of(map(Dataset.read, sorted((folder / "runs").iterdir()))).endpoints
    assert len(runs) == SEEDS * len(engines.split(","))
    return runs.groupby("engine").mean()


def test_the_engines_give_the_same_resistance_of_the_right_size(tmp_path):
    by_engine = means(tmp_path / "out", command="check", engines="native,liggghts,yade")
    resistance_N = by_engine["mean_resistance_N"]
    assert resistance_N.between(0.85, 1.15).all(), resistance_N
    assert resistance_N.max() / resistance_N.min() < 1.12, resistance_N
    assert by_engine["bearing_factor"].between(7, 25).all(), by_engine["bearing_factor"]


def test_fig_10_wall_friction_raises_the_resistance_and_the_movement_near_the_bar(tmp_path):
    found = [means(tmp_path / str(mu), friction=mu).loc["native"] for mu in WALL_FRICTIONS]
    for quantity in ("mean_resistance_N", "near_bar_movement_m"):
        values = [mean[quantity] for mean in found]
        assert values == sorted(values), (quantity, values)
    assert found[-1]["mean_resistance_N"] > 1.5 * found[0]["mean_resistance_N"]
    assert found[0]["shaft_share"] == pytest.approx(0.0, abs=1e-12)  # smooth sides carry nothing
