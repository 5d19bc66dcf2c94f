"""Variants of a case on shared packings: what changes, what is run once, and where it lies."""

import pytest
from command_line import ROOT
from rich.console import Console
from small_case import small_case

from crossdem.adapters.case import CaseError, load_case, varied
from crossdem.adapters.packing import make_packing
from crossdem.adapters.run import RunRequest
from crossdem.adapters.workflow.ensemble import run_ensemble
from crossdem.adapters.solver import BEYOND_REASON
from crossdem.adapters.workspace import Workspace
from crossdem.compare.progress import ProgressDisplay
from crossdem.compare.runs import settle
from crossdem.compare.variants import Variant, run_variants


PLACED = ROOT / "reference_cases" / "micro" / "head_on_pair.toml"


def test_a_variant_of_nothing_is_the_case_itself():
    case = small_case()
    assert varied(case, []) == case


def test_a_variant_changes_what_it_says_and_keeps_what_that_would_have_filled_in():
    case = small_case()
    other = varied(case, ["time.step_s=5e-5", "scheme.attraction=clipped"])
    assert case.resolved["time"]["step_s"] == 1e-4  # the case itself is as before
    assert other.resolved["time"] == case.resolved["time"] | {"step_s": 5e-5}
    assert other.resolved["engines"] == case.resolved["engines"]
    assert other.resolved["packing"] == case.resolved["packing"]
    assert other.hash != case.hash


def test_every_fault_of_a_variant_is_told():
    with pytest.raises(CaseError) as refused:
        varied(small_case(), ["time.step_s=7e-5", "bar.width_m=-1"])
    said = str(refused.value)
    assert "bar.width_m" in said
    with pytest.raises(CaseError, match="is not a key path"):
        varied(small_case(), ["time..step_s=1"])


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """A workspace with two variants, one of them under two names, and the runs."""
    case = small_case("time.rest_s=0.02", "time.penetration_s=0.02")
    workspace = Workspace(tmp_path_factory.mktemp("variants") / "out")
    packing = make_packing(case, 1, workspace.packing_folder(case, 1))
    clipped = varied(case, ["scheme.attraction=clipped"])
    blown = varied(case, ["time.step_s=2e-3", "time.allow_above_eq32=true"] + ENGINES_TOO)
    variants = [
        Variant("as it is", case),
        Variant("clipped", clipped),
        Variant("the same again", clipped),
        Variant("blown up", blown),
    ]
    with ProgressDisplay(Console(quiet=True)) as display:
        runs = run_variants(
            case, [(variant, packing) for variant in variants], workspace, 2, display
        )
    return workspace, runs


ENGINES_TOO = [f"engines.{name}.step_s=2e-3" for name in ("liggghts", "yade")]


def test_runs_come_in_the_order_asked_for_and_equal_variants_are_run_once(ran):
    _, (as_it_is, clipped, again, _) = ran
    assert [run.variant.name for run in ran[1]] == [
        *("as it is", "clipped", "the same again", "blown up")
    ]
    assert clipped.folder == again.folder != as_it_is.folder
    assert clipped.dataset().case["scheme"]["attraction"] == "clipped"


def test_runs_of_the_case_itself_lie_alone_in_runs(ran):
    """So that `crossdem compare OUT/runs/*` takes runs of one case, whatever else was done with it."""
    workspace, (as_it_is, clipped, _, _) = ran
    assert list((workspace.root / "runs").iterdir()) == [as_it_is.folder]
    assert clipped.folder.parent == workspace.root / "variants" / "runs"


def test_a_variant_that_blows_up_is_an_answer_and_the_others_go_on(ran):
    *others, blown = ran[1]
    assert blown.folder is None and "try a smaller time step" in blown.failure
    assert blown.exit_status == BEYOND_REASON and not blown.unsupported
    assert all(run.folder and not run.failure for run in others)


def test_the_contacts_of_a_variant_are_no_reference_for_another(tmp_path):
    """Their packing is the same, their rested beds are not."""
    case = small_case("time.rest_s=0.02", "time.penetration_s=0.02")
    soft = varied(case, ["contact.particle_particle.normal_stiffness_N_m=10.0"])
    packing = make_packing(case, 1, tmp_path / "packing")
    requests = [(RunRequest(one, packing, "native"), tmp_path) for one in (case, soft)]
    for result in run_ensemble(requests, tmp_path / "workflow", 2):
        gates = {gate["name"]: gate for gate in _gates(result)}
        assert gates["contacts_share"]["value"] == 0


def test_particles_placed_by_hand_are_one_packing(tmp_path):
    case = load_case(PLACED)
    with ProgressDisplay(Console(quiet=True)) as display:
        packings, unsettled = settle(case, 5, Workspace(tmp_path / "out"), 1, display)
    assert [packing.seed for packing in packings] == [1] and not unsettled


def _gates(result):
    from crossdem.adapters.dataset import Dataset

    return Dataset.read(result.dataset_folder).manifest["gates"]
