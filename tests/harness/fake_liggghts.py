#!/usr/bin/python3
"""Stands in for LIGGGHTS: discs that never move, in the real output files, spoilt in the way that FAKE_FAULT names."""

import os
import sys
import time
from pathlib import Path

EVERY_STEP = """\
    Step    Atoms            CPU       floor_fo       touching       energy_s          tip_y        shaft_y 
       1        2     2.9831e-05      -2.124581              2  1.7168364e-05              0              0 
Loop time of 3.2054e-05 on 1 procs for 1 steps with 2 atoms, finish time Sun Jan  1 10:10:37 2000

Setting atom values ...
  2 settings made for vx
  2 settings made for omegaz"""
FAULT = os.environ.get("FAKE_FAULT", "none")


def main():
    if sys.argv[-1] == "-h":
        print("LIGGGHTS (Version LIGGGHTS-PUBLIC 3.8.0-fake, compiled by nobody)")
        return
    if "FAKE_STARTS" in os.environ:
        with open(os.environ["FAKE_STARTS"], "a", encoding="ascii") as starts:
            starts.write(f"{os.getpid()}\n")
    numbers = dict(
        line.split()[1::2] for line in Path("inputs/numbers.in").read_text().splitlines()
    )
    if numbers["averaged"] == "1":
        print(EVERY_STEP, "LIGGGHTS says this once", EVERY_STEP, sep="\n", flush=True)
    first, start = int(numbers["first_step"]), int(numbers["start_step"])
    sample, frame = int(numbers["sample_steps"]), int(numbers["frame_steps"])
    end = first + int(numbers["steps"])

    is_crash = FAULT == "crash" or FAULT == "crash once" and is_first_start()
    with open("output/samples.txt", "w", encoding="ascii") as samples:
        samples.write("# title\n")
        for step in [first, *range(first // sample * sample + sample, end + 1, sample)]:
            if is_crash and step > start:
                print("ERROR: Lost atoms: original 40 current 39 (thermo.cpp:389)", flush=True)
                sys.exit(int(os.environ.get("FAKE_STATUS", "1")))
            if FAULT == "crash while resting":
                os.abort()
            if FAULT == "hang" and step > start:
                samples.flush()
                time.sleep(3600)
            force = "nan" if FAULT == "nan force" and step == end else "0.25"
            if not (FAULT == "missing samples" and step == end):
                samples.write(f"{step} 0.0 {force} 0.2 0.05 -2.2 70 1e-10\n")
            samples.flush()
            if FAULT == "slow":
                time.sleep(0.02)

    discs = discs_of("inputs/particles.data")
    with open("output/frames.txt", "w", encoding="ascii") as frames:
        for step in range(start, end + 1, frame):
            last = step + frame > end
            if FAULT == "missing frames" and last:
                break
            if FAULT == "lost particle" and last:
                discs.pop()
            if FAULT == "outside" and last:
                discs[0] = (discs[0][0], "-0.001", discs[0][2])
            if FAULT == "nan position" and last:
                discs[0] = (discs[0][0], "nan", discs[0][2])
            frames.write("".join(frame_lines(step, discs)))
        if FAULT == "torn frame":
            frames.truncate(frames.tell() - 40)


def is_first_start():
    return len(Path(os.environ["FAKE_STARTS"]).read_text().split()) == 1


def discs_of(path):
    lines = Path(path).read_text().splitlines()
    rows = [
        line.split() for line in lines[lines.index("Atoms") + 2 : lines.index("Velocities") - 1]
    ]
    return [(row[0], row[4], row[5]) for row in rows]


def frame_lines(step, discs):
    yield f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{len(discs)}\nITEM: BOX BOUNDS ff ff pp\n0 1\n0 1\n0 1\n"
    yield "ITEM: ATOMS id x y vx vy omegaz\n"
    yield from (f"{name} {x} {y} 0 0 0\n" for name, x, y in discs)


main()
