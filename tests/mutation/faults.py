"""Faults to seed in a copy of the native solver: one text of its sources each, and the wrong one in its place.

The product holds none of them. Scalars are wrong in both directions, since a layer may see one of them alone.
"""

from __future__ import annotations

from workshop import Fault

SCALAR = "scalar"  # a number of the material or of the motion
LAW = "law"  # a term of the contact law, or of the loads that follow from it
MEMORY = "memory"  # what a contact carries from step to step
LIST = "list"  # which contacts are looked at
SURFACE = "surface"  # walls and bar
RECORD = "record"  # the motion is right, what is written of it is not

LAWS = "laws/tanaka.hpp"
STEP = "step.hpp"
MOTION = "integrators.hpp"
SET_UP = "simulation.cpp"
CONTACTS = "contacts.hpp"
SURFACES = "surfaces.hpp"
BAR = "bar.hpp"


def _of_contacts(name: str, change: str, which: str = "&w.particle_particle, &w.particle_wall"):
    """A parameter of all contacts, or `which`, changed before the first step; `p` is the set of parameters."""
    right = "  if (bar_tip) w.surfaces.bar.emplace("
    wrong = f"  for (ContactParameters* p : {{{which}}}) {change};\n{right}"
    return Fault(name, SCALAR, SET_UP, right, wrong)


def _factor(name: str, kind: str, file: str, before: str, after: str, factor: str) -> Fault:
    """`factor` between the two texts `before` and `after`."""
    return Fault(name, kind, file, before + after, before + factor + after)


WALLS = "&w.particle_wall"
PAIRS = "&w.particle_particle"
OUTDATED = "return moved + std::max(moved, bar_moved) > "
ADVANCE = "++i) scheme_.integrator.advance(p_, i, w_.loads[i], w_.gravity, "

PARAMETERS = (
    _of_contacts("friction +10 %", "p->friction *= 1.1"),
    _of_contacts("friction -10 %", "p->friction *= 0.9"),
    _of_contacts("wall friction +10 %", "p->friction *= 1.1", WALLS),
    _of_contacts("wall friction -10 %", "p->friction *= 0.9", WALLS),
    _of_contacts("friction silently off", "p->friction = 0.0"),
    _of_contacts("tangent of the friction coefficient", "p->friction = std::tan(p->friction)"),
    _of_contacts("pair friction on walls", "p->friction = w.particle_particle.friction", WALLS),
    _of_contacts("normal stiffness x 2", "p->normal_stiffness *= 2"),
    _of_contacts("normal stiffness x 0.5", "p->normal_stiffness /= 2"),
    _of_contacts("shear stiffness x 2", "p->shear_stiffness *= 2"),
    _of_contacts("shear stiffness x 0.5", "p->shear_stiffness /= 2"),
    _of_contacts("double the damping at walls", "p->normal_damping *= 2", WALLS),
    _of_contacts("half the damping at walls", "p->normal_damping /= 2", WALLS),
    _of_contacts("double the damping of pairs", "p->normal_damping *= 2", PAIRS),
    _of_contacts("half the damping of pairs", "p->normal_damping /= 2", PAIRS),
    _factor("density x 1.1", SCALAR, "case.cpp", "return ", "particles.density", "1.1 * "),
    _factor("density x 0.9", SCALAR, "case.cpp", "return ", "particles.density", "0.9 * "),
    Fault(
        "mass of a sphere",
        SCALAR,
        "case.cpp",
        "radius * radius * container.thickness",
        "radius * radius * (4 * radius / 3)",
    ),
    Fault(
        "inertia of a sphere", SCALAR, "state.cpp", "push_back(0.5 * disc", "push_back(0.4 * disc"
    ),
    _factor("gravity 9.81", SCALAR, MOTION, "Vector2(0.0, ", "gravity * dt)", "9.81 / 9.80665 * "),
    Fault(
        "gravity without mass",
        SCALAR,
        MOTION,
        "Vector2(0.0, gravity * dt)",
        "Vector2(0.0, gravity * dt / p.mass[i])",
    ),
    _factor("time step +10 %", SCALAR, STEP, ADVANCE, "w_.dt)", "1.1 * "),
    _factor("time step -10 %", SCALAR, STEP, ADVANCE, "w_.dt)", "0.9 * "),
)

