#include "kernels.hpp"

#include <stdexcept>
#include <string>

// Highway compiles what follows once for each set of instructions, and chooses when the program starts.
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

/// Pairs whose discs may touch: direction from i to j, and Eqs. (1), (2).
struct Approach {
  Vector normal_x;
  Vector normal_y;
  Vector normal;   // [m], du_n
  Vector shear;    // [m], du_s
  Vector overlap;  // [m]
  Vector radius_i;
  Vector radius_j;
  Mask touch;
};

HWY_INLINE Approach approach(const std::uint32_t* i, const std::uint32_t* j, const Disc* discs) {
  Vector xi;
  Vector yi;
  Vector dxi;
  Vector dyi;
  Vector xj;
  Vector yj;
  Vector dxj;
  Vector dyj;
  load_columns([&](std::size_t k) HWY_ATTR { return &discs[i[k]].x; }, xi, yi, dxi, dyi);
  load_columns([&](std::size_t k) HWY_ATTR { return &discs[j[k]].x; }, xj, yj, dxj, dyj);
  Vector roll_i;
  Vector roll_j;
  Vector unused;
  Vector unused_too;
  Approach a;
  load_columns([&](std::size_t k) HWY_ATTR { return &discs[i[k]].roll; }, roll_i, a.radius_i, unused, unused_too);
  load_columns([&](std::size_t k) HWY_ATTR { return &discs[j[k]].roll; }, roll_j, a.radius_j, unused, unused_too);

  const Vector between_x = hn::Sub(xj, xi);
  const Vector between_y = hn::Sub(yj, yi);
  const Vector reach = hn::Add(a.radius_i, a.radius_j);
  const Vector distance_squared = hn::Add(hn::Mul(between_x, between_x), hn::Mul(between_y, between_y));
  a.touch = hn::Lt(distance_squared, hn::Mul(reach, reach));
  const Vector distance = hn::Sqrt(distance_squared);
  a.overlap = hn::Sub(reach, distance);
  a.normal_x = hn::Div(between_x, distance);
  a.normal_y = hn::Div(between_y, distance);
  const Vector relative_x = hn::Sub(dxi, dxj);
  const Vector relative_y = hn::Sub(dyi, dyj);
  a.normal = hn::Add(hn::Mul(relative_x, a.normal_x), hn::Mul(relative_y, a.normal_y));
  a.shear = hn::Add(hn::Sub(hn::Mul(relative_y, a.normal_x), hn::Mul(relative_x, a.normal_y)), hn::Add(roll_i, roll_j));
  return a;
}

struct Force {
  Vector normal;
  Vector shear;
};

/// TanakaLaw<DefaultReadings>::force, on all lanes; zero where discs do not touch.
HWY_INLINE Force force(const Approach& a, const ContactParameters& p, double step, double* normal_spring,
                       double* shear_spring) {
  const Vector zero = hn::Zero(lanes);
  const Vector dt = hn::Set(lanes, step);
  Vector e_n = hn::Load(lanes, normal_spring);
  Vector e_s = hn::Load(lanes, shear_spring);
  Vector du_n = a.normal;
  Vector du_s = a.shear;
  const Mask first = hn::And(a.touch, hn::Lt(e_n, zero));
  if (HWY_UNLIKELY(!hn::AllFalse(lanes, first))) {  // Eqs. (3), (4)
    const Vector share = hn::IfThenElseZero(hn::Gt(du_n, zero), hn::Min(hn::Div(a.overlap, du_n), hn::Set(lanes, 1.0)));
    du_s = hn::IfThenElse(first, hn::Mul(du_s, share), du_s);
    du_n = hn::IfThenElse(first, a.overlap, du_n);
    e_n = hn::IfThenElse(first, zero, e_n);
    e_s = hn::IfThenElse(first, zero, e_s);
  }
  e_n = hn::Add(e_n, hn::Mul(hn::Set(lanes, p.normal_stiffness), du_n));  // Eq. (5)
  const Mask acts = hn::AndNot(hn::Lt(e_n, zero), a.touch);               // Eq. (8)
  const Vector dashpot_n = hn::Div(hn::Mul(hn::Set(lanes, p.normal_damping), du_n), dt);
  const Vector dashpot_s = hn::Div(hn::Mul(hn::Set(lanes, p.shear_damping), du_s), dt);
  e_s = hn::Add(e_s, hn::Mul(hn::Set(lanes, p.shear_stiffness), du_s));
  const Vector slip_force = hn::Mul(hn::Set(lanes, p.friction), e_n);
  const Mask slips = hn::Gt(hn::Abs(e_s), slip_force);
  e_s = hn::IfThenElse(slips, hn::CopySign(slip_force, e_s), e_s);         // Eq. (9)
  const Vector f_s = hn::IfThenElse(slips, e_s, hn::Add(e_s, dashpot_s));  // Eq. (7)
  hn::Store(hn::IfThenElse(acts, e_n, hn::Set(lanes, not_touching)), lanes, normal_spring);
  hn::Store(hn::IfThenElseZero(acts, e_s), lanes, shear_spring);
  return {hn::IfThenElseZero(acts, hn::Add(e_n, dashpot_n)), hn::IfThenElseZero(acts, f_s)};  // Eq. (6)
}

