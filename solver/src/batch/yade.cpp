// YADE: the law of schemes/yade.hpp and laws/yade_viscel.hpp, and its leap-frog.

#include "instruction_sets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch/yade.cpp"
#include <hwy/foreach_target.h>

#include "lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace crossdem::batch::HWY_NAMESPACE {

class ViscElPairLaw {
 public:
  static constexpr bool turn_alike = false;
  static constexpr Signs signs{{-1.0, -1.0, -1.0, 1.0}, {1.0, 1.0, 1.0, 0.0}};
  ViscElPairLaw(const ContactParameters& parameters, double dt) : k_(parameters), dt_(dt) {}

  struct Approach {
    Columns i;
    Columns j;
    Vector distance_squared;
    Vector distance;
    Vector normal_x;  // from i to j
    Vector normal_y;
  };

  static HWY_INLINE Approach approach(const std::uint32_t* i, const std::uint32_t* j, const Disc* discs) {
    const Columns a = columns_of(i, discs);
    const Columns b = columns_of(j, discs);
    const Vector x = hn::Sub(b.x, a.x);
    const Vector y = hn::Sub(b.y, a.y);
    const Vector distance_squared = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
    const Vector distance = hn::Sqrt(distance_squared);
    const Vector inverse = hn::Div(hn::Set(lanes, 1.0), distance);
    return {a, b, distance_squared, distance, quotient(x, distance, inverse), quotient(y, distance, inverse)};
  }

