"""What it costs to compare 32 packings in three engines: to read the runs, to judge them and to write the report."""

import os
import subprocess
import sys
from pathlib import Path

from crossdem.adapters.case import load_case

sys.path.insert(0, str(Path(__file__).parents[1] / "harness"))  # command_line.py, synthetic.py
import synthetic  # noqa: E402
from command_line import REFERENCE, ROOT  # noqa: E402

ENGINES = ("native", "liggghts", "yade")
SEEDS = 32
MOST_CPU_S = 20.0  # of the processor, so that neighbours on the machine do not count
MOST_BYTES = 0.7e9


def runs(folder):
    """Whole runs of the paper's case, of which only the mechanics is made up."""
    run_case = load_case(REFERENCE)
    for seed in range(1, SEEDS + 1):
        inputs = folder / f"of_seed{seed}" / "inputs"
        inputs.mkdir(parents=True)
        (inputs / "case.json").write_bytes(run_case.canonical)
        (inputs / "packing.csv").write_bytes(b"packing %d" % seed)
        for engine in ENGINES:
            run = synthetic.dataset(run_case, engine, seed, noise=0.3)
            run.write(folder / f"{engine}{seed}", extra_files_from=inputs.parent)
            yield folder / f"{engine}{seed}"


def test_the_comparison_of_a_large_ensemble_is_quick_and_fits_into_a_laptop(tmp_path):
    folders = list(runs(tmp_path / "runs"))
    command = [ROOT / "crossdem", "compare", *folders, "--out", tmp_path / "out"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    said = process.stdout.read()
    _, _, used = os.wait4(process.pid, 0)
    assert "Report:" in said, said
    cpu_s, most_bytes = used.ru_utime + used.ru_stime, 1024 * used.ru_maxrss
    print(f"{len(folders)} runs: {cpu_s:.1f} s of the processor, {most_bytes / 1e6:.0f} MB")
    assert cpu_s < MOST_CPU_S and most_bytes < MOST_BYTES
