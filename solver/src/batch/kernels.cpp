#include "kernels.hpp"

#include <stdexcept>
#include <string>

// Highway compiles what follows once for each set of instructions, and chooses when the program starts. Vectors of
// arm64 whose length is not known here cannot be members of a struct: there it is Neon that is used.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch/kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crossdem::batch::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, width>;
using Vector = hn::Vec<Lanes>;
using Mask = hn::Mask<Lanes>;
constexpr Lanes lanes;
constexpr std::size_t count = hn::MaxLanes(lanes);

// Rows of four doubles, one per pair or particle, and the same as four columns.
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
using HalfLine = hn::CappedTag<double, 4>;
constexpr HalfLine half_line;
constexpr std::size_t upper = count - 4;  // with eight lanes a vector holds two rows, the one of lane k and of k + 4

HWY_INLINE void transpose(Vector& a, Vector& b, Vector& c, Vector& d) {
  const Vector ab_even = hn::InterleaveLower(lanes, a, b);
  const Vector ab_odd = hn::InterleaveUpper(lanes, a, b);
  const Vector cd_even = hn::InterleaveLower(lanes, c, d);
  const Vector cd_odd = hn::InterleaveUpper(lanes, c, d);
  a = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(cd_even), ab_even);
  b = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(cd_odd), ab_odd);
  c = hn::OddEvenBlocks(cd_even, hn::SwapAdjacentBlocks(ab_even));
  d = hn::OddEvenBlocks(cd_odd, hn::SwapAdjacentBlocks(ab_odd));
}

HWY_INLINE Vector load_rows(const double* row, const double* upper_row) {
#if HWY_TARGET == HWY_AVX2
  (void)upper_row;
  return hn::Load(lanes, row);
#else
  return hn::Combine(lanes, hn::Load(half_line, upper_row), hn::Load(half_line, row));
#endif
}

HWY_INLINE void store_rows(Vector rows, double* row, double* upper_row) {
#if HWY_TARGET == HWY_AVX2
  (void)upper_row;
  hn::Store(rows, lanes, row);
#else
  hn::Store(hn::LowerHalf(half_line, rows), half_line, row);
  hn::Store(hn::UpperHalf(half_line, rows), half_line, upper_row);
#endif
}

/// The row of lane k is at row_of(k).
template <class RowOf>
HWY_INLINE void load_columns(RowOf row_of, Vector& a, Vector& b, Vector& c, Vector& d) {
  a = load_rows(row_of(0), row_of(0 + upper));
  b = load_rows(row_of(1), row_of(1 + upper));
  c = load_rows(row_of(2), row_of(2 + upper));
  d = load_rows(row_of(3), row_of(3 + upper));
  transpose(a, b, c, d);
}

template <class RowOf>
HWY_INLINE void store_columns(Vector a, Vector b, Vector c, Vector d, RowOf row_of) {
  transpose(a, b, c, d);
  store_rows(a, row_of(0), row_of(0 + upper));
  store_rows(b, row_of(1), row_of(1 + upper));
  store_rows(c, row_of(2), row_of(2 + upper));
  store_rows(d, row_of(3), row_of(3 + upper));
}
#else
template <class RowOf>
HWY_INLINE void load_columns(RowOf row_of, Vector& a, Vector& b, Vector& c, Vector& d) {
  alignas(64) std::array<std::array<double, count>, 4> columns;
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t column = 0; column < 4; ++column) columns[column][k] = row_of(k)[column];
  a = hn::Load(lanes, columns[0].data());
  b = hn::Load(lanes, columns[1].data());
  c = hn::Load(lanes, columns[2].data());
  d = hn::Load(lanes, columns[3].data());
}

template <class RowOf>
HWY_INLINE void store_columns(Vector a, Vector b, Vector c, Vector d, RowOf row_of) {
  alignas(64) std::array<std::array<double, count>, 4> columns;
  hn::Store(a, lanes, columns[0].data());
  hn::Store(b, lanes, columns[1].data());
  hn::Store(c, lanes, columns[2].data());
  hn::Store(d, lanes, columns[3].data());
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t column = 0; column < 4; ++column) row_of(k)[column] = columns[column][k];
}
#endif

/// j minus i of a batch of pairs, and what of both is added.
struct Between {
  Vector x;      // [m]
  Vector y;      // [m]
  Vector dx;     // [m], displacements of the last step
  Vector dy;     // [m]
  Vector roll;   // [m], i plus j
  Vector reach;  // [m], i plus j
};

