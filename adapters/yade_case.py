"""Discs in a container, with or without a bar that is pushed down into them, for YADE 2023.02.

Start it in the folder that holds inputs/ and output/:  /usr/bin/python3 inputs/yade_case.py ENGINE
ENGINE is yade, or yade-averaged: with the paper's averaged displacement, see yade_averaged.py
Reads  inputs/case.json, inputs/packing.csv, inputs/packing.json
Writes output/samples.csv   one line per sample, the rest included; steps are counted from the end of the rest
       output/frames.f64    doubles, from the end of the rest on; per frame: step, tip of the bar (NaN without one),
                            then for every particle x, y, vx, vy, angle, angular velocity

YADE is imported as a module: its launcher opens network ports. SI units; y is up.
"""

import atexit
import csv
import json
import math
import os
import shutil
import sys
from glob import glob

import numpy as np

from yade_averaged import AveragedDisplacement

sys.path[1:1] = glob("/usr/lib/*/yade-double/py")

from yade import O, utils  # noqa: E402
from yade.wrapper import (  # noqa: E402
    Bo1_Box_Aabb,
    Bo1_Sphere_Aabb,
    Bo1_Wall_Aabb,
    ForceResetter,
    Ig2_Box_Sphere_ScGeom,
    Ig2_Sphere_Sphere_ScGeom,
    Ig2_Wall_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_ViscElMat_ViscElMat_ViscElPhys,
    Law2_ScGeom_ViscElPhys_Basic,
    MatchMaker,
    NewtonIntegrator,
    ViscElMat,
)

FEW = 30  # discs, of which every pair can be looked at in every step

[engine_name] = sys.argv[1:]  # yade or yade-averaged

# YADE makes itself a folder for temporary files, which only its launcher would clear away.
atexit.register(shutil.rmtree, os.path.dirname(O.tmpFilename()), ignore_errors=True)

with open("inputs/case.json", encoding="utf-8") as file:
    case = json.load(file)
with open("inputs/packing.json", encoding="utf-8") as file:
    bar_tip_m = json.load(file)["bar_tip_m"]
with open("inputs/packing.csv", encoding="utf-8") as file:
    discs = [{key: float(text) for key, text in row.items()} for row in csv.DictReader(file)]

time, bar_case = case["time"], case.get("bar")
step_s = case["engines"][engine_name]["step_s"]
rest, penetration, sample, frame = (
    round(time[key] / step_s)
    for key in ("rest_s", "penetration_s", "sample_interval_s", "frame_interval_s")
)
thickness_m = case["container"]["thickness_m"]
density = case["particles"]["density_kg_m3"]
largest_radius_m = max(disc["radius_m"] for disc in discs)


def in_series(wanted, particle):
    """What a wall needs, for it and a particle in series to give `wanted`; 0 stands for a rigid one, as in YADE."""
    if particle == 0 or wanted == particle:
        return wanted if particle == 0 else 0.0
    return 1 / (1 / wanted - 1 / particle)


def materials():
    """Two materials that give the case's stiffness and damping, as absolute values, to pairs and to walls."""
    pair, wall = case["contact"]["particle_particle"], case["contact"]["particle_wall"]
    keys = {
        "kn": "normal_stiffness_N_m",
        "ks": "shear_stiffness_N_m",
        "cn": "normal_damping_N_s_m",
        "cs": "shear_damping_N_s_m",
    }
    of_particle = {name: 2 * pair[key] for name, key in keys.items()}  # two alike in series
    of_wall = {name: in_series(wall[key], of_particle[name]) for name, key in keys.items()}
    return ViscElMat(density=density, **of_particle), ViscElMat(density=density, **of_wall)


particle_material, wall_material = materials()
particle_id = O.materials.append(particle_material)
wall_id = O.materials.append(wall_material)
friction_angle = MatchMaker(
    matches=(
        (particle_id, particle_id, math.atan(case["contact"]["particle_particle"]["friction"])),
        (particle_id, wall_id, math.atan(case["contact"]["particle_wall"]["friction"])),
    )
)