FORMULAS = (
    Fault(
        "slip cap from the total normal force",
        LAW,
        LAWS,
        "readings.slip_cap == SlipCap::spring ?",
        "readings.slip_cap == SlipCap::total ?",
    ),
    Fault(
        "tension allowed",
        LAW,
        LAWS,
        "if (spring.normal < -p.tensile_strength) return lose(spring);",
        "if (spring.normal < -1e300) return lose(spring);",
    ),
    Fault(
        "dashpot kept while sliding",
        LAW,
        LAWS,
        "if (std::abs(spring) > cap) return spring = std::copysign(cap, spring);",
        "if (std::abs(spring) > cap) spring = std::copysign(cap, spring);",
    ),
    Fault(
        "whole step at first contact", LAW, LAWS, "u = share_in_contact(u);", "u.overlap *= 1.0;"
    ),
    Fault(
        "spin of the wrong sign in pairs",
        LAW,
        STEP,
        "arm_i * p_.rotation[i] + arm_j * p_.rotation[j]",
        "arm_i * p_.rotation[i] - arm_j * p_.rotation[j]",
    ),
    Fault(
        "spin of the wrong sign at walls",
        LAW,
        STEP,
        "displacement(contact.surface), arm * disc.rotation",
        "displacement(contact.surface), -arm * disc.rotation",
    ),
    Fault(
        "torque arm to the contact point",
        LAW,
        STEP,
        "return reading == TorqueArm::radius ?",
        "return reading == TorqueArm::contact_point ?",
    ),
    Fault(
        "no moment on the partner",
        LAW,
        STEP,
        "add(contact.j, f.force, -f.normal, f.lever_j, -f.rolling_lever_j);",
        "add(contact.j, f.force, -f.normal, 0.0, -f.rolling_lever_j);",
    ),
    Fault(
        "radius of one for both",
        LAW,
        STEP,
        "const double reach = p_.radius[i] + p_.radius[j];",
        "const double reach = 2 * p_.radius[i];",
    ),
    Fault("rotation off", LAW, MOTION, "p.spin[i] -= load.rim", "p.spin[i] -= 0.0 * load.rim"),
    Fault(
        "displacement not averaged",
        LAW,
        MOTION,
        "0.5 * (p.displacement[i] + p.velocity[i] * dt);",
        "p.velocity[i] * dt;",
    ),
)

MEMORIES = (
    Fault(
        "history lost at walls",
        MEMORY,
        STEP,
        "const double overlap = disc.radius - nearest.distance;",
        "const double overlap = disc.radius - nearest.distance;\n  memory.shear = 0.0;",
    ),
    Fault(
        "history lost with the neighbour list",
        MEMORY,
        CONTACTS,
        "contact.memory = old_contact->memory;",
        "contact.memory = {};",
    ),
    Fault(
        "spring kept after parting",
        MEMORY,
        STEP,
        "if (distance_squared >= farthest * farthest) {\n      contact.memory = {};",
        "if (distance_squared >= farthest * farthest) {\n      if (contact.memory.touching()) contact.memory.normal = 0.0;",
    ),
)

LISTS = (
    _factor("neighbour list never made anew", LIST, CONTACTS, OUTDATED, "skin_.now();", "1e9 * "),
    _factor("neighbour list kept too long", LIST, CONTACTS, OUTDATED, "skin_.now();", "3 * "),
    Fault(
        "neighbour list blind to the bar",
        LIST,
        CONTACTS,
        "return moved + std::max(moved, bar_moved) > skin_.now();",
        "return moved + moved > skin_.now() + 0.0 * bar_moved;",
    ),
)

BOUNDARIES = (
    Fault(
        "bar without its right face",
        SURFACE,
        SURFACES,
        "return nearest.distance < radius &&",
        "return nearest.distance < radius && !(surface == Surface::bar && nearest.normal.x() == -1.0) &&",
    ),
    Fault(
        "bar without its corners",
        SURFACE,
        SURFACES,
        "(corner == BarCorner::nearest_point ||",
        "(corner == BarCorner::faces_only ||",
    ),
    Fault(
        "bar whose motion is not felt",
        SURFACE,
        BAR,
        "displacement_.y() = -geometry_.speed * dt;",
        "displacement_.y() = -0.0 * dt;",
    ),
    _factor(
        "bar 10 % too fast",
        SURFACE,
        BAR,
        "start_(tip), tip_(tip) {",
        "}",
        "geometry_.speed *= 1.1;",
    ),
    _factor(
        "bar 10 % too slow",
        SURFACE,
        BAR,
        "start_(tip), tip_(tip) {",
        "}",
        "geometry_.speed *= 0.9;",
    ),
    Fault(
        "right wall 0.1 % too far left",
        SURFACE,
        SURFACES,
        "return {{1.0, 0.0}, width - centre.x()};",
        "return {{1.0, 0.0}, 0.999 * width - centre.x()};",
    ),
)

RECORDS = (
    Fault(
        "bar force without shear",
        RECORD,
        STEP,
        "totals.add(w_.surfaces, contact.surface, disc.centre, add(i, f.force, f.normal, f.lever, surface_rolling_lever));",
        "add(i, f.force, f.normal, f.lever, surface_rolling_lever);\n"
        "    totals.add(w_.surfaces, contact.surface, disc.centre, -f.force.normal * f.normal);",
    ),
    Fault(
        "bar force without its right face",
        RECORD,
        "world.hpp",
        "if (surface == Surface::bar) (",
        "if (surface == Surface::bar && centre.x() < surfaces.bar->right()) (",
    ),
    Fault(
        "tip and shaft confused",
        RECORD,
        "world.hpp",
        "? on_bar.tip : on_bar.shaft)",
        "? on_bar.shaft : on_bar.tip)",
    ),
    Fault(
        "contacts counted across gaps",
        RECORD,
        SET_UP,
        "close_pairs(state_->world.particles, 0.0).size();",
        "close_pairs(state_->world.particles, 2e-5).size();",
    ),
    Fault(
        "kinetic energy without rotation",
        RECORD,
        "state.cpp",
        "particles.inertia[i] * particles.spin[i] *",
        "0.0 * particles.spin[i] *",
    ),
)

FAULTS = PARAMETERS + FORMULAS + MEMORIES + LISTS + BOUNDARIES + RECORDS