#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
/// Whole discs, a line each: i times minus one or one is exact, and so is the sum what Sub and Add give.
HWY_INLINE Between between(const std::uint32_t* i, const std::uint32_t* j, const Disc* discs) {
  alignas(64) constexpr std::array<double, count> signs{-1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0};
  const Vector sign = hn::Load(lanes, signs.data());
  const auto line = [&](std::size_t k) HWY_ATTR {
    return hn::MulAdd(hn::Load(lanes, &discs[i[k]].x), sign, hn::Load(lanes, &discs[j[k]].x));
  };
  // Of lines 2 k and 2 k + 1 in turn: even are x, dx, roll, odd are y, dy, reach, side by side.
  const std::array<Vector, count> d{line(0), line(1), line(2), line(3), line(4), line(5), line(6), line(7)};
  const auto columns = [&](const std::array<Vector, 4>& pairs, Vector& first, Vector& second, Vector& third) HWY_ATTR {
    const auto [a, b, c, e] = pairs;
    const Vector low = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b), a);
    const Vector high = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(e), c);
    first = hn::ConcatLowerLower(lanes, high, low);
    third = hn::ConcatUpperUpper(lanes, high, low);
    second = hn::ConcatLowerLower(lanes, hn::OddEvenBlocks(e, hn::SwapAdjacentBlocks(c)),
                                  hn::OddEvenBlocks(b, hn::SwapAdjacentBlocks(a)));
  };
  const auto even = [&](std::size_t k) HWY_ATTR { return hn::InterleaveLower(lanes, d[k], d[k + 1]); };
  const auto odd = [&](std::size_t k) HWY_ATTR { return hn::InterleaveUpper(lanes, d[k], d[k + 1]); };
  Vector x;
  Vector y;
  Vector dx;
  Vector dy;
  Vector roll;
  Vector reach;
  columns({even(0), even(2), even(4), even(6)}, x, dx, roll);
  columns({odd(0), odd(2), odd(4), odd(6)}, y, dy, reach);
  return {x, y, dx, dy, roll, reach};
}
#else
HWY_INLINE Between between(const std::uint32_t* i, const std::uint32_t* j, const Disc* discs) {
  const auto first = [&](const std::uint32_t* of) {
    return [discs, of](std::size_t k) HWY_ATTR { return &discs[of[k]].x; };
  };
  const auto second = [&](const std::uint32_t* of) {
    return [discs, of](std::size_t k) HWY_ATTR { return &discs[of[k]].roll; };
  };
  Vector xi;
  Vector yi;
  Vector dxi;
  Vector dyi;
  Vector x;
  Vector y;
  Vector dx;
  Vector dy;
  load_columns(first(i), xi, yi, dxi, dyi);
  load_columns(first(j), x, y, dx, dy);
  x = hn::Sub(x, xi);
  y = hn::Sub(y, yi);
  dx = hn::Sub(dx, dxi);
  dy = hn::Sub(dy, dyi);
  Vector roll_i;
  Vector radius_i;
  Vector roll;
  Vector reach;
  load_columns(second(i), roll_i, radius_i, xi, yi);
  load_columns(second(j), roll, reach, xi, yi);
  return {x, y, dx, dy, hn::Add(roll, roll_i), hn::Add(reach, radius_i)};
}
#endif

/// Discs that may touch.
struct Approach {
  Between between;
  Vector distance_squared;
  Vector inverse;  // 1 / distance
};

HWY_INLINE Approach approach(const std::uint32_t* i, const std::uint32_t* j, const Disc* discs) {
  Approach a{between(i, j, discs), hn::Zero(lanes), hn::Zero(lanes)};
  const Between& b = a.between;
  a.distance_squared = hn::Add(hn::Mul(b.x, b.x), hn::Mul(b.y, b.y));
  a.inverse = hn::Div(hn::Set(lanes, 1.0), hn::Sqrt(a.distance_squared));
  return a;
}

struct Forces {
  Vector x;      // on j
  Vector y;      // on j
  Vector shear;  // f_s
  Vector work;
};

