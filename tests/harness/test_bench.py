"""Speed: what is timed is what is said, ratios are taken round by round, and what did not run is never counted."""

import json
from dataclasses import replace
from types import SimpleNamespace

import pytest
from command_line import REFERENCE, ROOT, crossdem
from rich.console import Console
from small_case import small_file
from test_cli import _without_engines

from crossdem.adapters import packing
from crossdem.adapters.case import load_case
from crossdem.adapters.engine import EngineFailure
from crossdem.adapters.engines import DEFAULT_ENGINES, get_engine
from crossdem.adapters.solver import SolverError
from crossdem.adapters.workspace import Workspace
from crossdem.compare import (
    bench_beds,
    bench_command,
    bench_report,
    bench_runs,
    bench_scaling,
    bench_tables,
)
from crossdem.compare.bench import Bench, Contender, Spread, Timing
from crossdem.compare.bench_beds import Settling, bed, settling
from crossdem.compare.bench_clocks import CLOCKS, timed_command, told
from crossdem.compare.bench_scaling import sizes_up_to
from crossdem.compare.bench_workloads import Workload, bar, static, static_name, time_to_solution
from crossdem.compare.runs import cores
from crossdem.compare.wording import DASH


@pytest.fixture(scope="module")
def paper():
    return load_case(REFERENCE)


def timing(engine, number, wall_s, workload="bar", **others):
    about = dict(threads=1, step_s=5e-5, particles=1000, steps=2000)
    about |= dict(process_wall_s=5.0, process_cpu_s=4.9, peak_memory_bytes=None)
    return Timing(workload, engine, round=number, wall_s=wall_s, **about | others)


def bench(case, timings, failures=None, left_out=None):
    engines = dict.fromkeys(t.engine for t in timings)
    workloads = tuple(
        Workload(name, case, case) for name in dict.fromkeys(t.workload for t in timings)
    )
    return Bench(
        case,
        workloads,
        3,
        dict.fromkeys(engines, "1.0"),
        left_out or {},
        tuple(timings),
        failures or {},
    )


def test_ratios_are_those_of_a_round_and_not_of_medians(paper):
    """The machine is half as fast in the second round, and LIGGGHTS twice as slow as native in each."""
    native, liggghts = [1.0, 2.0, 1.1], [2.0, 4.0, 2.2]
    found = bench(
        paper,
        [timing("native", k, s) for k, s in enumerate(native)]
        + [timing("liggghts", k, s) for k, s in enumerate(liggghts[:2])],
    )
    first, second = found.rows()
    assert first.wall_s == Spread(median=1.1, low=pytest.approx(1.05), high=pytest.approx(1.55))
    assert first.ns_per_particle_step.median == pytest.approx(1.1e9 / 2e6)
    assert (first.ratio.median, second.ratio.low, second.ratio.median) == (1.0, 2.0, 2.0)
    assert second.wall_s.median / first.wall_s.median != pytest.approx(2.0, rel=0.1)


def test_ratios_are_to_the_native_solver_on_its_fewest_threads(paper):
    pairs = [
        (timing("native", k, s, threads=2), timing("native", k, 1.5 * s))
        for k, s in enumerate([1.0, 2.0])
    ]
    on_two, on_one = bench(paper, [t for pair in pairs for t in pair]).rows()
    assert (on_two.contender, on_one.contender) == ("native, 2 threads", "native")
    assert on_two.ratio.low == on_two.ratio.high == pytest.approx(1 / 1.5)
    assert on_one.ratio.median == 1.0


def test_without_the_native_solver_there_are_times_and_no_ratios(paper, tmp_path):
    found = bench(paper, [timing("yade", 0, 3.0)], left_out={"native": "not built"})
    [row] = bench_tables.rows(found)
    assert row[-1] == DASH and row[2] == "3.00"
    assert "native is left out: not built" in bench_tables.remarks(found)
    bench_report.write_bench(found, tmp_path, None, bench_tables.machine())
    assert {path.name for path in tmp_path.iterdir()} == {"bench.json", "bench.png"}


