// The paper's scheme: the law of step.hpp and laws/tanaka.hpp, the motion of integrators.hpp.

#include "instruction_sets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch/tanaka.cpp"
#include <hwy/foreach_target.h>

#include "../contact_law.hpp"
#include "lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace crossdem::batch::HWY_NAMESPACE {

/// `joins`: whether particles hold together up to a strength T > 0; `rolls`: whether springs resist their rolling.
template <bool joins, bool rolls>
class TanakaPairLaw {
 public:
  static constexpr bool turn_alike = !rolls;
  static constexpr Signs signs{{-1.0, -1.0, 1.0, 1.0}, {1.0, 1.0, 1.0, 0.0}};
  TanakaPairLaw(const ContactParameters& parameters, double dt) : p_(parameters), dt_(dt) {}

  /// j minus i; of rotation and radius the sum.
  struct Approach {
    Columns between;
    Vector distance_squared;
    Vector inverse;  // 1 / distance
    // Where they roll, what Step::pair_force says of it.
    Vector rolling_lever_i;
    Vector rolling_lever_j;
    Vector rolling;  // [m]
  };

  static HWY_INLINE Approach approach(const std::uint32_t* i, const std::uint32_t* j, const Disc* discs) {
    const Vector zero = hn::Zero(lanes);
    Approach a{{zero, zero, zero, zero, zero, zero}, zero, zero, zero, zero, zero};
    if constexpr (rolls)
      take_rolling(both_of(i, j, discs), a);
    else
      a.between = between(i, j, discs);
    const Columns& b = a.between;
    a.distance_squared = hn::Add(hn::Mul(b.x, b.x), hn::Mul(b.y, b.y));
    a.inverse = hn::Div(hn::Set(lanes, 1.0), hn::Sqrt(a.distance_squared));
    return a;
  }

  /// Eqs. (1), (2), TanakaLaw<DefaultReadings>::force, and Eqs. (10), (11); zero where discs do not touch.
  template <class Memory>
  HWY_INLINE Forces forces(const Approach& a, Memory memory) const {
    const Columns& b = a.between;
    double* normal_spring = memory(0);
    double* shear_spring = memory(1);
    const Vector zero = hn::Zero(lanes);
    const Vector normal_x = hn::Mul(b.x, a.inverse);
    const Vector normal_y = hn::Mul(b.y, a.inverse);
    const Vector u_n = hn::Neg(hn::Add(hn::Mul(b.moves_x, normal_x), hn::Mul(b.moves_y, normal_y)));
    const Vector u_s = hn::Add(hn::Sub(hn::Mul(b.moves_x, normal_y), hn::Mul(b.moves_y, normal_x)), b.turns);
    Vector e_n = hn::Load(lanes, normal_spring);
    Vector e_s = hn::Load(lanes, shear_spring);
    Vector du_n = u_n;
    Vector du_s = u_s;
    const Mask apart = joins ? hn::Eq(e_n, hn::Set(lanes, not_touching)) : hn::Lt(e_n, zero);
    Vector reach = b.radius;
    if constexpr (joins) reach = hn::IfThenElse(apart, reach, hn::Add(reach, hn::Set(lanes, p_.joint_stretch())));
    const Mask touch = hn::Lt(a.distance_squared, hn::Mul(reach, reach));
    const Mask first = hn::And(touch, apart);
    if (HWY_UNLIKELY(!hn::AllFalse(lanes, first))) {  // Eqs. (3), (4)
      const Vector overlap = hn::Sub(b.radius, hn::Sqrt(a.distance_squared));
      const Vector share = hn::IfThenElseZero(hn::Gt(du_n, zero), hn::Min(hn::Div(overlap, du_n), hn::Set(lanes, 1.0)));
      du_s = hn::IfThenElse(first, hn::Mul(du_s, share), du_s);
      du_n = hn::IfThenElse(first, overlap, du_n);
      e_n = hn::IfThenElse(first, zero, e_n);
      e_s = hn::IfThenElse(first, zero, e_s);
    }
    e_n = hn::Add(e_n, hn::Mul(hn::Set(lanes, p_.normal_stiffness), du_n));  // Eq. (5)
    const Vector strength = joins ? hn::Set(lanes, p_.tensile_strength) : zero;
    const Mask acts = hn::AndNot(hn::Lt(e_n, hn::Neg(strength)), touch);  // Eq. (8)
    const Vector dashpot_n = hn::Mul(hn::Set(lanes, p_.normal_damping / dt_), du_n);
    const Vector dashpot_s = hn::Mul(hn::Set(lanes, p_.shear_damping / dt_), du_s);
    e_s = hn::Add(e_s, hn::Mul(hn::Set(lanes, p_.shear_stiffness), du_s));
    const Vector pressed = joins ? hn::Add(e_n, strength) : e_n;
    const Vector slip_force = hn::Mul(hn::Set(lanes, p_.friction), pressed);
    const Mask slips = hn::Gt(hn::Abs(e_s), slip_force);
    const Vector slipping = hn::CopySign(slip_force, e_s);                                                  // Eq. (9)
    const Vector f_n = hn::IfThenElseZero(acts, hn::Add(e_n, dashpot_n));                                   // Eq. (6)
    const Vector f_s = hn::IfThenElseZero(acts, hn::IfThenElse(slips, slipping, hn::Add(e_s, dashpot_s)));  // Eq. (7)
    hn::Store(hn::IfThenElse(acts, e_n, hn::Set(lanes, not_touching)), lanes, normal_spring);
    hn::Store(hn::IfThenElseZero(acts, hn::IfThenElse(slips, slipping, e_s)), lanes, shear_spring);
    Forces f{hn::Sub(hn::Mul(f_n, normal_x), hn::Mul(f_s, normal_y)),
             hn::Add(hn::Mul(f_n, normal_y), hn::Mul(f_s, normal_x)), f_s, f_s,
             hn::Add(hn::Mul(f_n, u_n), hn::Mul(f_s, u_s))};
    if constexpr (rolls) add_rolling(a, memory(2), first, acts, pressed, f);
    return f;
  }