/// Eqs. (1), (2), TanakaLaw<DefaultReadings>::force, and Eqs. (10), (11); zero where discs do not touch.
HWY_INLINE Forces forces(const Approach& a, const ContactParameters& p, double dt, double* normal_spring,
                         double* shear_spring) {
  const Between& b = a.between;
  const Vector zero = hn::Zero(lanes);
  const Vector normal_x = hn::Mul(b.x, a.inverse);
  const Vector normal_y = hn::Mul(b.y, a.inverse);
  const Vector u_n = hn::Neg(hn::Add(hn::Mul(b.dx, normal_x), hn::Mul(b.dy, normal_y)));
  const Vector u_s = hn::Add(hn::Sub(hn::Mul(b.dx, normal_y), hn::Mul(b.dy, normal_x)), b.roll);
  const Mask touch = hn::Lt(a.distance_squared, hn::Mul(b.reach, b.reach));
  Vector e_n = hn::Load(lanes, normal_spring);
  Vector e_s = hn::Load(lanes, shear_spring);
  Vector du_n = u_n;
  Vector du_s = u_s;
  const Mask first = hn::And(touch, hn::Lt(e_n, zero));
  if (HWY_UNLIKELY(!hn::AllFalse(lanes, first))) {  // Eqs. (3), (4)
    const Vector overlap = hn::Sub(b.reach, hn::Sqrt(a.distance_squared));
    const Vector share = hn::IfThenElseZero(hn::Gt(du_n, zero), hn::Min(hn::Div(overlap, du_n), hn::Set(lanes, 1.0)));
    du_s = hn::IfThenElse(first, hn::Mul(du_s, share), du_s);
    du_n = hn::IfThenElse(first, overlap, du_n);
    e_n = hn::IfThenElse(first, zero, e_n);
    e_s = hn::IfThenElse(first, zero, e_s);
  }
  e_n = hn::Add(e_n, hn::Mul(hn::Set(lanes, p.normal_stiffness), du_n));  // Eq. (5)
  const Mask acts = hn::AndNot(hn::Lt(e_n, zero), touch);                 // Eq. (8)
  const Vector dashpot_n = hn::Mul(hn::Set(lanes, p.normal_damping / dt), du_n);
  const Vector dashpot_s = hn::Mul(hn::Set(lanes, p.shear_damping / dt), du_s);
  e_s = hn::Add(e_s, hn::Mul(hn::Set(lanes, p.shear_stiffness), du_s));
  const Vector slip_force = hn::Mul(hn::Set(lanes, p.friction), e_n);
  const Mask slips = hn::Gt(hn::Abs(e_s), slip_force);
  const Vector slipping = hn::CopySign(slip_force, e_s);                                                  // Eq. (9)
  const Vector f_n = hn::IfThenElseZero(acts, hn::Add(e_n, dashpot_n));                                   // Eq. (6)
  const Vector f_s = hn::IfThenElseZero(acts, hn::IfThenElse(slips, slipping, hn::Add(e_s, dashpot_s)));  // Eq. (7)
  hn::Store(hn::IfThenElse(acts, e_n, hn::Set(lanes, not_touching)), lanes, normal_spring);
  hn::Store(hn::IfThenElseZero(acts, hn::IfThenElse(slips, slipping, e_s)), lanes, shear_spring);
  return {hn::Sub(hn::Mul(f_n, normal_x), hn::Mul(f_s, normal_y)),
          hn::Add(hn::Mul(f_n, normal_y), hn::Mul(f_s, normal_x)), f_s, hn::Add(hn::Mul(f_n, u_n), hn::Mul(f_s, u_s))};
}