# Discs: spheres bound to the plane z = 0, with the mass and the inertia of discs set by hand.
particles = []
for disc in discs:
    radius_m = disc["radius_m"]
    body = utils.sphere((disc["x_m"], disc["y_m"], 0), radius_m, material=particle_material)
    body.state.mass = density * math.pi * radius_m * radius_m * thickness_m
    body.state.inertia = (0.5 * body.state.mass * radius_m * radius_m,) * 3
    body.state.vel = (disc["velocity_x_m_s"], disc["velocity_y_m_s"], 0)
    body.state.angVel = (0, 0, disc["angular_velocity_rad_s"])
    body.state.blockedDOFs = "zXY"
    particles.append(O.bodies[O.bodies.append(body)])
masses_kg = np.array([body.state.mass for body in particles])
inertias_kg_m2 = np.array([body.state.inertia[2] for body in particles])

O.bodies.append(utils.wall(0.0, axis=0, sense=1, material=wall_material))
O.bodies.append(utils.wall(case["container"]["width_m"], axis=0, sense=-1, material=wall_material))
floor_id = O.bodies.append(utils.wall(0.0, axis=1, sense=1, material=wall_material))

bar = None
if bar_case:
    # The bar is far deeper (z) than wide: a disc is pushed out along the least distance, z included.
    half_m = (
        bar_case["width_m"] / 2,
        bar_case["length_m"] / 2,
        100 * largest_radius_m + bar_case["length_m"],
    )
    centre_m = (bar_case["centre_x_m"], bar_tip_m + half_m[1], 0)
    bar = O.bodies[O.bodies.append(utils.box(centre_m, half_m, fixed=True, material=wall_material))]

gravity_m_s2 = case["gravity_m_s2"]
memory = None
if engine_name == "yade-averaged":
    memory = AveragedDisplacement(O.forces, [body.state for body in particles], step_s)
    gravity_m_s2 *= memory.gravity_share

collider = InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Box_Aabb()])
if len(particles) <= FEW:
    # Each pair is there from the start, in the order of the ids and for good: forces are summed up in that order.
    collider.verletDist = 100 * (case["container"]["width_m"] + case["container"]["height_m"])
    collider.targetInterv = -1
    for first in range(len(particles)):
        for second in range(first + 1, len(O.bodies)):
            utils.createInteraction(first, second, virtualI=True)
else:
    collider.verletDist = 0.2 * largest_radius_m

# Newton first: after a step the positions, the velocities and the forces are those that the law has seen together. Its
# forces are then those of the step before, of which it would warn in every step.
newton = NewtonIntegrator(damping=0, warnNoForceReset=False, gravity=(0, -gravity_m_s2, 0))
O.engines = [
    newton,
    ForceResetter(),
    collider,
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()],
        [Ip2_ViscElMat_ViscElMat_ViscElPhys(frictAngle=friction_angle)],
        [Law2_ScGeom_ViscElPhys_Basic()],
    ),
]
O.dt = step_s


def force_of(contact):
    """The force [N] of a contact's second body, a particle, on its first, the bar: as the law sums it up."""
    shape, law = contact.geom, contact.phys
    first, second = O.bodies[contact.id1].state, O.bodies[contact.id2].state
    relative = (first.vel + first.angVel.cross(shape.contactPoint - first.pos)) - (
        second.vel + second.angVel.cross(shape.contactPoint - second.pos)
    )
    shear_velocity = relative - shape.normal * relative.dot(shape.normal)
    force = law.normalForce + law.shearForce
    # A sliding contact has its shear spring at the cap, and no shear dashpot.
    cap_N = law.normalForce.norm() * law.tangensOfFrictionAngle
    if law.shearForce.norm() < cap_N * (1 - 1e-12):
        force += law.cs * shear_velocity
    return -force