def test_a_run_that_had_to_wait_for_a_core_is_told(paper):
    busy = bench(paper, [timing("native", 0, 1.0), timing("native", 1, 1.0, process_cpu_s=3.0)])
    assert any(remark.startswith("1 of 2 runs") for remark in bench_tables.remarks(busy))
    assert not bench_tables.remarks(bench(paper, [timing("native", 0, 1.0)]))


def test_each_engine_makes_the_same_steps_at_the_same_time_step(paper):
    workload = bar(paper, quick=False)
    schedules = [get_engine(name).schedule(workload.case) for name in DEFAULT_ENGINES]
    assert {(s.step_s, s.rest, s.penetration) for s in schedules} == {(5e-5, 24_000, 90_000)}
    assert schedules[0].samples == schedules[0].frames == 2
    assert workload.bed is paper
    assert get_engine("native").schedule(bar(paper, quick=True).case).steps == 240 + 900


def test_the_time_to_solution_is_that_of_the_whole_case_at_each_ones_own_step(paper):
    case = time_to_solution(paper, quick=True).case
    assert [get_engine(name).schedule(case).steps for name in DEFAULT_ENGINES] == [
        *(102_000, 204_000, 204_000)
    ]


def test_a_larger_bed_is_wider_and_no_deeper(paper):
    workload = static(9440)(paper, False)
    container, particles = workload.bed.resolved["container"], workload.bed.resolved["particles"]
    assert container["width_m"] == pytest.approx(1.5) and container["height_m"] == 0.15
    assert particles["count"] == 9440 and "bar" not in workload.case.resolved
    assert workload.case.resolved["time"]["rest_s"] == 0
    # whatever the number of steps, it is the same bed
    assert static(9440)(paper, True).bed.hash == workload.bed.hash
    assert static(9440)(paper, True).case.hash != workload.case.hash
    assert [static_name(n) for n in (1, 1500, 10_000, 4_000_000)] == [
        *("static-1", "static-1500", "static-10k", "static-4M")
    ]


def test_threads_are_told_to_the_native_solver(paper, tmp_path, monkeypatch):
    """Those of a run, and all cores for settling its bed."""
    native = get_engine("native")
    assert timed_command(native, paper, tmp_path, 2)[-2:] == ["--threads", "2"]
    assert "--threads" not in timed_command(native, paper, tmp_path)
    asked = []

    def call(arguments, **_):
        asked.extend(arguments)
        raise SolverError("enough")

    monkeypatch.setattr(packing, "call_solver", call)
    with pytest.raises(SolverError, match="enough"):
        bed(paper, Workspace(tmp_path), SimpleNamespace(say=lambda text: None))
    assert f"--threads={cores()}" in asked


def test_runs_that_waited_for_a_core_are_counted(paper):
    """On two threads a large bed keeps two cores busy, a small one has work for one of them only."""
    cpu_s = {("small", 2): (4.9, 4.9), ("large", 1): (4.9, 2.5), ("large", 2): (9.8, 4.9)}
    timings = [
        timing("native", k, 1.0, bed, threads=threads, process_cpu_s=found_s)
        for (bed, threads), of_rounds in cpu_s.items()
        for k, found_s in enumerate(of_rounds)
    ]
    [said] = bench_tables.remarks(bench(paper, timings))
    assert said.startswith("2 of 6 runs had less than 90 % of a core")


def test_a_bed_that_another_build_of_the_solver_made_tells_no_time(paper, tmp_path, monkeypatch):
    case, workspace = static(30)(paper, False).bed, Workspace(tmp_path / "out")
    bed(case, workspace, SimpleNamespace(say=lambda text: None))
    made = settling(case, workspace)
    assert made.wall_s > 0 and made.threads == cores()
    monkeypatch.setattr(bench_beds, "solver_sha256", lambda: "that of another")
    assert settling(case, workspace) is None
    bed(case, workspace, SimpleNamespace(say=lambda text: None))  # is kept nevertheless
    assert settling(case, workspace) is None
    monkeypatch.undo()
    assert settling(case, workspace) == made


