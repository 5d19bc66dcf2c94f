// LIGGGHTS: the law of schemes/liggghts.hpp and laws/liggghts_hooke.hpp, and velocity Verlet.

#include "instruction_sets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch/liggghts.cpp"
#include <hwy/foreach_target.h>

#include "lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace crossdem::batch::HWY_NAMESPACE {

class HookePairLaw {
 public:
  static constexpr bool turn_alike = false;
  static constexpr Signs signs{{1.0, 1.0, -1.0, -1.0}, {-1.0, -1.0, -1.0, 0.0}};
  HookePairLaw(const ContactParameters& parameters, double dt, bool limit_force)
      : k_(parameters), dt_(dt), limit_force_(limit_force) {}

  struct Approach {
    Both both;
    Vector distance_squared;
    Vector distance;
    Vector inverse;  // 1 / distance
  };

  static HWY_INLINE Approach approach(const std::uint32_t* i, const std::uint32_t* j, const Disc* discs) {
    const Both b = both_of(i, j, discs);
    const Vector distance_squared = hn::Add(hn::Mul(b.x, b.x), hn::Mul(b.y, b.y));
    const Vector distance = hn::Sqrt(distance_squared);
    return {b, distance_squared, distance, hn::Div(hn::Set(lanes, 1.0), distance)};
  }

  /// Zero, and nothing remembered, where discs do not touch.
  template <class Memory>
  HWY_INLINE Forces forces(const Approach& a, Memory memory) const {
    const Both& b = a.both;
    const Vector zero = hn::Zero(lanes);
    const Vector dt = hn::Set(lanes, dt_);
    const Vector reach = hn::Add(b.radius_i, b.radius_j);
    const Mask touch = hn::Lt(a.distance_squared, hn::Mul(reach, reach));
    const Vector overlap = hn::Sub(reach, a.distance);
    const Vector half_overlap = hn::Mul(hn::Set(lanes, 0.5), overlap);
    const Vector arm_i = hn::Sub(b.radius_i, half_overlap);
    const Vector arm_j = hn::Sub(b.radius_j, half_overlap);
    const Vector rolling = hn::Add(hn::Mul(arm_i, b.turns_i), hn::Mul(arm_j, b.turns_j));
    const Vector turning = hn::Mul(rolling, a.inverse);
    const Vector normal_x = hn::Mul(b.x, a.inverse);
    const Vector normal_y = hn::Mul(b.y, a.inverse);
    const Vector approach = hn::Add(hn::Mul(b.moves_x, normal_x), hn::Mul(b.moves_y, normal_y));
    const Vector sliding_x = hn::Add(hn::Sub(b.moves_x, hn::Mul(approach, normal_x)), hn::Mul(b.y, turning));
    const Vector sliding_y = hn::Sub(hn::Sub(b.moves_y, hn::Mul(approach, normal_y)), hn::Mul(b.x, turning));
    Vector push = hn::Add(hn::Mul(hn::Set(lanes, -k_.normal_damping), approach),
                          hn::Mul(hn::Set(lanes, k_.normal_stiffness), overlap));
    if (limit_force_) push = hn::IfThenZeroElse(hn::Lt(push, zero), push);

    Vector shear_x = hn::Add(hn::Load(lanes, memory(0)), hn::Mul(sliding_x, dt));
    Vector shear_y = hn::Add(hn::Load(lanes, memory(1)), hn::Mul(sliding_y, dt));
    const Vector off_plane = hn::Add(hn::Mul(shear_x, normal_x), hn::Mul(shear_y, normal_y));
    shear_x = hn::Sub(shear_x, hn::Mul(off_plane, normal_x));
    shear_y = hn::Sub(shear_y, hn::Mul(off_plane, normal_y));
    const Vector stiffness = hn::Set(lanes, -k_.shear_stiffness);
    const Vector damping = hn::Set(lanes, k_.shear_damping);
    const Vector spring_x = hn::Mul(stiffness, shear_x);
    const Vector spring_y = hn::Mul(stiffness, shear_y);
    Vector drag_x = hn::Sub(spring_x, hn::Mul(damping, sliding_x));
    Vector drag_y = hn::Sub(spring_y, hn::Mul(damping, sliding_y));
    // Few contacts slip, and only those that may need the root.
    const Vector cap = hn::Mul(hn::Set(lanes, k_.friction), hn::Abs(push));
    const Vector shear_squared = hn::Add(hn::Mul(shear_x, shear_x), hn::Mul(shear_y, shear_y));
    const Vector spring_squared = hn::Mul(hn::Set(lanes, k_.shear_stiffness * k_.shear_stiffness), shear_squared);
    const Vector surely_held = hn::Mul(hn::Set(lanes, 1.0 - 1e-12), hn::Mul(cap, cap));
    const Mask may_slip = hn::AndNot(hn::Lt(spring_squared, surely_held), touch);
    if (HWY_UNLIKELY(!hn::AllFalse(lanes, may_slip))) {
      const Vector spring = hn::Mul(hn::Neg(stiffness), hn::Sqrt(shear_squared));
      const Mask slips = hn::Gt(spring, cap);
      const Vector share = hn::Div(cap, spring);
      const Vector slipping_x = hn::Mul(spring_x, share);
      const Vector slipping_y = hn::Mul(spring_y, share);
      drag_x = hn::IfThenElse(slips, slipping_x, drag_x);
      drag_y = hn::IfThenElse(slips, slipping_y, drag_y);
      shear_x = hn::IfThenElse(slips, hn::Div(slipping_x, stiffness), shear_x);
      shear_y = hn::IfThenElse(slips, hn::Div(slipping_y, stiffness), shear_y);
    }
    hn::Store(hn::IfThenElseZero(touch, shear_x), lanes, memory(0));
    hn::Store(hn::IfThenElseZero(touch, shear_y), lanes, memory(1));
    const Vector force_x = hn::IfThenElseZero(touch, hn::Add(hn::Mul(push, normal_x), drag_x));
    const Vector force_y = hn::IfThenElseZero(touch, hn::Add(hn::Mul(push, normal_y), drag_y));
    const Vector couple = hn::IfThenElseZero(touch, hn::Sub(hn::Mul(normal_x, drag_y), hn::Mul(normal_y, drag_x)));
    const Vector power =
        hn::Sub(hn::Add(hn::Mul(force_x, b.moves_x), hn::Mul(force_y, b.moves_y)), hn::Mul(couple, rolling));
    return {force_x, force_y, hn::Mul(arm_i, couple), hn::Mul(arm_j, couple), hn::Mul(dt, power)};
  }

