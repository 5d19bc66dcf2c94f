"""No text of a case becomes code of an engine, a path outside the run's folder or an element of a page.

What engines read beside the case and the packing consists of the project's own files and of numbers in a fixed grammar.
"""

import json
import os
import re
import runpy
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import hypothesis.strategies as some
import pytest
import synthetic
from command_line import ROOT
from hostile_texts import FRAGMENTS, positive, texts
from hypothesis import assume, given, settings
from small_case import small_case
from test_report import Page

from crossdem.adapters.case import CaseError, varied_table
from crossdem.adapters.engines import ENGINES, get_engine
from crossdem.adapters.liggghts_input import resisting_rolling
from crossdem.adapters.run_folder import prepare
from crossdem.compare import report
from crossdem.compare.comparison import compare_runs

NUMBER = r"-?\d+(?:\.\d+)?(?:e[+-]\d+)?"
GRAMMAR = {  # of each line
    "numbers.in": rf"variable [a-z_0-9]+ string (?:{NUMBER}|on|off)",
    "particles.data": rf"|discs of the packing|Atoms|Velocities|\d+ atoms|\d atom types|{NUMBER} {NUMBER} [xyz]lo [xyz]hi"
    rf"|{NUMBER}(?: {NUMBER}){{6}}",
    "bar.stl": rf"(?:end)?solid bar|outer loop|endloop|endfacet|(?:facet normal|vertex) {NUMBER} {NUMBER} {NUMBER}",
}
PROJECTS_OWN = {path.name: path for path in (ROOT / "adapters").iterdir() if path.is_file()}
IDENTIFIER = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]{0,63}")
LAMMPS = ROOT / "examples" / "lammps"


@some.composite
def cases(draw, rolling: bool):
    """A valid case whose every free text is hostile, with any numbers for the law; and itself with plain texts."""
    plain = small_case("time.allow_above_eq32=true").resolved
    contact = {
        kind: {key: draw(positive) for key in values}
        | ({"rolling_friction": draw(positive)} if rolling else {})
        for kind, values in plain["contact"].items()
    }
    check = {
        "quantity": "mean_resistance_N",
        "kind": "relative",
        "margin": 0.1,
        "seed_scatter": 0.1,
    }
    difference = {"engine": "yade", "quantity": "x", "value": 1.0, "tolerance": 1.0}
    twin = {"engine": "yade", "limit_m": 1.0}
    answer = {"quantity": "x", "kind": "relative", "tolerance": 1.0}

    def with_texts(text):
        return varied_table(
            small_case("time.allow_above_eq32=true"),
            title=text(),
            contact=contact,
            check=[check | {"reason": text()}],
            difference=[difference | {"reason": text()}],
            twin=[twin | {"reason": text()}],
            answer=[answer | {"reason": text()}],
        )

    return with_texts(lambda: draw(texts)), with_texts(lambda: "plain")


def files_below(folder):
    return {str(path.relative_to(folder)): path for path in folder.rglob("*") if path.is_file()}


def check_lines(path):
    for line in path.read_text(encoding="ascii").split("\n")[:-1]:
        assert re.fullmatch(GRAMMAR[path.name], line), (path.name, line)


@given(data=some.data())
@pytest.mark.parametrize("rolling", [False, True])
@pytest.mark.parametrize("name", list(ENGINES))
def test_what_an_engine_reads_is_ours_or_numbers(name, rolling, packing, data):
    hostile, plain = data.draw(cases(rolling))
    with TemporaryDirectory() as place:
        folder = Path(place)
        prepare(hostile, packing, get_engine(name), folder / "one" / "run")
        prepare(plain, packing, get_engine(name), folder / "other" / "run")
        found, of_plain = files_below(folder / "one"), files_below(folder / "other")
        assert found.keys() == of_plain.keys() and all(file.startswith("run/") for file in found)
        assert {path.name for path in folder.iterdir()} == {"one", "other"}
        for file, path in found.items():
            if path.name == "case.json":
                assert path.read_bytes() == hostile.canonical
                continue
            assert path.read_bytes() == of_plain[file].read_bytes(), "it depends on a text"
            if path.name in GRAMMAR:
                check_lines(path)
            elif path.name in PROJECTS_OWN:
                own = PROJECTS_OWN[path.name].read_text()
                allowed = {own, resisting_rolling(own)} if rolling else {own}
                assert path.read_text() in allowed
            elif path.parent.name == "inputs":
                assert path.read_bytes() == (packing.folder / path.name).read_bytes()
            else:
                assert path.name == "README.txt"