LOOP = "Loop time of {} on 1 procs for {} steps with 944 atoms, finish time Sun Nov 22 10:10:37\n"


def test_the_time_of_liggghts_and_lammps_is_that_of_their_steps(paper):
    engine, case = get_engine("liggghts"), bar(paper, quick=True).case
    log = LOOP.format("1.2e-05", 0) + "Pair time\n\n" + LOOP.format("12.1", 1140)
    assert told(engine, case, log).wall_s == 12.1
    two = LOOP.format("2.5", 140) + LOOP.format("10.0", 1000)
    assert told(engine, case, two).wall_s == 12.5
    with pytest.raises(EngineFailure, match="made 0 steps instead of 1140"):
        told(engine, case, LOOP.format("1.2e-05", 0))


@pytest.mark.parametrize("name", DEFAULT_ENGINES)
@pytest.mark.parametrize("log", ["", "no word of time\n", "[1]\n", '{"steps": 1140}\n'])
def test_an_engine_that_says_no_time_has_failed(name, log, paper):
    with pytest.raises(EngineFailure, match="how long"):
        told(get_engine(name), bar(paper, quick=True).case, log)


def test_engines_take_turns_and_one_that_fails_is_not_counted(paper, tmp_path, monkeypatch):
    ran = []

    def fake(number, workload, contender, packing, run_dir, tell):
        ran.append((number, workload.name, str(contender)))
        if ran[-1] == (1, "two", "yade"):
            raise EngineFailure("was ended by signal 9 (SIGKILL)")
        return timing(contender.engine, number, 1.0, workload.name, threads=contender.threads)

    monkeypatch.setattr(bench_runs, "time_run", fake)
    monkeypatch.setattr(bench_runs, "bed", lambda *_: None)
    monkeypatch.setattr(bench_runs, "_present", lambda engines: (dict.fromkeys(engines, "1"), {}))
    workloads = [Workload(name, paper, paper) for name in ("one", "two")]
    found = bench_runs.run_bench(
        paper,
        workloads,
        [Contender("native"), Contender("native", 2), Contender("yade")],
        3,
        SimpleNamespace(root=tmp_path),
        Console(quiet=True),
    )
    contenders = ("native", "native, 2 threads", "yade")
    each = [(workload, name) for workload in ("one", "two") for name in contenders]
    assert ran == [(k, *run) for k in range(3) for run in each][:-1]
    failed = ("two", Contender("yade"))
    assert found.failures == {failed: "yade was ended by signal 9 (SIGKILL)"}
    assert not found.of(failed) and len(found.of(("two", Contender("native", 2)))) == 3
    assert [(row.workload, row.contender) for row in found.rows()] == each[:-1]


def test_memory_per_particle_is_above_that_of_the_program(paper):
    timings = [
        timing("native", 0, 1.0, f"static-{n}", particles=n, peak_memory_bytes=10_000_000 + 500 * n)
        for n in (1, 1000, 10_000)
    ]
    made = Settling(1.5, 2, 62.5, "")
    settled = {"static-1": None, "static-1000": made, "static-10000": None}
    found = bench_scaling.sizes(bench(paper, timings), settled)
    assert [(size.particles, size.settling) for size in found] == [(1000, made), (10_000, None)]
    assert [size.bytes_per_particle for size in found] == [
        pytest.approx(499.5),
        pytest.approx(500, rel=1e-3),
    ]
    assert bench_scaling.sizes(bench(paper, timings[1:]), settled) == []