def bar_forces():
    """Force of the particles on the bar [N]: x, y, and y's shares of the tip and of the shaft; 0 without one."""
    if not bar:
        return 0.0, 0.0, 0.0, 0.0
    total = O.forces.f(bar.id, sync=True)
    tip_m = bar.state.pos[1] - half_m[1]
    tip_y = shaft_y = 0.0
    for contact in O.interactions.withBody(bar.id):
        if not contact.isReal:
            continue
        below = O.bodies[contact.id2].state.pos[1] < tip_m
        force_y = force_of(contact)[1]
        tip_y, shaft_y = (tip_y + force_y, shaft_y) if below else (tip_y, shaft_y + force_y)
    if not abs(tip_y + shaft_y - total[1]) <= 1e-9 + 1e-12 * abs(total[1]):
        sys.exit(
            f"the contacts of the bar sum up to {tip_y + shaft_y!r} N, the force on it is {total[1]!r} N"
        )
    return total[0], total[1], tip_y, shaft_y


def contact_count():
    """Pairs of particles that overlap."""
    count = len(particles)
    return sum(
        1
        for contact in O.interactions
        if contact.isReal
        and contact.id1 < count
        and contact.id2 < count
        and contact.geom.penetrationDepth > 0
    )


def state_of_particles():
    """(N, 6): x, y, vx, vy, angle since the last sample or modulo one turn, angular velocity."""
    rows = []
    for body in particles:
        state = body.state
        position, velocity, turned = state.pos, state.vel, state.ori
        rows.append(
            (
                position[0],
                position[1],
                velocity[0],
                velocity[1],
                2 * math.atan2(turned[2], turned[3]),
                state.angVel[2],
            )
        )
    return np.array(rows)


angles = np.zeros(len(particles))
spins = np.array([disc["angular_velocity_rad_s"] for disc in discs])
recorded = 0  # step


def record(step, samples, frames):
    """Append the sample and the frame that are due, forced out: progress shows, and a full disk is noticed."""
    global angles, spins, recorded
    now = state_of_particles()
    if memory:
        now[:, [2, 3, 5]] = memory.velocities()
    if not np.isfinite(now).all():
        sys.exit(
            f"positions or velocities are not finite {(step - rest) * step_s:.6g} s after the rest"
        )
    # An orientation is known but for whole turns; these follow from the spins since the last record.
    angles += 0.5 * (spins + now[:, 5]) * (step - recorded) * step_s
    angles += np.remainder(now[:, 4] - angles + math.pi, 2 * math.pi) - math.pi
    now[:, 4], spins, recorded = angles, now[:, 5].copy(), step
    energy_J = 0.5 * np.sum(
        masses_kg * (now[:, 2] ** 2 + now[:, 3] ** 2) + inertias_kg_m2 * now[:, 5] ** 2
    )
    step -= rest
    if step % sample == 0:
        floor_y = O.forces.f(floor_id, sync=True)[1]
        row = [step, *bar_forces(), floor_y, contact_count(), float(energy_J)]
        print(*(repr(value) for value in row), sep=",", file=samples, flush=True)
    if step >= 0 and step % frame == 0:
        tip_m = bar.state.pos[1] - half_m[1] if bar else math.nan
        frames.write(np.concatenate([[step, tip_m], now.ravel()]).tobytes())
        frames.flush()


def run():
    """From the packing to the end of the penetration."""
    newton.dead = True
    O.step()  # the forces of the packing; nothing moves
    newton.dead = False
    end = rest + penetration
    stops = sorted({rest, *range(rest % sample, end + 1, sample), *range(rest, end + 1, frame)})
    with open("output/samples.csv", "w", encoding="ascii") as samples, open(
        "output/frames.f64", "wb"
    ) as frames:
        print(
            "step,force_x_N,force_y_N,tip_force_y_N,shaft_force_y_N,floor_force_y_N,contacts,kinetic_energy_J",
            file=samples,
        )
        done = 0
        for stop in stops:
            for _ in range(done, stop):
                if memory:
                    memory.add_force()
                O.step()  # O.run would wait for up to 40 ms after its last step
            done = stop
            record(stop, samples, frames)
            if stop == rest and bar:
                bar.state.vel = (0, -bar_case["speed_m_s"], 0)


run()