 private:
  const ContactParameters& k_;
  double dt_;
  bool limit_force_;
};

void AddLiggghtsForces(std::span<LiggghtsPairs> pairs, const Disc* discs, Load* loads,
                       const ContactParameters& parameters, double dt, bool limit_force) {
  add_pair_forces(HookePairLaw(parameters, dt, limit_force), pairs, discs, loads);
}

/// Between two steps, with the velocities as they are at the end of the first.
HWY_INLINE void set_velocities(Turn<VerletGroup>&, Vector&, Vector) {}

HWY_INLINE void set_velocities(Turn<SetVelocitiesGroup>& t, Vector& spin, Vector dt) {
  const Vector half = hn::Set(lanes, 0.5);
  const auto set = [&](Vector& velocity, Vector load, const Column& mass, Column& rate_before) HWY_ATTR {
    const Vector rate = hn::Sub(velocity, hn::Div(hn::Mul(hn::Mul(half, dt), load), t.of(mass)));
    velocity = hn::Sub(hn::Mul(hn::Set(lanes, 1.5), rate), hn::Mul(half, t.of(rate_before)));
    t.put(rate_before, rate);
  };
  set(t.moves_x, t.force_x, t.group.mass, t.group.rate_before_x);
  set(t.moves_y, t.force_y, t.group.mass, t.group.rate_before_y);
  set(spin, t.turning, t.group.inertia, t.group.turning_before);
}

template <class AnyGroup>
HWY_INLINE Moved kick_and_drift(std::size_t particles, AnyGroup* groups, Disc* discs, Load* loads, double step) {
  const Vector dt = hn::Set(lanes, step);
  Largest farthest(particles);
  Largest stride(particles);
  Largest marked(particles);
  for (std::size_t i = 0; i < particles; i += count) {
    Turn<AnyGroup> t(i, groups, discs, loads);
    AnyGroup& group = t.group;
    t.force_y = hn::Sub(t.force_y, t.of(group.weight));
    const Vector push = t.of(group.push);
    const Vector kick_x = hn::Mul(push, t.force_x);
    const Vector kick_y = hn::Mul(push, t.force_y);
    const Vector turn = hn::Mul(t.of(group.turn), t.turning);
    t.moves_x = hn::Add(t.moves_x, kick_x);
    t.moves_y = hn::Add(t.moves_y, kick_y);
    Vector spin = hn::Add(t.of(group.spin), turn);
    set_velocities(t, spin, dt);
    t.moves_x = hn::Add(t.moves_x, kick_x);
    t.moves_y = hn::Add(t.moves_y, kick_y);
    spin = hn::Add(spin, turn);
    t.put(group.spin, spin);
    const Vector displacement_x = hn::Mul(dt, t.moves_x);
    const Vector displacement_y = hn::Mul(dt, t.moves_y);
    t.x = hn::Add(t.x, displacement_x);
    t.y = hn::Add(t.y, displacement_y);
    t.increase(group.angle, hn::Mul(dt, spin));
    t.finish([&group](std::size_t k, double) { return group.spin[k]; });
    farthest.include(i, t.squared_way_from(group.listed_x, group.listed_y));
    stride.include(i, hn::Add(hn::Mul(displacement_x, displacement_x), hn::Mul(displacement_y, displacement_y)));
    marked.include(i, t.squared_way_from(group.marked_x, group.marked_y));
  }
  return {farthest.value(), stride.value(), marked.value()};
}

Moved MoveVerlet(std::size_t particles, VerletGroup* groups, Disc* discs, Load* loads, double dt) {
  return kick_and_drift(particles, groups, discs, loads, dt);
}

Moved MoveSetVelocities(std::size_t particles, SetVelocitiesGroup* groups, Disc* discs, Load* loads, double dt) {
  return kick_and_drift(particles, groups, discs, loads, dt);
}

}  // namespace crossdem::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossdem::batch {

HWY_EXPORT(AddLiggghtsForces);
HWY_EXPORT(MoveVerlet);
HWY_EXPORT(MoveSetVelocities);

void add_liggghts_forces(std::span<LiggghtsPairs> pairs, const Disc* discs, Load* loads,
                         const ContactParameters& parameters, double dt, bool limit_force) {
  HWY_DYNAMIC_DISPATCH(AddLiggghtsForces)(pairs, discs, loads, parameters, dt, limit_force);
}

Moved move_verlet(std::size_t particles, VerletGroup* groups, Disc* discs, Load* loads, double dt) {
  return HWY_DYNAMIC_DISPATCH(MoveVerlet)(particles, groups, discs, loads, dt);
}

Moved move_verlet(std::size_t particles, SetVelocitiesGroup* groups, Disc* discs, Load* loads, double dt) {
  return HWY_DYNAMIC_DISPATCH(MoveSetVelocities)(particles, groups, discs, loads, dt);
}

}  // namespace crossdem::batch
#endif