def test_the_speed_up_is_that_within_a_round_over_the_fewest_threads(paper):
    """The machine is half as fast in the second round. Memory is that on one thread."""
    timings = [
        timing("native", k, s / threads, f"static-{n}", particles=n, threads=threads)
        for k, s in enumerate([1.0, 2.0])
        for n in (1, 1000)
        for threads in (1, 2)
    ]
    timings = [replace(t, peak_memory_bytes=t.threads * t.particles * 100) for t in timings]
    [size] = bench_scaling.sizes(bench(paper, timings), {"static-1000": None})
    assert [(s.threads, s.speed_up.low, s.speed_up.high) for s in size.speeds] == [
        *((1, 1.0, 1.0), (2, 2.0, 2.0))
    ]
    assert size.speeds[0].ns_per_particle_step.high == pytest.approx(1.75e9 / 2e6)
    assert size.bytes_per_particle == pytest.approx(99.9)
    on_two_threads_it_failed = [t for t in timings if (t.particles, t.threads) != (1000, 2)]
    assert bench_scaling.sizes(bench(paper, on_two_threads_it_failed), {}) == []


def test_every_bed_is_stepped_often_enough_to_count(paper):
    sizes = (1, 1000, 100_000, 1_000_000, 4_000_000)
    workloads = [static(n, bench_scaling.PARTICLE_STEPS)(paper, False) for n in sizes]
    steps = [get_engine("native").schedule(workload.case).steps for workload in workloads]
    assert steps == [300_000, 300_000, 3000, 300, 300]


def test_the_sizes_are_powers_of_ten_and_the_largest():
    assert sizes_up_to(1000) == [1000]
    assert sizes_up_to(100_000) == [1000, 10_000, 100_000]
    assert sizes_up_to(4_000_000) == [1000, 10_000, 100_000, 1_000_000, 4_000_000]