/// Pair after pair: i receives the opposite of j, and the work.
HWY_INLINE void add(Forces f, const std::uint32_t* i, const std::uint32_t* j, Load* loads) {
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
  alignas(32) constexpr std::array<double, 4> signs_i{-1.0, -1.0, 1.0, 1.0};
  alignas(32) constexpr std::array<double, 4> signs_j{1.0, 1.0, 1.0, 0.0};
  const auto on_i = hn::Load(half_line, signs_i.data());
  const auto on_j = hn::Load(half_line, signs_j.data());
  const auto add_row = [&](hn::Vec<HalfLine> row, std::size_t k) HWY_ATTR {
    double* load_i = &loads[i[k]].force_x;
    hn::Store(hn::MulAdd(row, on_i, hn::Load(half_line, load_i)), half_line, load_i);
    double* load_j = &loads[j[k]].force_x;
    hn::Store(hn::MulAdd(row, on_j, hn::Load(half_line, load_j)), half_line, load_j);
  };
  transpose(f.x, f.y, f.shear, f.work);
  const std::array<Vector, 4> rows{f.x, f.y, f.shear, f.work};
#if HWY_TARGET == HWY_AVX2
  for (std::size_t k = 0; k < count; ++k) add_row(rows[k], k);
#else
  for (std::size_t k = 0; k < upper; ++k) add_row(hn::LowerHalf(half_line, rows[k]), k);
  for (std::size_t k = 0; k < upper; ++k) add_row(hn::UpperHalf(half_line, rows[k]), k + upper);
#endif
#else
  alignas(64) std::array<Load, count> on_j;
  store_columns(f.x, f.y, f.shear, f.work, [&](std::size_t k) HWY_ATTR { return &on_j[k].force_x; });
  for (std::size_t k = 0; k < count; ++k) {
    Load& load_i = loads[i[k]];
    load_i = {load_i.force_x - on_j[k].force_x, load_i.force_y - on_j[k].force_y, load_i.rim + on_j[k].rim,
              load_i.work + on_j[k].work};
    Load& load_j = loads[j[k]];
    load_j = {load_j.force_x + on_j[k].force_x, load_j.force_y + on_j[k].force_y, load_j.rim + on_j[k].rim,
              load_j.work};
  }
#endif
}

/// A turn of the loop looks at one batch, takes the forces of the batch before it and adds those of the one before
/// that: none of the three waits for another, where one batch after the other would wait for each root, division and
/// sum.
void AddPairForces(std::span<Pairs> batches, const Disc* discs, Load* loads, const ContactParameters& parameters,
                   double dt) {
  constexpr std::size_t parts = width / count;  // of a batch, each a turn
  const std::size_t turns = parts * batches.size();
  if (turns == 0) return;
  const auto i = [&](std::size_t turn) { return batches[turn / parts].i.data() + count * (turn % parts); };
  const auto j = [&](std::size_t turn) { return batches[turn / parts].j.data() + count * (turn % parts); };
  const auto look = [&](std::size_t turn) HWY_ATTR { return approach(i(turn), j(turn), discs); };
  const auto take = [&](const Approach& near, std::size_t turn) HWY_ATTR {
    Pairs& batch = batches[turn / parts];
    const std::size_t begin = count * (turn % parts);
    return forces(near, parameters, dt, batch.normal_spring.data() + begin, batch.shear_spring.data() + begin);
  };
  const auto give = [&](const Forces& found, std::size_t turn) HWY_ATTR { add(found, i(turn), j(turn), loads); };

  Forces found = take(look(0), 0);
  if (turns > 1) {
    Approach near = look(1);
    for (std::size_t turn = 2; turn < turns; ++turn) {
      const Approach next_near = look(turn);
      const Forces next_found = take(near, turn - 1);
      give(found, turn - 2);
      near = next_near;
      found = next_found;
    }
    give(found, turns - 2);
    found = take(near, turns - 1);
  }
  give(found, turns - 1);
}

/// Of `count` particles; the work stays.
HWY_INLINE void forget_forces(Load* loads) {
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
  alignas(64) constexpr std::array<double, 8> members{1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0};
  const Mask forces = hn::Ne(hn::Load(lanes, members.data()), hn::Zero(lanes));
  double* row = &loads->force_x;
  for (std::size_t k = 0; k < 4; ++k) hn::BlendedStore(hn::Zero(lanes), forces, lanes, row + k * count);
#else
  for (std::size_t k = 0; k < count; ++k) loads[k] = {0.0, 0.0, 0.0, loads[k].work};
#endif
}

