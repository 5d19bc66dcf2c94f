#pragma once
// The schema of a case, once: each key with its member, its range and, where it may be left out, its default.
// A visitor that reads (case_reader.hpp) and one that writes (case_writer.hpp) walk the same description.

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "crossdem/case.hpp"

namespace crossdem::schema {

/// The native schemes; the first is the default.
inline constexpr std::array<std::string_view, 5> scheme_names{"paper", "liggghts", "yade", "liggghts_averaged",
                                                              "yade_averaged"};

enum class Range { any, positive, non_negative, share };

template <class Enum>
using Names = std::initializer_list<std::pair<Enum, std::string_view>>;

template <class Visitor>
void contact(Visitor& v, ContactParameters& p) {
  v.number("normal_stiffness_N_m", p.normal_stiffness, Range::positive);
  v.number("shear_stiffness_N_m", p.shear_stiffness, Range::non_negative);
  v.number("normal_damping_N_s_m", p.normal_damping, Range::non_negative);
  v.number("shear_damping_N_s_m", p.shear_damping, Range::non_negative);
  v.number("friction", p.friction, Range::non_negative);
  v.option("rolling_friction", p.rolling_friction);
}

template <class Visitor>
void readings(Visitor& v, Readings& r) {
  v.choice(
      "update_order", r.update_order,
      Names<UpdateOrder>{{UpdateOrder::forces_then_moves, "forces_then_moves"}, {UpdateOrder::in_turn, "in_turn"}});
  v.choice("first_contact_normal", r.first_contact_normal,
           Names<FirstContactNormal>{{FirstContactNormal::spring_and_dashpot, "spring_and_dashpot"},
                                     {FirstContactNormal::spring_only, "spring_only"}});
  v.choice("first_contact_shear", r.first_contact_shear,
           Names<FirstContactShear>{{FirstContactShear::clamped_share, "clamped_share"},
                                    {FirstContactShear::raw_share, "raw_share"},
                                    {FirstContactShear::whole_step, "whole_step"}});
  v.choice("lost_contact", r.lost_contact,
           Names<LostContact>{{LostContact::forget, "forget"},
                              {LostContact::keep_zero, "keep_zero"},
                              {LostContact::keep_negative, "keep_negative"}});
  v.choice("attraction", r.attraction,
           Names<Attraction>{{Attraction::allowed, "allowed"}, {Attraction::clipped, "clipped"}});
  v.choice("normal_spring", r.normal_spring,
           Names<NormalSpring>{{NormalSpring::incremental, "incremental"}, {NormalSpring::overlap, "overlap"}});
  v.choice("dashpot_velocity", r.dashpot_velocity,
           Names<DashpotVelocity>{{DashpotVelocity::averaged_displacement, "averaged_displacement"},
                                  {DashpotVelocity::true_velocity, "true_velocity"}});
  v.choice(
      "initial_displacement", r.initial_displacement,
      Names<InitialDisplacement>{{InitialDisplacement::velocity, "velocity"}, {InitialDisplacement::zero, "zero"}});
  v.choice("bar_corner", r.bar_corner,
           Names<BarCorner>{{BarCorner::nearest_point, "nearest_point"}, {BarCorner::faces_only, "faces_only"}});
  v.choice("slip_cap", r.slip_cap, Names<SlipCap>{{SlipCap::spring, "spring"}, {SlipCap::total, "total"}});
  v.choice("torque_arm", r.torque_arm,
           Names<TorqueArm>{{TorqueArm::radius, "radius"}, {TorqueArm::contact_point, "contact_point"}});
  v.choice("integrator", r.integrator,
           Names<Integration>{{Integration::averaged_displacement, "averaged_displacement"},
                              {Integration::leap_frog, "leap_frog"},
                              {Integration::velocity_verlet, "velocity_verlet"}});
  v.choice("inertia", r.inertia, Names<Inertia>{{Inertia::disc, "disc"}, {Inertia::sphere, "sphere"}});
}

template <class Visitor>
void check(Visitor& v, Check& c) {
  v.identifier("quantity", c.quantity);
  v.choice("kind", c.kind,
           Names<MarginKind>{
               {MarginKind::relative, "relative"}, {MarginKind::absolute, "absolute"}, {MarginKind::ratio, "ratio"}});
  v.number("margin", c.margin, Range::positive);
  v.number("seed_scatter", c.seed_scatter, Range::positive);
  v.text("reason", c.reason);
}

template <class Visitor>
void answer(Visitor& v, Answer& a) {
  v.identifier("quantity", a.quantity);
  v.choice("kind", a.kind, Names<MarginKind>{{MarginKind::relative, "relative"}, {MarginKind::absolute, "absolute"}});
  v.number("tolerance", a.tolerance, Range::positive);
  v.text("reason", a.reason);
}

template <class Visitor>
void difference(Visitor& v, ExpectedDifference& d) {
  v.identifier("engine", d.engine);
  v.identifier("quantity", d.quantity);
  v.number("value", d.value, Range::any);
  v.number("tolerance", d.tolerance, Range::positive);
  v.text("reason", d.reason);
}

/// Count, diameters and shares of particles that are placed by hand.
inline ParticleMix mix_of(const std::vector<PlacedParticle>& placed) {
  std::map<double, int> counts;
  for (const PlacedParticle& particle : placed) ++counts[2 * particle.radius];
  ParticleMix mix;
  mix.count = static_cast<int>(placed.size());
  for (const auto& [diameter, count] : counts) {
    mix.diameters.push_back(diameter);
    mix.number_shares.push_back(static_cast<double>(count) / mix.count);
  }
  return mix;
}

template <class Visitor>
void root(Visitor& v, Case& c) {
  v.version("schema_version", 1);
  v.identifier("name", c.name);
  v.text("title", c.title, c.name);
  v.number("gravity_m_s2", c.gravity, Range::non_negative, 9.80665);
  v.group("container", [&] {
    v.number("width_m", c.container.width, Range::positive);
    v.number("height_m", c.container.height, Range::positive);
    v.number("thickness_m", c.container.thickness, Range::positive);
  });
  v.optional_list("particle", c.placed, [&](PlacedParticle& p) {
    v.number("x_m", p.x, Range::any);
    v.number("y_m", p.y, Range::any);
    v.number("radius_m", p.radius, Range::positive);
    v.number("velocity_x_m_s", p.velocity_x, Range::any, 0.0);
    v.number("velocity_y_m_s", p.velocity_y, Range::any, 0.0);
    v.number("angular_velocity_rad_s", p.angular_velocity, Range::any, 0.0);
  });
  const bool placed = !c.placed.empty();
  const std::optional<ParticleMix> mix = placed ? std::optional(mix_of(c.placed)) : std::nullopt;
  v.group("particles", [&] {
    v.integer("count", c.particles.count, 1, 10'000'000, mix ? std::optional(mix->count) : std::nullopt);
    v.numbers("diameters_m", c.particles.diameters, Range::positive,
              mix ? std::optional(mix->diameters) : std::nullopt);
    v.numbers("number_shares", c.particles.number_shares, Range::share,
              mix ? std::optional(mix->number_shares) : std::nullopt);
    v.number("density_kg_m3", c.particles.density, Range::positive);
  });
  v.optional_part("bar", c.bar, [&](BarGeometry& bar) {
    v.number("width_m", bar.width, Range::positive);
    v.number("length_m", bar.length, Range::positive, c.container.height);
    v.number("centre_x_m", bar.centre_x, Range::positive, c.container.width / 2);
    v.number("speed_m_s", bar.speed, Range::positive);
    v.number("tip_m", bar.tip, Range::non_negative, 0.0);
  });
  v.group("contact", [&] {
    v.group("particle_particle", [&] {
      contact(v, c.particle_particle);
      v.option("tensile_strength_N", c.particle_particle.tensile_strength);
    });
    v.group("particle_wall", [&] { contact(v, c.particle_wall); });
  });
  v.group("time", [&] {
    v.number("step_s", c.time.step, Range::positive);
    v.number("rest_s", c.time.rest, Range::non_negative, placed ? 0.0 : 1.2);
    v.number("penetration_s", c.time.penetration, Range::positive);
    v.number("sample_interval_s", c.time.sample_interval, Range::positive, 100 * c.time.step);
    v.number("frame_interval_s", c.time.frame_interval, Range::positive, 1000 * c.time.step);
    v.boolean("allow_above_eq32", c.time.allow_above_eq32, false);
  });
  const EngineSettings conventional{c.time.step / 2};  // below the packed-bed limit where the paper scheme is, too
  v.optional_map("engines", c.engines,
                 {{"liggghts", conventional},
                  {"yade", conventional},
                  {"liggghts-averaged", {c.time.step}},
                  {"yade-averaged", {c.time.step}}},
                 [&](EngineSettings& engine) { v.number("step_s", engine.step, Range::positive); });
  const auto recipe = [&] {
    const auto& diameters = c.particles.diameters;
    const double largest = diameters.empty() ? 1.0 : *std::max_element(diameters.begin(), diameters.end());
    v.number("lattice_spacing_m", c.packing.lattice_spacing, Range::positive, 1.08 * largest);
    v.number("jitter_m", c.packing.jitter, Range::non_negative, (c.packing.lattice_spacing - largest) / 2);
    v.number("velocity_m_s", c.packing.velocity, Range::non_negative, 0.05);
    v.number("wall_friction", c.packing.wall_friction, Range::non_negative, 0.25);
    v.number("step_s", c.packing.step, Range::positive, c.time.step);
    v.number("settling_s", c.packing.settling, Range::non_negative, 1.5);
    v.number("longest_settling_s", c.packing.longest_settling, Range::positive, 10.0);
    v.number("kinetic_energy_J", c.packing.kinetic_energy, Range::positive, 1e-9);
  };
  if (!placed) v.optional_group("packing", recipe);
  v.optional_group("scheme", [&] {
    v.one_of("name", c.scheme.name, scheme_names);
    readings(v, c.scheme.readings);
  });
  v.optional_group("gates", [&] {
    v.number("rest_kinetic_energy_J", c.gates.rest_kinetic_energy, Range::positive, 1e-8);
    v.number("contacts_share", c.gates.contacts_share, Range::positive, 0.01);
  });
  v.optional_group("marks", [&] {
    v.number("layer_height_m", c.marks.layer_height, Range::positive, 0.03);
    v.number("cell_size_m", c.marks.cell_size, Range::positive, 0.01);
    v.number("near_bar_m", c.marks.near_bar, Range::positive, 0.01);
  });
  v.optional_list("check", c.checks, [&](Check& entry) { check(v, entry); });
  v.optional_list("answer", c.answers, [&](Answer& entry) { answer(v, entry); });
  v.optional_list("difference", c.differences, [&](ExpectedDifference& entry) { difference(v, entry); });
  v.optional_list("twin", c.twins, [&](TwinLimit& twin) {
    v.identifier("engine", twin.engine);
    v.number("limit_m", twin.limit, Range::non_negative);
    v.number("until_s", twin.until, Range::positive, c.time.penetration);
    v.text("reason", twin.reason);
  });
}

}  // namespace crossdem::schema