def test_a_quick_run_of_the_native_solver_alone(tmp_path):
    options = ["--quick", "--engines", "native", "--workloads", "bar,time-to-solution"]
    command = [
        "bench",
        *options,
        "--case",
        small_file(tmp_path),
        "--json",
        tmp_path / "numbers.json",
    ]
    ended = crossdem(*command, cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert "settling" in ended.stdout and "timing: done" in ended.stdout
    assert "time-to-solution: 40 particles, 2,000 steps of 100 µs" in ended.stdout
    out = tmp_path / "results" / "bench"
    assert {path.name for path in out.iterdir()} == {
        *("packings", "bench.json", "bench.png", "crossdem.json")
    }
    found = json.loads((out / "bench.json").read_text())
    assert found == json.loads((tmp_path / "numbers.json").read_text())
    assert [(t["round"], t["workload"]) for t in found["timings"]] == [
        *((0, "bar"), (0, "time-to-solution"), (1, "bar"), (1, "time-to-solution"))
    ]
    assert all(0 < t["wall_s"] < t["process_wall_s"] for t in found["timings"])
    assert {t["steps"] for t in found["timings"]} == {20 + 20, 2000}
    assert {(t["threads"], t["step_s"]) for t in found["timings"]} == {(1, 5e-5), (1, 1e-4)}
    assert found["machine"]["cores"] >= 1 and "-O" in found["engines"]["native"]
    again = crossdem(*command, cwd=tmp_path)
    assert again.returncode == 0 and "settling" not in again.stdout


def test_a_quick_run_over_the_number_of_particles(tmp_path):
    command = ["bench", "scaling", "--quick", "--largest", "1000", "--case", small_file(tmp_path)]
    ended = crossdem(*command, "--threads", "2,1", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert "speed-up" in ended.stdout
    found = json.loads((tmp_path / "results" / "bench" / "scaling.json").read_text())
    [size] = found["sizes"]
    assert size["steps"] == 3000
    assert size["particles"] == 1000 and 50 < size["bytes_per_particle"] < 5000
    assert 0 < size["settling"]["wall_s"] < 60 and size["settling"]["threads"] == cores()
    assert size["settling"]["ns_per_particle_step"] > 1
    assert "particles in" in ended.stdout
    assert [speed["threads"] for speed in size["speeds"]] == [1, 2]
    assert all(speed["ns_per_particle_step"]["median"] > 1 for speed in size["speeds"])
    assert {(t["engine"], t["threads"]) for t in found["timings"]} == {("native", 1), ("native", 2)}
    assert (tmp_path / "results" / "bench" / "scaling.png").exists()


def test_a_missing_engine_is_named_and_left_out(tmp_path):
    options = ["--quick", "--engines", "native,liggghts", "--workloads", "bar"]
    ended = crossdem(
        "bench",
        *options,
        "--case",
        small_file(tmp_path),
        cwd=tmp_path,
        PATH=_without_engines(tmp_path),
    )
    assert ended.returncode == 3, ended.stderr
    assert "liggghts is left out: liggghts is not installed" in ended.stdout
    found = json.loads((tmp_path / "results" / "bench" / "bench.json").read_text())
    assert {row["engine"] for row in found["rows"]} == {"native"}
    assert list(found["left_out"]) == ["liggghts"]


def test_lammps_is_timed_where_it_is_and_asked_of_nobody(tmp_path, monkeypatch):
    """Missing of itself it is said in one line; missing though asked for it is a failure, like any engine."""

    def ended(engines):
        found = bench(load_case(REFERENCE), [timing("native", 0, 1.0)], left_out={"lammps": "no"})
        monkeypatch.setattr(bench_command, "run_bench", lambda *_: found)
        case = found.case
        workspace = SimpleNamespace(root=tmp_path)
        return bench_command.bench_engines(case, ["bar"], engines, [1], 1, True, workspace, None)

    assert (ended(None), ended(["native", "lammps"])) == (0, 3)


def test_an_engine_that_tells_no_time_is_named_and_not_counted(fake, tmp_path):
    """The fake LIGGGHTS ends well, and says nothing of its loop time."""
    options = ["--quick", "--engines", "native,liggghts", "--workloads", "bar"]
    ended = crossdem("bench", *options, "--case", small_file(tmp_path), cwd=tmp_path)
    assert ended.returncode == 3, ended.stderr
    assert "bar: liggghts did not say how long its steps took" in ended.stdout
    assert len(fake.process_ids()) == 1
    fake.fault("crash while resting")
    ended = crossdem("bench", *options, "--case", small_file(tmp_path), cwd=tmp_path)
    assert ended.returncode == 3 and "bar: liggghts was ended by signal 6" in ended.stdout
    assert not list((tmp_path / "results" / "bench").glob(f"{bench_runs.RUN}*"))


@pytest.mark.parametrize(
    "options, said",
    [
        (["--engines", "gromacs"], "no engine that can be timed 'gromacs'"),
        (["--engines", "yade-averaged"], "there are native, liggghts, yade, lammps"),
        (["--threads", "two"], "'two' is not a list of numbers such as 1,2"),
        (["--threads", "0,1"], "a run has from 1 to 1024 threads"),
        (["scaling", "--threads", "1025"], "a run has from 1 to 1024 threads"),
        (["--workloads", "static-7"], "no workload 'static-7'"),
        (["--repeats", "0"], "0 is not in the range"),
        (["--json", "."], "is a folder"),
        (["--json", "nowhere/x.json"], "is a folder, or lies in one that is not there"),
        (["--case", "nowhere.toml"], "nowhere.toml"),
        (["--case", ROOT / "reference_cases/micro/head_on_pair.toml"], "placed by hand"),
        (["--quick", "scaling"], "options of scaling stand behind its name"),
        (["scaling", "--largest", "10"], "10 is not in the range"),
        (["faster"], "No such command"),
    ],
)
def test_bad_input_is_said_before_anything_is_written(options, said, tmp_path):
    ended = crossdem("bench", *options, cwd=tmp_path)
    assert ended.returncode == 2 and "Traceback" not in ended.stderr
    assert said in ended.stderr.replace("\n", " ")
    assert not list(tmp_path.iterdir())