@given(data=some.data())
def test_every_number_reaches_the_deck_as_it_is(packing, data):
    hostile, _ = data.draw(cases(rolling=True))
    with TemporaryDirectory() as place:
        prepare(hostile, packing, get_engine("liggghts"), Path(place) / "run")
        lines = (Path(place) / "run" / "inputs" / "numbers.in").read_text().splitlines()
    said = {line.split()[1]: line.split()[3] for line in lines}
    for suffix, pair in (("particle", "particle_particle"), ("wall", "particle_wall")):
        contact = hostile.resolved["contact"][pair]
        assert float(said[f"kn_{suffix}"]) == contact["normal_stiffness_N_m"]
        assert float(said[f"gammat_{suffix}"]) == contact["shear_damping_N_s_m"]
        assert float(said[f"rolling_{suffix}"]) == contact["rolling_friction"]


@given(data=some.data())
def test_what_lammps_reads_is_ours_or_numbers(packing, data):
    hostile, _ = data.draw(cases(rolling=False))
    example = runpy.run_path(str(LAMMPS / "run_lammps.py"))
    assume(not example["what_is_lacking"](hostile.resolved))
    before = Path.cwd()
    with TemporaryDirectory() as place:
        (Path(place) / "inputs").mkdir()
        try:
            os.chdir(place)
            discs = example["read_packing"](packing.folder / "packing.csv")
            schedule = example["Schedule"](hostile.resolved["time"], 5e-5)
            example["write_numbers"](hostile.resolved, schedule, discs, packing.bar_tip_m)
            example["write_discs"](hostile.resolved, discs, packing.bar_tip_m)
        finally:
            os.chdir(before)
        found = files_below(Path(place))
        assert found.keys() == {"inputs/numbers.in", "inputs/particles.data"}
        for path in found.values():
            check_lines(path)


@given(name=texts | some.from_regex(r"[a-z_./-]{1,6}", fullmatch=True))
@pytest.mark.parametrize("key", ["name", "quantity", "engine"])
def test_what_may_name_a_file_is_an_identifier_or_refused(key, name, case):
    entry = {"engine": "yade", "quantity": "x", "value": 1.0, "tolerance": 1.0, "reason": "r"}
    tables = {"name": name} if key == "name" else {"difference": [entry | {key: name}]}
    if IDENTIFIER.fullmatch(name):
        varied_table(case, **tables)
    else:
        with pytest.raises(CaseError, match=f"{key}: must consist of"):
            varied_table(case, **tables)


def page_of(text):
    """Tags and names of attributes of the report of a comparison in which every text is one that `text` gives."""
    check = synthetic.MEAN_RESISTANCE | {"reason": text()}
    run_case = replace(synthetic.case([check], title=text()), changes=(text(),), file_name=text())
    runs = []
    for engine in ("native", "yade"):
        run = synthetic.dataset(run_case, engine, 1, noise=0.3, failed_gate=text())
        more = {key: text() for key in ("engine_version", "compiler", "started_utc")}
        more |= {"limitations": [text()], "command": [text()]}
        runs.append(replace(run, manifest=run.manifest | more))
    with TemporaryDirectory() as place:
        comparison = compare_runs(run_case, runs, {("liggghts", 1): text()})
        html = report.write_report(comparison, Path(place)).read_text(encoding="utf-8")
    page = Page(html)
    return page.tags, [name for name, _ in page.attributes]


@pytest.fixture(scope="module")
def plain_page():
    return page_of(lambda: "plain")


@settings(max_examples=max(2, settings().max_examples // 20))  # a page takes seconds
@given(data=some.data())
def test_no_text_becomes_an_element_or_attribute_of_the_report(plain_page, data):
    assert page_of(lambda: "".join(FRAGMENTS) + data.draw(texts)) == plain_page