 private:
  static HWY_INLINE void take_rolling(const Both& b, Approach& a) {
    const Vector reach = hn::Add(b.radius_i, b.radius_j);
    a.between = {hn::Neg(b.x), hn::Neg(b.y), hn::Neg(b.moves_x), hn::Neg(b.moves_y), hn::Add(b.turns_i, b.turns_j),
                 reach};
    a.rolling_lever_i = hn::Div(b.radius_j, reach);
    a.rolling_lever_j = hn::Div(b.radius_i, reach);
    a.rolling = hn::Sub(hn::Mul(a.rolling_lever_i, b.turns_i), hn::Mul(a.rolling_lever_j, b.turns_j));
  }

  /// The spring against rolling, in its memory and in the forces `f`.
  HWY_INLINE void add_rolling(const Approach& a, double* rolling_spring, Mask first, Mask acts, Vector pressed,
                              Forces& f) const {
    Vector e_r = hn::IfThenZeroElse(first, hn::Load(lanes, rolling_spring));
    e_r = hn::Add(e_r, hn::Mul(hn::Set(lanes, p_.shear_stiffness), a.rolling));
    const Vector cap = hn::Mul(hn::Set(lanes, p_.rolling_friction), pressed);
    e_r = hn::IfThenElse(hn::Gt(hn::Abs(e_r), cap), hn::CopySign(cap, e_r), e_r);
    const Vector f_r = hn::IfThenElseZero(acts, e_r);
    hn::Store(f_r, lanes, rolling_spring);
    f.turning_i = hn::Add(f.turning_i, hn::Mul(a.rolling_lever_i, f_r));
    f.turning_j = hn::Sub(f.turning_j, hn::Mul(a.rolling_lever_j, f_r));
    f.work = hn::Add(f.work, hn::Mul(f_r, a.rolling));
  }

#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
  /// i times minus one or one is exact, and so is the sum what Sub and Add give.
  static HWY_INLINE Columns between(const std::uint32_t* i, const std::uint32_t* j, const Disc* discs) {
    alignas(64) constexpr std::array<double, count> signs{-1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0};
    const Vector sign = hn::Load(lanes, signs.data());
    return columns_of([&](std::size_t k) HWY_ATTR {
      return hn::MulAdd(hn::Load(lanes, &discs[i[k]].x), sign, hn::Load(lanes, &discs[j[k]].x));
    });
  }
#else
  static HWY_INLINE Columns between(const std::uint32_t* i, const std::uint32_t* j, const Disc* discs) {
    Columns of_i{};
    Columns c = minus(i, j, discs, of_i);
    c.turns = hn::Add(c.turns, of_i.turns);
    c.radius = hn::Add(c.radius, of_i.radius);
    return c;
  }
#endif