  /// Zero, and nothing remembered, where there is no interaction.
  template <class Memory>
  HWY_INLINE Forces forces(const Approach& a, Memory memory) const {
    const Vector zero = hn::Zero(lanes);
    const Vector dt = hn::Set(lanes, dt_);
    const Vector normal_x = a.normal_x;
    const Vector normal_y = a.normal_y;
    Vector shear_x = hn::Load(lanes, memory(0));
    Vector shear_y = hn::Load(lanes, memory(1));
    const Vector before_x = hn::Load(lanes, memory(2));
    const Vector before_y = hn::Load(lanes, memory(3));
    const Vector reach = hn::Add(a.i.radius, a.j.radius);
    const Mask real = hn::Or(hn::Ne(before_x, zero), hn::Ne(before_y, zero));
    const Mask near = hn::Or(real, hn::Ge(hn::Sub(hn::Mul(reach, reach), a.distance_squared), zero));
    const Vector overlap = hn::Sub(reach, a.distance);
    const Mask acts = hn::AndNot(hn::Lt(overlap, zero), near);

    const Vector depth = hn::Sub(a.i.radius, hn::Mul(hn::Set(lanes, 0.5), overlap));
    const Vector point_x = hn::Add(a.i.x, hn::Mul(depth, normal_x));
    const Vector point_y = hn::Add(a.i.y, hn::Mul(depth, normal_y));
    const Vector arm_i_x = hn::Sub(point_x, a.i.x);
    const Vector arm_i_y = hn::Sub(point_y, a.i.y);
    const Vector arm_j_x = hn::Sub(point_x, a.j.x);
    const Vector arm_j_y = hn::Sub(point_y, a.j.y);
    const Vector velocity_x =
        hn::Sub(hn::Sub(a.i.moves_x, hn::Mul(a.i.turns, arm_i_y)), hn::Sub(a.j.moves_x, hn::Mul(a.j.turns, arm_j_y)));
    const Vector velocity_y =
        hn::Sub(hn::Add(a.i.moves_y, hn::Mul(a.i.turns, arm_i_x)), hn::Add(a.j.moves_y, hn::Mul(a.j.turns, arm_j_x)));

    const Vector turn = hn::Sub(hn::Mul(before_x, normal_y), hn::Mul(before_y, normal_x));
    const Vector turned_x = hn::Sub(shear_x, hn::Mul(shear_y, turn));
    const Vector turned_y = hn::Add(shear_y, hn::Mul(shear_x, turn));
    const Vector approach = hn::Add(hn::Mul(normal_x, velocity_x), hn::Mul(normal_y, velocity_y));
    const Vector sliding_x = hn::Sub(velocity_x, hn::Mul(approach, normal_x));
    const Vector sliding_y = hn::Sub(velocity_y, hn::Mul(approach, normal_y));
    const Vector stiffness = hn::Set(lanes, k_.shear_stiffness * dt_);
    shear_x = hn::Add(turned_x, hn::Mul(stiffness, sliding_x));
    shear_y = hn::Add(turned_y, hn::Mul(stiffness, sliding_y));
    const Vector push = hn::Add(hn::Mul(hn::Set(lanes, k_.normal_stiffness), overlap),
                                hn::Mul(hn::Set(lanes, k_.normal_damping), approach));
    const Mask pulls = hn::Lt(push, zero);
    const Vector push_x = hn::IfThenZeroElse(pulls, hn::Mul(push, normal_x));
    const Vector push_y = hn::IfThenZeroElse(pulls, hn::Mul(push, normal_y));
    const Vector cap_squared =
        hn::Mul(hn::Add(hn::Mul(push_x, push_x), hn::Mul(push_y, push_y)), hn::Set(lanes, k_.friction * k_.friction));
    const Vector shear_squared = hn::Add(hn::Mul(shear_x, shear_x), hn::Mul(shear_y, shear_y));
    const Mask slips = hn::And(acts, hn::Gt(shear_squared, cap_squared));
    const Vector damping = hn::Set(lanes, k_.shear_damping);
    Vector drag_x = hn::Mul(damping, sliding_x);
    Vector drag_y = hn::Mul(damping, sliding_y);
    if (HWY_UNLIKELY(!hn::AllFalse(lanes, slips))) {
      const Vector share = hn::Div(hn::Sqrt(cap_squared), hn::Sqrt(shear_squared));
      shear_x = hn::IfThenElse(slips, hn::Mul(shear_x, share), shear_x);
      shear_y = hn::IfThenElse(slips, hn::Mul(shear_y, share), shear_y);
      drag_x = hn::IfThenZeroElse(slips, drag_x);
      drag_y = hn::IfThenZeroElse(slips, drag_y);
    }
    hn::Store(hn::IfThenElseZero(acts, shear_x), lanes, memory(0));
    hn::Store(hn::IfThenElseZero(acts, shear_y), lanes, memory(1));
    hn::Store(hn::IfThenElseZero(acts, normal_x), lanes, memory(2));
    hn::Store(hn::IfThenElseZero(acts, normal_y), lanes, memory(3));
    const Vector force_x = hn::IfThenElseZero(acts, hn::Add(hn::Add(push_x, shear_x), drag_x));
    const Vector force_y = hn::IfThenElseZero(acts, hn::Add(hn::Add(push_y, shear_y), drag_y));
    const Vector power = hn::Add(hn::Mul(force_x, velocity_x), hn::Mul(force_y, velocity_y));
    return {force_x, force_y, hn::Sub(hn::Mul(arm_i_x, force_y), hn::Mul(arm_i_y, force_x)),
            hn::Sub(hn::Mul(arm_j_x, force_y), hn::Mul(arm_j_y, force_x)), hn::Mul(power, dt)};
  }

 private:
  const ContactParameters& k_;
  double dt_;
};

void AddYadeForces(std::span<YadePairs> pairs, const Disc* discs, Load* loads, const ContactParameters& parameters,
                   double dt) {
  add_pair_forces(ViscElPairLaw(parameters, dt), pairs, discs, loads);
}

/// The further load m (w_(t-1) - w_(t-2)) / dt.
HWY_INLINE void add_memory(Turn<LeapFrogGroup>&, double) {}

