"""One run of one engine, timed."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from crossdem.adapters.engine import EngineFailure
from crossdem.adapters.one_run import LOG, Limits
from crossdem.adapters.packing import Packing
from crossdem.adapters.process import Process
from crossdem.adapters.run_folder import environment, prepare

from .bench import Contender, Timing
from .bench_clocks import CLOCKS, timed_command, told
from .bench_workloads import Workload

POLL_S = 0.05
TELL_S = 0.5


def time_run(
    number: int,
    workload: Workload,
    contender: Contender,
    packing: Packing,
    run_dir: Path,
    tell: Callable[[float], None],
) -> Timing:
    """One run in the new folder `run_dir`. Raises EngineFailure, EngineNotFound."""
    case, engine = workload.case, CLOCKS[contender.engine].code
    if reasons := engine.unsupported(case):
        raise EngineFailure(f"cannot run this case: {'; '.join(reasons)}")
    prepare(case, packing, engine, run_dir)
    command = timed_command(engine, case, run_dir, contender.threads)
    allowed_s = Limits().allowed_s(engine.expected_s(case))
    process = Process(command, run_dir, environment(engine), run_dir / LOG)
    told_s = 0.0
    try:
        while (ending := process.poll()) is None:
            if process.wall_s > allowed_s:
                raise EngineFailure(f"ran past its time limit of {allowed_s:.3g} s and was ended")
            if process.wall_s - told_s >= TELL_S:
                told_s = process.wall_s
                tell(told_s)
            time.sleep(POLL_S)
    finally:
        process.kill()
    log = (run_dir / LOG).read_text(encoding="utf-8", errors="replace")
    if ending.status != 0:
        complaint = engine.complaint(log)
        raise EngineFailure(f"{ending}" + (f": {complaint}" if complaint else ""))
    said = told(engine, case, log)
    return Timing(
        workload=workload.name,
        engine=contender.engine,
        threads=contender.threads,
        round=number,
        step_s=engine.schedule(case).step_s,
        particles=len(packing.particles),
        steps=said.steps,
        wall_s=said.wall_s,
        process_wall_s=ending.wall_s,
        process_cpu_s=ending.cpu_s,
        peak_memory_bytes=said.peak_memory_bytes,
    )
