"""The comparison particle by particle in the real engines: what check says of it, and that a real difference is found."""

import json
from xml.etree import ElementTree

import pytest
from command_line import REFERENCE, crossdem
from small_case import SMALL

from crossdem import ExitCode
from crossdem.adapters.case import varied
from crossdem.compare import cli, twin_schemes
from crossdem.compare.twin_schemes import TWIN_SCHEMES

# What a heap of 40 discs says alike in both codes: the tests are of motion, not of what one chaotic packing happens to do.
ONE_CHECK = """check=[{quantity="contacts_per_particle", kind="relative", margin=0.2, seed_scatter=0.05, reason="one"}]"""
OVERRIDES = [word for text in (*SMALL, ONE_CHECK) for word in ("--set", text)]
WITH_SCHEME = sorted(TWIN_SCHEMES)


@pytest.mark.parametrize("engine_name", WITH_SCHEME)
def test_an_engine_does_what_the_native_scheme_of_its_name_does(engine_name, tmp_path, required):
    required(engine_name)
    out = tmp_path / "out"
    engines = ["--engines", f"native,{engine_name}", "--seeds", "1"]
    ended = crossdem("check", REFERENCE, *OVERRIDES, *engines, "--out", out)
    assert ended.returncode == ExitCode.AGREES, ended.stdout + ended.stderr
    _, found = json.loads((out / "report.json").read_text())["horizon"]["engines"]
    assert found["engine"] == engine_name and found["compared_until_s"] == pytest.approx(0.1)
    assert found["compared_frames"] >= 5
    assert found["largest_difference_m"] < 1e-12
    assert found["beyond_limit_s"] is None


@pytest.mark.parametrize("engine_name", WITH_SCHEME)
def test_a_fault_in_the_law_makes_check_differ_and_names_engine_and_time(
    engine_name, tmp_path, required, monkeypatch, capsys
):
    """The native scheme of another friction stands for an engine whose friction is wrong."""
    required(engine_name)
    right = twin_schemes.native_twin

    def wrong(start, engine):
        return right(varied(start, ["contact.particle_particle.friction=0.7"]), engine)

    monkeypatch.setattr(twin_schemes, "native_twin", wrong)
    out = tmp_path / "out"
    options = ["--engines", f"native,{engine_name}", "--seeds", "1", "--out", str(out)]
    assert cli.main(["check", str(REFERENCE), *OVERRIDES, *options]) == ExitCode.DIFFERS
    said = " ".join(capsys.readouterr().out.split())
    assert "DIFFERS" in said and f"{engine_name} leaves the native scheme" in said
    verdict = json.loads((out / "report.json").read_text())["verdict"]
    assert verdict["word"] == "DIFFERS" and "before the horizon" in verdict["sentence"]
    suites = {s.get("name"): s for s in ElementTree.parse(out / "junit.xml").getroot()}
    [test] = suites["particle by particle"].findall("testcase")
    assert test.get("classname").endswith(engine_name) and test.find("failure") is not None


def test_a_reading_that_an_engine_does_not_follow_costs_no_report(tmp_path, required):
    required("yade")
    options = ["--set", "scheme.normal_spring=overlap", "--engines", "native,yade", "--seeds", "1"]
    ended = crossdem("check", REFERENCE, *OVERRIDES, *options, "--out", tmp_path / "out")
    assert ended.returncode in (ExitCode.AGREES, ExitCode.INCONCLUSIVE), ended.stderr
    _, found = json.loads((tmp_path / "out" / "report.json").read_text())["horizon"]["engines"]
    assert (found["engine"], found["outcome"]) == ("yade", "agrees")


def test_the_bed_of_the_paper_has_its_horizon_within_a_second(tmp_path):
    """Twins of the native solver alone, on all 944 discs; the case's own checks are not asked."""
    options = ["--engines", "native", "--out", tmp_path / "out"]
    ended = crossdem("horizon", REFERENCE, *options)
    assert ended.returncode == ExitCode.AGREES, ended.stdout + ended.stderr
    record = json.loads((tmp_path / "out" / "horizon" / "horizon.json").read_text())
    [native] = record["engines"]
    assert 0.3 < native["horizon_s"] < 0.9
    assert 0 < native["noticed_s"] < native["horizon_s"]
    assert len(record["runs"]) == 2