HWY_INLINE void add_memory(Turn<MemoryForceGroup>& t, double dt) {
  const Vector twice = hn::Set(lanes, 2 * dt);  // as the masses are
  const Vector per_twice = hn::Set(lanes, 1.0 / (2 * dt));
  const auto add = [&](Vector& load, const Column& mass, Vector rate, Column& rate_before) HWY_ATTR {
    const Vector change = hn::Sub(rate, t.of(rate_before));
    load = hn::Add(load, quotient(hn::Mul(t.of(mass), change), twice, per_twice));
    t.put(rate_before, rate);
  };
  add(t.force_x, t.group.mass, t.moves_x, t.group.rate_before_x);
  add(t.force_y, t.group.mass, t.moves_y, t.group.rate_before_y);
  add(t.turning, t.group.inertia, t.of(t.group.spin), t.group.turning_before);
}

template <class AnyGroup>
HWY_INLINE Moved leap(std::size_t particles, AnyGroup* groups, Disc* discs, Load* loads, double gravity, double step) {
  const Vector dt = hn::Set(lanes, step);
  const Vector fall = hn::Set(lanes, gravity);
  Largest farthest(particles);
  Largest stride(particles);
  for (std::size_t i = 0; i < particles; i += count) {
    Turn<AnyGroup> t(i, groups, discs, loads);
    AnyGroup& group = t.group;
    add_memory(t, step);
    const Vector mass = t.of(group.mass);
    const Vector per_mass = t.of(group.per_mass);
    t.moves_x = hn::Add(t.moves_x, hn::Mul(dt, quotient(t.force_x, mass, per_mass)));
    t.moves_y = hn::Add(t.moves_y, hn::Mul(dt, hn::Sub(quotient(t.force_y, mass, per_mass), fall)));
    const Vector spin =
        t.increase(group.spin, hn::Mul(dt, quotient(t.turning, t.of(group.inertia), t.of(group.per_inertia))));
    const Vector displacement_x = hn::Mul(t.moves_x, dt);
    const Vector displacement_y = hn::Mul(t.moves_y, dt);
    t.x = hn::Add(t.x, displacement_x);
    t.y = hn::Add(t.y, displacement_y);
    t.increase(group.angle, hn::Mul(spin, dt));
    t.finish([&group](std::size_t k, double) { return group.spin[k]; });
    farthest.include(i, t.squared_way_from(group.listed_x, group.listed_y));
    stride.include(i, hn::Add(hn::Mul(displacement_x, displacement_x), hn::Mul(displacement_y, displacement_y)));
  }
  return {.farthest_squared = farthest.value(), .stride_squared = stride.value()};
}

Moved MoveLeapFrog(std::size_t particles, LeapFrogGroup* groups, Disc* discs, Load* loads, double gravity, double dt) {
  return leap(particles, groups, discs, loads, gravity, dt);
}

Moved MoveMemoryForce(std::size_t particles, MemoryForceGroup* groups, Disc* discs, Load* loads, double gravity,
                      double dt) {
  return leap(particles, groups, discs, loads, gravity, dt);
}

}  // namespace crossdem::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossdem::batch {

HWY_EXPORT(AddYadeForces);
HWY_EXPORT(MoveLeapFrog);
HWY_EXPORT(MoveMemoryForce);

void add_yade_forces(std::span<YadePairs> pairs, const Disc* discs, Load* loads, const ContactParameters& parameters,
                     double dt) {
  HWY_DYNAMIC_DISPATCH(AddYadeForces)(pairs, discs, loads, parameters, dt);
}

Moved move_leap_frog(std::size_t particles, LeapFrogGroup* groups, Disc* discs, Load* loads, double gravity,
                     double dt) {
  return HWY_DYNAMIC_DISPATCH(MoveLeapFrog)(particles, groups, discs, loads, gravity, dt);
}

Moved move_leap_frog(std::size_t particles, MemoryForceGroup* groups, Disc* discs, Load* loads, double gravity,
                     double dt) {
  return HWY_DYNAMIC_DISPATCH(MoveMemoryForce)(particles, groups, discs, loads, gravity, dt);
}

}  // namespace crossdem::batch
#endif
