"""Each fault seeded in the judge must fail the judge's own tests. Faults go into a copy; the product holds none."""

import contextlib
import multiprocessing
import os
import shutil
import sys
from pathlib import Path

import pytest
from mutants import MUTANTS

ROOT = Path(__file__).resolve().parents[2]
COPIED = (
    "crossdem.py",
    "adapters",
    "compare",
    "reference_cases/bar_penetration.toml",
    "tests/harness",
)
# Loaded once, in the process that all others are forks of: they take longer than the tests.
SLOW_TO_LOAD = [
    "pytest",
    "pandas",
    "scipy.stats",
    "statsmodels.stats.weightstats",
    "statsmodels.stats.multitest",
]


@pytest.fixture(scope="module")
def processes():
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(SLOW_TO_LOAD)
    return context


@pytest.fixture
def judge(tmp_path):
    """A copy of the judge and its tests."""
    for name in COPIED:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / name).is_dir():
            shutil.copytree(
                ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__")
            )
        else:
            shutil.copy(ROOT / name, tmp_path / name)
    return tmp_path


def run(root, log, arguments):
    """In a process of its own: these tests, on the judge in `root`; ends with pytest's exit code."""
    os.chdir(root)
    sys.path.insert(0, str(root))
    sys.dont_write_bytecode = True
    import crossdem

    assert crossdem.__path__ == [str(root)]
    with log.open("w") as file, contextlib.redirect_stdout(file):
        code = pytest.main(["-q", "-x", "-p", "no:cacheprovider", f"--rootdir={root}", *arguments])
    os._exit(code)


def judged(processes, root, tests, only):
    """pytest's exit code, and what it said."""
    log = root / "log"
    log.touch()
    process = processes.Process(
        target=run, args=(root, log, [f"tests/harness/{tests}", "-k", only])
    )
    process.start()
    process.join()
    return process.exitcode, log.read_text()


@pytest.mark.parametrize("tests, only", sorted({(one.tests, one.only) for one in MUTANTS}))
def test_the_sound_judge_passes(processes, judge, tests, only):
    code, said = judged(processes, judge, tests, only)
    assert code == pytest.ExitCode.OK, said


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.name)
def test_a_fault_in_the_judge_is_noticed(processes, judge, mutant):
    source = judge / mutant.file
    text = source.read_text(encoding="utf-8")
    assert text.count(mutant.right) == 1, f"{mutant.file}: not once there: {mutant.right!r}"
    source.write_text(text.replace(mutant.right, mutant.wrong), encoding="utf-8")
    code, said = judged(processes, judge, mutant.tests, mutant.only)
    assert code == pytest.ExitCode.TESTS_FAILED, said