  const ContactParameters& p_;
  double dt_;
};

template <bool rolls, class Batch>
void add_forces(std::span<Batch> pairs, const Disc* discs, Load* loads, const ContactParameters& parameters,
                double dt) {
  if (parameters.tensile_strength > 0.0)
    add_pair_forces(TanakaPairLaw<true, rolls>(parameters, dt), pairs, discs, loads);
  else
    add_pair_forces(TanakaPairLaw<false, rolls>(parameters, dt), pairs, discs, loads);
}

void AddTanakaForces(std::span<TanakaPairs> pairs, const Disc* discs, Load* loads, const ContactParameters& parameters,
                     double dt) {
  add_forces<false>(pairs, discs, loads, parameters, dt);
}

void AddRollingForces(std::span<RollingPairs> pairs, const Disc* discs, Load* loads,
                      const ContactParameters& parameters, double dt) {
  add_forces<true>(pairs, discs, loads, parameters, dt);
}

Moved MoveAveraged(std::size_t particles, AveragedGroup* groups, Disc* discs, Load* loads, double gravity,
                   double step) {
  const Vector dt = hn::Set(lanes, step);
  const Vector fall = hn::Set(lanes, gravity * step);
  const Vector half = hn::Set(lanes, 0.5);
  Largest farthest(particles);
  Largest stride(particles);
  for (std::size_t i = 0; i < particles; i += count) {
    Turn<AveragedGroup> t(i, groups, discs, loads);
    AveragedGroup& group = t.group;
    const Vector push = t.of(group.push);
    const Vector vx = t.increase(group.velocity_x, hn::Mul(t.force_x, push));                   // Eqs. (13), (16)
    const Vector vy = t.increase(group.velocity_y, hn::Sub(hn::Mul(t.force_y, push), fall));    // Eqs. (14), (17)
    const Vector spin = t.increase(group.spin, hn::Neg(hn::Mul(t.turning, t.of(group.turn))));  // Eqs. (12), (15), (18)
    t.moves_x = hn::Mul(half, hn::Add(t.moves_x, hn::Mul(vx, dt)));                             // Eq. (19)
    t.moves_y = hn::Mul(half, hn::Add(t.moves_y, hn::Mul(vy, dt)));                             // Eq. (20)
    const Vector rotation = hn::Mul(half, hn::Add(t.of(group.rotation), hn::Mul(spin, dt)));    // Eq. (21)
    t.put(group.rotation, rotation);
    t.x = hn::Add(t.x, t.moves_x);      // Eq. (22)
    t.y = hn::Add(t.y, t.moves_y);      // Eq. (23)
    t.increase(group.angle, rotation);  // Eq. (24)
    t.finish([&group](std::size_t k, double radius) { return radius * group.rotation[k]; });
    farthest.include(i, t.squared_way_from(group.listed_x, group.listed_y));
    stride.include(i, hn::Add(hn::Mul(t.moves_x, t.moves_x), hn::Mul(t.moves_y, t.moves_y)));
  }
  return {.farthest_squared = farthest.value(), .stride_squared = stride.value()};
}

}  // namespace crossdem::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossdem::batch {

HWY_EXPORT(AddTanakaForces);
HWY_EXPORT(AddRollingForces);
HWY_EXPORT(MoveAveraged);

void add_tanaka_forces(std::span<TanakaPairs> pairs, const Disc* discs, Load* loads,
                       const ContactParameters& parameters, double dt) {
  HWY_DYNAMIC_DISPATCH(AddTanakaForces)(pairs, discs, loads, parameters, dt);
}

void add_tanaka_forces(std::span<RollingPairs> pairs, const Disc* discs, Load* loads,
                       const ContactParameters& parameters, double dt) {
  HWY_DYNAMIC_DISPATCH(AddRollingForces)(pairs, discs, loads, parameters, dt);
}

Moved move_averaged(std::size_t particles, AveragedGroup* groups, Disc* discs, Load* loads, double gravity, double dt) {
  return HWY_DYNAMIC_DISPATCH(MoveAveraged)(particles, groups, discs, loads, gravity, dt);
}

}  // namespace crossdem::batch
#endif
