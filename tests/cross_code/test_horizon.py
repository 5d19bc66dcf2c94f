"""The comparison particle by particle in the real engines: what check says of it, and that a real difference is found."""

import json

import pytest
from command_line import REFERENCE, crossdem
from small_case import SMALL

from crossdem import ExitCode
from crossdem.compare import horizon_runs

ONE_CHECK = """check=[{quantity="mean_resistance_N", kind="relative", margin=0.1, seed_scatter=0.06, reason="one"}]"""
OVERRIDES = [word for text in (*SMALL, ONE_CHECK) for word in ("--set", text)]
WITH_SCHEME = sorted(horizon_runs.SCHEMES)


@pytest.mark.parametrize("engine_name", WITH_SCHEME)
def test_an_engine_does_what_the_native_scheme_of_its_name_does(engine_name, tmp_path, required):
    required(engine_name)
    out = tmp_path / "out"
    engines = ["--engines", f"native,{engine_name}", "--seeds", "1"]
    ended = crossdem("check", REFERENCE, *OVERRIDES, *engines, "--out", out)
    assert ended.returncode == ExitCode.AGREES, ended.stdout + ended.stderr
    _, found = json.loads((out / "report.json").read_text())["horizon"]["engines"]
    assert found["engine"] == engine_name and found["compared_until_s"] == pytest.approx(0.1)
    assert found["largest_difference_m"] < 1e-12
    assert found["beyond_limit_s"] is None


@pytest.mark.parametrize("engine_name", WITH_SCHEME)
def test_a_fault_in_the_law_makes_check_differ_and_names_engine_and_time(
    engine_name, tmp_path, required, monkeypatch, capsys
):
    """The native scheme of another friction stands for an engine whose friction is wrong."""
    from crossdem.adapters.case import varied
    from crossdem.compare import cli

    required(engine_name)
    right = horizon_runs.native_scheme

    def wrong(start, engine):
        return right(varied(start, ["contact.particle_particle.friction=0.7"]), engine)

    monkeypatch.setattr(horizon_runs, "native_scheme", wrong)
    options = ["--engines", engine_name, "--out", str(tmp_path / "out")]
    ended = cli.main(["horizon", str(REFERENCE), *OVERRIDES, *options])
    assert ended == ExitCode.DIFFERS
    said = " ".join(capsys.readouterr().out.split())
    assert f"{engine_name} leaves the native scheme" in said and "before the horizon" in said
