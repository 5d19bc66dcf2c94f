#!/usr/bin/python3
"""The native solver as a user's code: its results by the files of the contract, spoilt in the way that FAULT names."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pandas as pd

SOLVER = os.environ["CROSSDEM_SOLVER"]
FAULT = os.environ.get("FAULT", "none")
CONFORMS = "CONFORMS" in os.environ


def main():
    if sys.argv[1:] == ["--version"]:
        print(os.environ.get("SAID_VERSION", "door 1.0"))
        return 0
    given = dict(zip(sys.argv[1::2], sys.argv[2::2]))
    out = Path(given["--out"])
    # By the paper's scheme it adds energy there, which a user's code is not to do.
    if (
        CONFORMS
        and json.loads(Path(given["--case"]).read_text())["name"] == "undamped_at_paper_step"
    ):
        print("it is not undamped")
        return 77
    if FAULT == "declines":
        print("it knows no such bar")
        return 77
    if FAULT == "crashes":
        print("no convergence in step 12")
        return 5
    if FAULT == "pipes":
        for name in ("run.json", "motion.csv", "resistance.csv"):
            os.mkfifo(out / name)
        time.sleep(2)  # long enough for its progress to be looked at
        return 0
    native = [SOLVER, "run", given["--case"], "--packing", given["--packing"], "--output"]
    subprocess.run([*native, out / "native"], check=True)
    if FAULT == "writes nothing":
        return 0
    resistance = pd.read_csv(out / "native/resistance.csv", float_precision="round_trip")
    motion = frames(out / "native/motion.h5")
    said = {
        "completed": FAULT != "not completed",
        "frames": int(motion["time_s"].nunique()),
        "particles": int(motion["id"].nunique()),
        "engine": "another" if FAULT == "another engine" else "door",
        "version": "door 0.9" if FAULT == "another version" else "door 1.0",
    }
    if FAULT == "a frame less":
        motion = motion[motion["time_s"] < motion["time_s"].max()]
    if FAULT == "a particle less":
        motion = motion.drop(index=motion.index[-1])
    if FAULT == "ids from 1":
        motion["id"] += 1
    if FAULT == "a particle twice":
        motion.loc[motion.index[-1], "id"] = 0
    if FAULT == "text":
        resistance["force_y_N"] = resistance["force_y_N"].astype(object)
        resistance.loc[3, "force_y_N"] = "=cmd()"
    if FAULT == "not finite":
        motion.loc[motion.index[7], "x_m"] = np.inf
    if FAULT == "a column less":
        resistance = resistance.drop(columns="floor_force_y_N")
    if FAULT == "shifted times":
        resistance["time_s"] += 1e-3
    if FAULT == "lost particle":
        motion.loc[motion.index[-1], "x_m"] = -1.0
    if FAULT == "slow velocities":
        motion["velocity_y_m_s"] *= 0.9
    if FAULT == "other units":
        motion["x_m"] *= 1e3
        resistance["force_y_N"] *= 1e3
        resistance = resistance.rename(columns={"force_y_N": "fy"})
    if FAULT == "files of frames":
        for number, (_, frame) in enumerate(motion.groupby("time_s")):
            frame.sample(frac=1, random_state=1).to_csv(
                out / f"frame_{number}.csv", sep=" ", index=False
            )
    else:
        motion.to_csv(out / "motion.csv", index=False)
    resistance.to_csv(out / "resistance.csv", index=False)
    if FAULT != "no run.json":
        text = "{" if FAULT == "torn run.json" else json.dumps(said)
        (out / "run.json").write_text(text)
    return 0


def frames(path):
    with h5py.File(path) as file:
        soil = file["particles/soil"]
        time_s, place, speed = (
            soil[f"{name}"][()] for name in ("position/time", "position/value", "velocity/value")
        )
        spin, angle = (soil[f"{name}/value"][()] for name in ("angular_velocity", "angle"))
    frames, particles = spin.shape
    return pd.DataFrame(
        {
            "time_s": np.repeat(time_s, particles),
            "id": np.tile(np.arange(particles), frames),
            "x_m": place[..., 0].ravel(),
            "y_m": place[..., 1].ravel(),
            "velocity_x_m_s": speed[..., 0].ravel(),
            "velocity_y_m_s": speed[..., 1].ravel(),
            "angular_velocity_rad_s": spin.ravel(),
            "angle_rad": angle.ravel(),
        }
    )


if __name__ == "__main__":
    sys.exit(main())
