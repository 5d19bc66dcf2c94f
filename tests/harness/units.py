"""A case in other units: every number by the unit that its key ends with."""

from __future__ import annotations

from crossdem.adapters.case import Case

# Powers of length and of mass in a unit; the second stays as it is. The longest suffix counts.
POWERS = {
    "_N_s_m": (0, 1),
    "_kg_m3": (-3, 1),
    "_rad_s": (0, 0),
    "_m_s2": (1, 0),
    "_N_m": (0, 1),
    "_m_s": (1, 0),
    "_J": (2, 1),
    "_m": (1, 0),
}


def in_units(case: Case, length: float, mass: float) -> Case:
    """The same `case` where 1 m is `length` units and 1 kg is `mass` units: cm, g, s are 100 and 1000."""

    def scaled(value, key: str = ""):
        if isinstance(value, dict):
            return {name: scaled(entry, name) for name, entry in value.items()}
        if isinstance(value, list):
            return [scaled(entry, key) for entry in value]
        for suffix in sorted(POWERS, key=len, reverse=True):
            if key.endswith(suffix):
                of_length, of_mass = POWERS[suffix]
                return value * length**of_length * mass**of_mass
        return value

    return Case.from_resolved(scaled(case.resolved))