Moved Move(std::size_t particles, Group* groups, Disc* discs, Load* loads, double gravity, double step) {
  const Vector dt = hn::Set(lanes, step);
  const Vector fall = hn::Set(lanes, gravity * step);
  const Vector half = hn::Set(lanes, 0.5);
  Vector farthest = hn::Zero(lanes);
  Vector stride = hn::Zero(lanes);
  for (std::size_t i = 0; i < particles; i += count) {
    Group& group = groups[i / width];
    const std::size_t begin = i % width;
    Disc* disc = discs + i;
    Load* load = loads + i;
    const auto of = [begin](const Column& column) HWY_ATTR { return hn::Load(lanes, column.data() + begin); };
    const auto update = [begin, &of](Column& column, Vector added) HWY_ATTR {
      const Vector sum = hn::Add(of(column), added);
      hn::Store(sum, lanes, column.data() + begin);
      return sum;
    };
    Vector x;
    Vector y;
    Vector dx;
    Vector dy;
    Vector force_x;
    Vector force_y;
    Vector rim;
    Vector work;
    load_columns([&](std::size_t k) HWY_ATTR { return &disc[k].x; }, x, y, dx, dy);
    load_columns([&](std::size_t k) HWY_ATTR { return &load[k].force_x; }, force_x, force_y, rim, work);
    forget_forces(load);
    const Vector push = of(group.push);
    const Vector vx = update(group.velocity_x, hn::Mul(force_x, push));                     // Eqs. (13), (16)
    const Vector vy = update(group.velocity_y, hn::Sub(hn::Mul(force_y, push), fall));      // Eqs. (14), (17)
    const Vector spin = update(group.spin, hn::Neg(hn::Mul(rim, of(group.turn))));          // Eqs. (12), (15), (18)
    dx = hn::Mul(half, hn::Add(dx, hn::Mul(vx, dt)));                                       // Eq. (19)
    dy = hn::Mul(half, hn::Add(dy, hn::Mul(vy, dt)));                                       // Eq. (20)
    const Vector rotation = hn::Mul(half, hn::Add(of(group.rotation), hn::Mul(spin, dt)));  // Eq. (21)
    hn::Store(rotation, lanes, group.rotation.data() + begin);
    x = hn::Add(x, dx);             // Eq. (22)
    y = hn::Add(y, dy);             // Eq. (23)
    update(group.angle, rotation);  // Eq. (24)
    store_columns(x, y, dx, dy, [&](std::size_t k) HWY_ATTR { return &disc[k].x; });
    for (std::size_t k = 0; k < count; ++k) disc[k].roll = disc[k].radius * group.rotation[begin + k];
    const Vector away_x = hn::Sub(x, of(group.listed_x));
    const Vector away_y = hn::Sub(y, of(group.listed_y));
    const Vector away_squared = hn::Add(hn::Mul(away_x, away_x), hn::Mul(away_y, away_y));
    const Vector stride_squared = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const Mask real = hn::FirstN(lanes, particles - i);
    farthest = hn::Max(farthest, hn::IfThenElseZero(real, away_squared));
    stride = hn::Max(stride, hn::IfThenElseZero(real, stride_squared));
  }
  return {hn::GetLane(hn::MaxOfLanes(lanes, farthest)), hn::GetLane(hn::MaxOfLanes(lanes, stride))};
}

std::string_view InstructionSet() { return hwy::TargetName(HWY_TARGET); }

}  // namespace crossdem::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crossdem::batch {
namespace {

HWY_EXPORT(AddPairForces);
HWY_EXPORT(Move);
HWY_EXPORT(InstructionSet);

/// Compiled, and to be had on this machine; a better one has a lower bit.
std::vector<std::int64_t> targets() {
  static const std::int64_t both = hwy::SupportedTargets() & HWY_TARGETS;
  std::vector<std::int64_t> found;
  for (std::int64_t left = both; left != 0; left &= left - 1) found.push_back(left & -left);
  return found;
}

}  // namespace

void add_pair_forces(std::span<Pairs> pairs, const Disc* discs, Load* loads, const ContactParameters& parameters,
                     double dt) {
  HWY_DYNAMIC_DISPATCH(AddPairForces)(pairs, discs, loads, parameters, dt);
}

Moved move(std::size_t particles, Group* groups, Disc* discs, Load* loads, double gravity, double dt) {
  return HWY_DYNAMIC_DISPATCH(Move)(particles, groups, discs, loads, gravity, dt);
}

std::string_view instruction_set() { return HWY_DYNAMIC_DISPATCH(InstructionSet)(); }

std::vector<std::string_view> instruction_sets() {
  std::vector<std::string_view> names;
  for (const std::int64_t target : targets()) names.emplace_back(hwy::TargetName(target));
  return names;
}

void use_instruction_set(std::string_view name) {
  for (const std::int64_t target : targets()) {
    if (name != hwy::TargetName(target)) continue;
    hwy::GetChosenTarget().Update(target);
    return;
  }
  throw std::invalid_argument("no instruction set \"" + std::string(name) + "\" here");
}

}  // namespace crossdem::batch
#endif