void AddPairForces(std::span<Pairs> batches, const Disc* discs, Load* loads, const ContactParameters& parameters,
                   double dt) {
  alignas(64) std::array<Load, count> on_i;
  alignas(64) std::array<Load, count> on_j;  // to be subtracted
  for (Pairs& batch : batches) {
    for (std::size_t begin = 0; begin < width; begin += count) {
      const std::uint32_t* i = batch.i.data() + begin;
      const std::uint32_t* j = batch.j.data() + begin;
      const Approach a = approach(i, j, discs);
      const Force f = force(a, parameters, dt, batch.normal_spring.data() + begin, batch.shear_spring.data() + begin);
      const Vector x = hn::Sub(hn::Mul(f.shear, a.normal_y), hn::Mul(f.normal, a.normal_x));
      const Vector y = hn::Neg(hn::Add(hn::Mul(f.normal, a.normal_y), hn::Mul(f.shear, a.normal_x)));
      const Vector work = hn::Add(hn::Mul(f.normal, a.normal), hn::Mul(f.shear, a.shear));
      store_columns(x, y, hn::Neg(hn::Mul(a.radius_i, f.shear)), work,
                    [&](std::size_t k) HWY_ATTR { return &on_i[k].force_x; });
      store_columns(x, y, hn::Mul(a.radius_j, f.shear), hn::Zero(lanes),
                    [&](std::size_t k) HWY_ATTR { return &on_j[k].force_x; });
      for (std::size_t k = 0; k < count; ++k) {
        Load& load_i = loads[i[k]];
        load_i = {load_i.force_x + on_i[k].force_x, load_i.force_y + on_i[k].force_y, load_i.moment + on_i[k].moment,
                  load_i.work + on_i[k].work};
        Load& load_j = loads[j[k]];
        load_j = {load_j.force_x - on_j[k].force_x, load_j.force_y - on_j[k].force_y, load_j.moment - on_j[k].moment,
                  load_j.work};
      }
    }
  }
}

double Move(std::size_t particles, Group* groups, Disc* discs, Load* loads, double gravity, double step) {
  const Vector dt = hn::Set(lanes, step);
  const Vector g = hn::Set(lanes, gravity);
  const Vector half = hn::Set(lanes, 0.5);
  Vector farthest = hn::Zero(lanes);
  for (std::size_t i = 0; i < particles; i += count) {
    Group& group = groups[i / width];
    const std::size_t begin = i % width;
    Disc* disc = discs + i;
    Load* load = loads + i;
    const auto update = [begin](Column& column, Vector added) HWY_ATTR {
      const Vector sum = hn::Add(hn::Load(lanes, column.data() + begin), added);
      hn::Store(sum, lanes, column.data() + begin);
      return sum;
    };
    Vector x;
    Vector y;
    Vector dx;
    Vector dy;
    Vector force_x;
    Vector force_y;
    Vector moment;
    Vector work;
    load_columns([&](std::size_t k) HWY_ATTR { return &disc[k].x; }, x, y, dx, dy);
    load_columns([&](std::size_t k) HWY_ATTR { return &load[k].force_x; }, force_x, force_y, moment, work);
    for (std::size_t k = 0; k < count; ++k) load[k] = {};
    update(group.work, work);
    const Vector mass = hn::Load(lanes, group.mass.data() + begin);
    const Vector inertia = hn::Load(lanes, group.inertia.data() + begin);
    const Vector vx = update(group.velocity_x, hn::Mul(hn::Div(force_x, mass), dt));              // Eqs. (13), (16)
    const Vector vy = update(group.velocity_y, hn::Mul(hn::Sub(hn::Div(force_y, mass), g), dt));  // Eqs. (14), (17)
    const Vector spin = update(group.spin, hn::Mul(hn::Div(moment, inertia), dt));                // Eqs. (15), (18)
    dx = hn::Mul(half, hn::Add(dx, hn::Mul(vx, dt)));                                             // Eq. (19)
    dy = hn::Mul(half, hn::Add(dy, hn::Mul(vy, dt)));                                             // Eq. (20)
    const Vector rotation =
        hn::Mul(half, hn::Add(hn::Load(lanes, group.rotation.data() + begin), hn::Mul(spin, dt)));  // Eq. (21)
    hn::Store(rotation, lanes, group.rotation.data() + begin);
    x = hn::Add(x, dx);             // Eq. (22)
    y = hn::Add(y, dy);             // Eq. (23)
    update(group.angle, rotation);  // Eq. (24)
    store_columns(x, y, dx, dy, [&](std::size_t k) HWY_ATTR { return &disc[k].x; });
    for (std::size_t k = 0; k < count; ++k) disc[k].roll = disc[k].radius * group.rotation[begin + k];
    const Vector away_x = hn::Sub(x, hn::Load(lanes, group.listed_x.data() + begin));
    const Vector away_y = hn::Sub(y, hn::Load(lanes, group.listed_y.data() + begin));
    const Vector away_squared = hn::Add(hn::Mul(away_x, away_x), hn::Mul(away_y, away_y));
    farthest = hn::Max(farthest, hn::IfThenElseZero(hn::FirstN(lanes, particles - i), away_squared));
  }
  return hn::GetLane(hn::MaxOfLanes(lanes, farthest));
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

double move(std::size_t particles, Group* groups, Disc* discs, Load* loads, double gravity, double dt) {
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
