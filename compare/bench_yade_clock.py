"""Runs inputs/yade_case.py, as it is, with a clock around YADE's steps; then prints how long they took, as JSON.

Start it like that script, from the run's folder:  /usr/bin/python3 inputs/bench_yade_clock.py ENGINE
A module of its own process, in which YADE is imported: no part of crossdem is there.
"""

import json
import runpy
import sys
import time
from glob import glob

sys.path[1:1] = glob("/usr/lib/*/yade-double/py")

import yade  # noqa: E402
from yade.wrapper import Omega  # noqa: E402


class ClockedOmega(Omega):
    """The one simulation that YADE has, as it is; but it knows how often and how long it stepped."""

    steps = -1  # the first one only takes the forces of the packing: nothing moves
    wall_s = 0.0

    def step(self):
        started = time.perf_counter()
        super().step()
        if self.steps >= 0:
            self.wall_s += time.perf_counter() - started
        self.steps += 1


clocked = yade.O = ClockedOmega()  # which the script then imports
runpy.run_path("inputs/yade_case.py", run_name="__main__")
print(json.dumps({"steps": clocked.steps, "wall_s": clocked.wall_s}), flush=True)
