"""The gates: what a run must pass before it may be compared. A gate that fails is a result, not an error."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import replace
from typing import TypeVar

import numpy as np

from .dataset import Dataset
from .dataset_faults import lost_particles


REST = "rest_kinetic_energy_J"
CONTACTS = "contacts_share"
CONTACTS_AT_REST = "contacts_at_rest"  # in the manifest of a run that is compared
REFERENCE = "native"  # the engine whose rested bed the others' are compared with


def contacts_at_rest(dataset: Dataset) -> int:
    """Pairs of particles in contact at the end of the rest."""
    return int(dataset.resistance["contacts"].iloc[0])


Run = TypeVar("Run", bound=Hashable)


def with_gates(dataset: Dataset, native_contacts: int | None = None) -> Dataset:
    """The same run with its gates in the manifest.

    `native_contacts` are those of the native run on the same packing at the end of its rest. Without one (None)
    there is no such gate: the packing's own contacts, from before it was loaded without shear springs, are fewer.
    """
    limits = dataset.case["gates"]
    at_rest = dataset.resistance.iloc[0]
    gates = []
    if dataset.case["time"]["rest_s"] > 0:
        gates.append(_rest(float(at_rest["kinetic_energy_J"]), limits["rest_kinetic_energy_J"]))
    if native_contacts is not None:
        gates.append(_contacts(contacts_at_rest(dataset), native_contacts, limits[CONTACTS]))
    gates.append(_no_particle_lost(dataset))
    return replace(dataset, manifest=dataset.manifest | {"gates": gates})


def with_contacts_gates(manifests: Mapping[Run, dict], limit: float) -> dict[Run, dict]:
    """Manifests of runs of one case, which hold CONTACTS_AT_REST, with their gates on contacts set by the native run
    among them on the same packing. Without one, a run keeps the gate that it has.
    """
    native = {
        about["packing_hash"]: about[CONTACTS_AT_REST]
        for about in manifests.values()
        if about["engine"] == REFERENCE
    }

    def gated(about: dict) -> dict:
        if about["packing_hash"] not in native:
            return about
        own = [gate for gate in about["gates"] if gate["name"] != CONTACTS]
        anew = _contacts(about[CONTACTS_AT_REST], native[about["packing_hash"]], limit)
        return about | {"gates": [*own, anew]}

    return {run: gated(about) for run, about in manifests.items()}


def _rest(energy_J: float, limit_J: float) -> dict:
    passed = energy_J < limit_J
    said = "the bed rests" if passed else "not comparable: the bed does not rest at this time step"
    numbers = f"kinetic energy {energy_J:.3g} J at the end of the rest, allowed {limit_J:.3g} J"
    return _gate(REST, energy_J, limit_J, passed, f"{said} ({numbers})")


def _contacts(contacts: int, native_contacts: int, limit: float) -> dict:
    difference = abs(contacts - native_contacts) / max(1, native_contacts)
    passed = difference <= limit
    said = "the bed is the same" if passed else "not comparable: the rested bed is another one"
    numbers = f"{contacts} contacts, {native_contacts} in the native run; allowed to differ by {100 * limit:.3g} %"
    return _gate(CONTACTS, difference, limit, passed, f"{said} ({numbers})")


def _no_particle_lost(dataset: Dataset) -> dict:
    """Counted anew, though a Dataset refuses lost particles: the report shows what was found, not what is expected."""
    beyond = np.any(list(lost_particles(dataset.case, dataset.motion).values()), axis=(0, 1))
    lost = int(np.count_nonzero(beyond))
    said = "every particle stayed in the container" if lost == 0 else f"not comparable: {lost} lost"
    return _gate("no_particle_lost", lost, 0, lost == 0, said)


def _gate(name: str, value: float, limit: float, passed: bool, message: str) -> dict:
    return {"name": name, "value": value, "limit": limit, "passed": passed, "message": message}
