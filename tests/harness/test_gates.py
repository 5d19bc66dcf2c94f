"""What a run must pass before it is compared."""

import pytest
import synthetic

from crossdem.adapters.dataset import Dataset
from crossdem.adapters.gates import with_gates


def gates(native_contacts=1700, rest_s=1.2, **at_rest):
    case = synthetic.case()
    case.resolved["time"]["rest_s"] = rest_s
    whole = synthetic.dataset(case)
    table = whole.resistance.assign(kinetic_energy_J=1e-10)
    for column, value in at_rest.items():
        table.loc[0, column] = value
    run = Dataset(whole.case, whole.manifest, whole.radius_m, whole.motion, table)
    found = with_gates(run, native_contacts).manifest["gates"]
    return {gate["name"]: gate for gate in found}


def test_a_bed_at_rest_like_the_native_one_passes():
    found = gates()
    assert list(found) == ["rest_kinetic_energy_J", "contacts_share", "no_particle_lost"]
    assert all(gate["passed"] for gate in found.values())


@pytest.mark.parametrize("energy_J, passed", [(0.99e-8, True), (1e-8, False), (3e-4, False)])
def test_a_bed_that_moves_at_the_end_of_its_rest_fails(energy_J, passed):
    gate = gates(kinetic_energy_J=energy_J)["rest_kinetic_energy_J"]
    assert (gate["value"], gate["limit"], gate["passed"]) == (energy_J, 1e-8, passed)
    assert passed or gate["message"].startswith(
        "not comparable: the bed does not rest at this time step"
    )


@pytest.mark.parametrize(
    "contacts, passed", [(1683, True), (1717, True), (1682, False), (1718, False)]
)
def test_contacts_may_differ_from_native_by_one_per_cent(contacts, passed):
    gate = gates(contacts=contacts)["contacts_share"]
    assert gate["passed"] is passed
    assert f"{contacts} contacts, 1700 in the native run" in gate["message"]


def test_without_a_native_run_there_is_no_gate_on_contacts():
    assert "contacts_share" not in gates(native_contacts=None)


def test_without_a_rest_nothing_need_be_at_rest():
    assert "rest_kinetic_energy_J" not in gates(rest_s=0.0, kinetic_energy_J=1.0)
