// What the kernels of all laws and motions share: rows and columns, the loop over pairs, the loop over particles.
// Compiled anew for each set of instructions, so that it is read as often: no include guard of the usual kind.

#if defined(CROSSDEM_BATCH_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef CROSSDEM_BATCH_LANES
#undef CROSSDEM_BATCH_LANES
#else
#define CROSSDEM_BATCH_LANES
#endif

#include <hwy/highway.h>

#include <span>

#include "batch/kernels.hpp"

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

/// a / b, rounded as a division is, of which there may be few in a row: `per_b` is 1 / b, so rounded. Two steps of
/// Markstein (IBM J. Res. Dev. 34, 1990, theorem on quotients by fused multiply-add): the first quotient is wrong by
/// two units in the last place at most, the second one by less than one, the third one is the rounded one. For a of 0
/// or beyond 1e-280.
HWY_INLINE Vector quotient(Vector a, Vector b, Vector per_b) {
#if HWY_NATIVE_FMA
  const Vector near = hn::Mul(a, per_b);
  const Vector nearer = hn::MulAdd(hn::NegMulAdd(b, near, a), per_b, near);
  return hn::MulAdd(hn::NegMulAdd(b, nearer, a), per_b, nearer);
#else
  (void)per_b;
  return hn::Div(a, b);
#endif
}

/// Discs, by the lanes of a turn.
struct Columns {
  Vector x;
  Vector y;
  Vector moves_x;
  Vector moves_y;
  Vector turns;
  Vector radius;
};

#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
/// Of whole discs, a line each: line(k) is that of lane k.
template <class Line>
HWY_INLINE Columns columns_of(Line line) {
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
  // Of lines 2 k and 2 k + 1 in turn: even are x, moves_x, turns, odd are y, moves_y, radius, side by side.
  const auto even = [&](std::size_t k) HWY_ATTR { return hn::InterleaveLower(lanes, d[k], d[k + 1]); };
  const auto odd = [&](std::size_t k) HWY_ATTR { return hn::InterleaveUpper(lanes, d[k], d[k + 1]); };
  Columns c{};
  columns({even(0), even(2), even(4), even(6)}, c.x, c.moves_x, c.turns);
  columns({odd(0), odd(2), odd(4), odd(6)}, c.y, c.moves_y, c.radius);
  return c;
}

HWY_INLINE Columns columns_of(const std::uint32_t* numbers, const Disc* discs) {
  return columns_of([&](std::size_t k) HWY_ATTR { return hn::Load(lanes, &discs[numbers[k]].x); });
}
#else
HWY_INLINE void load_motion(const std::uint32_t* numbers, const Disc* discs, Columns& c) {
  load_columns([&](std::size_t k) HWY_ATTR { return &discs[numbers[k]].x; }, c.x, c.y, c.moves_x, c.moves_y);
}

HWY_INLINE void load_turns(const std::uint32_t* numbers, const Disc* discs, Columns& c) {
  Vector unused;  // two of them: the references of load_columns() must not be to the same
  Vector unused_too;
  load_columns([&](std::size_t k) HWY_ATTR { return &discs[numbers[k]].turns; }, c.turns, c.radius, unused, unused_too);
}

HWY_INLINE Columns columns_of(const std::uint32_t* numbers, const Disc* discs) {
  Columns c{};
  load_motion(numbers, discs, c);
  load_turns(numbers, discs, c);
  return c;
}

/// b minus a of x, y and moves, and the turns and radius of b; `of_a` receives those of a. Half by half, as there are
/// few registers.
HWY_INLINE Columns minus(const std::uint32_t* a, const std::uint32_t* b, const Disc* discs, Columns& of_a) {
  Columns c{};
  load_motion(a, discs, of_a);
  load_motion(b, discs, c);
  c.x = hn::Sub(c.x, of_a.x);
  c.y = hn::Sub(c.y, of_a.y);
  c.moves_x = hn::Sub(c.moves_x, of_a.moves_x);
  c.moves_y = hn::Sub(c.moves_y, of_a.moves_y);
  load_turns(a, discs, of_a);
  load_turns(b, discs, c);
  return c;
}
#endif

/// Two discs of a pair: i minus j, and what is needed of each.
struct Both {
  Vector x;
  Vector y;
  Vector moves_x;
  Vector moves_y;
  Vector turns_i;
  Vector radius_i;
  Vector turns_j;
  Vector radius_j;
};

HWY_INLINE Both both_of(const std::uint32_t* i, const std::uint32_t* j, const Disc* discs) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
  // Products with one, minus one and zero are exact.
  alignas(64) constexpr std::array<double, count> of_i{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0};
  alignas(64) constexpr std::array<double, count> of_j{-1.0, -1.0, -1.0, -1.0, 0.0, 0.0, 1.0, 1.0};
  const Vector take_i = hn::Load(lanes, of_i.data());
  const Vector take_j = hn::Load(lanes, of_j.data());
  const auto line = [&](std::size_t k) HWY_ATTR {
    return hn::MulAdd(hn::Load(lanes, &discs[i[k]].x), take_i, hn::Mul(hn::Load(lanes, &discs[j[k]].x), take_j));
  };
  const std::array<Vector, count> d{line(0), line(1), line(2), line(3), line(4), line(5), line(6), line(7)};
  const auto columns = [&](const std::array<Vector, 4>& pairs, Vector& first, Vector& second, Vector& third,
                           Vector& fourth) HWY_ATTR {
    const auto [a, b, c, e] = pairs;
    const Vector low = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b), a);
    const Vector high = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(e), c);
    const Vector low_odd = hn::OddEvenBlocks(b, hn::SwapAdjacentBlocks(a));
    const Vector high_odd = hn::OddEvenBlocks(e, hn::SwapAdjacentBlocks(c));
    first = hn::ConcatLowerLower(lanes, high, low);
    second = hn::ConcatLowerLower(lanes, high_odd, low_odd);
    third = hn::ConcatUpperUpper(lanes, high, low);
    fourth = hn::ConcatUpperUpper(lanes, high_odd, low_odd);
  };
  const auto even = [&](std::size_t k) HWY_ATTR { return hn::InterleaveLower(lanes, d[k], d[k + 1]); };
  const auto odd = [&](std::size_t k) HWY_ATTR { return hn::InterleaveUpper(lanes, d[k], d[k + 1]); };
  Both b{};
  columns({even(0), even(2), even(4), even(6)}, b.x, b.moves_x, b.turns_i, b.turns_j);
  columns({odd(0), odd(2), odd(4), odd(6)}, b.y, b.moves_y, b.radius_i, b.radius_j);
  return b;
#else
  Columns of_j{};
  const Columns c = minus(j, i, discs, of_j);
  return {c.x, c.y, c.moves_x, c.moves_y, c.turns, c.radius, of_j.turns, of_j.radius};
#endif
}

/// What the pairs of a turn do to their discs.
struct Forces {
  Vector x;  // [N], on i or j, as the law's signs say; the other one receives the opposite
  Vector y;
  Vector turning_i;  // as in Load, but for the sign
  Vector turning_j;
  Vector work;  // [J], of i, but for the sign
};

/// By which Forces go into a load: force, turning, work.
struct Signs {
  std::array<double, 4> i;
  std::array<double, 4> j;
};

/// Pair after pair, by the signs of the law.
template <class Law>
HWY_INLINE void add(Forces f, const std::uint32_t* i, const std::uint32_t* j, Load* loads) {
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
  alignas(32) constexpr std::array<double, 4> signs_i = Law::signs.i;
  alignas(32) constexpr std::array<double, 4> signs_j = Law::signs.j;
  const auto on_i = hn::Load(half_line, signs_i.data());
  const auto on_j = hn::Load(half_line, signs_j.data());
  const auto add_row = [&](hn::Vec<HalfLine> row_i, hn::Vec<HalfLine> row_j, std::size_t k) HWY_ATTR {
    double* load_i = &loads[i[k]].force_x;
    hn::Store(hn::MulAdd(row_i, on_i, hn::Load(half_line, load_i)), half_line, load_i);
    double* load_j = &loads[j[k]].force_x;
    hn::Store(hn::MulAdd(row_j, on_j, hn::Load(half_line, load_j)), half_line, load_j);
  };
  const auto add_rows = [&](const std::array<Vector, 4>& rows_i, const std::array<Vector, 4>& rows_j) HWY_ATTR {
#if HWY_TARGET == HWY_AVX2
    for (std::size_t k = 0; k < count; ++k) add_row(rows_i[k], rows_j[k], k);
#else
    for (std::size_t k = 0; k < upper; ++k)
      add_row(hn::LowerHalf(half_line, rows_i[k]), hn::LowerHalf(half_line, rows_j[k]), k);
    for (std::size_t k = 0; k < upper; ++k)
      add_row(hn::UpperHalf(half_line, rows_i[k]), hn::UpperHalf(half_line, rows_j[k]), k + upper);
#endif
  };
  Vector x = f.x;
  Vector y = f.y;
  Vector work = f.work;
  transpose(f.x, f.y, f.turning_i, f.work);
  const std::array<Vector, 4> rows{f.x, f.y, f.turning_i, f.work};
  if constexpr (Law::turn_alike) {
    add_rows(rows, rows);
  } else {
    transpose(x, y, f.turning_j, work);
    add_rows(rows, {x, y, f.turning_j, work});
  }
#else
  alignas(64) std::array<Load, count> given;
  store_columns(f.x, f.y, f.turning_i, f.work, [&](std::size_t k) HWY_ATTR { return &given[k].force_x; });
  alignas(64) std::array<double, count> turning_j;
  hn::Store(f.turning_j, lanes, turning_j.data());
  const auto add_row = [](const Load& by, const std::array<double, 4>& signs, Load& load) HWY_ATTR {
    load = {load.force_x + signs[0] * by.force_x, load.force_y + signs[1] * by.force_y,
            load.turning + signs[2] * by.turning, load.work + signs[3] * by.work};
  };
  for (std::size_t k = 0; k < count; ++k) {
    add_row(given[k], Law::signs.i, loads[i[k]]);
    given[k].turning = turning_j[k];
    add_row(given[k], Law::signs.j, loads[j[k]]);
  }
#endif
}

/// The forces of pairs by a `law`: approach(i, j, discs) is what it needs of the discs, forces(approach, memory) brings
/// the memory up to date, of which memory(n) is the column n of a turn; `turn_alike`: turning_i is also j's.
///
/// A turn of the loop looks at one batch, takes the forces of the batch before it and adds those of the one before
/// that: none of the three waits for another, where one batch after the other would wait for each root, division and
/// sum.
template <class Law, class Batch>
HWY_INLINE void add_pair_forces(const Law& law, std::span<Batch> batches, const Disc* discs, Load* loads) {
  constexpr std::size_t parts = width / count;  // of a batch, each a turn
  const std::size_t turns = parts * batches.size();
  if (turns == 0) return;
  const auto i = [&](std::size_t turn) { return batches[turn / parts].i.data() + count * (turn % parts); };
  const auto j = [&](std::size_t turn) { return batches[turn / parts].j.data() + count * (turn % parts); };
  // Inlined wherever they stand: what goes from one to the next then stays in registers.
  const auto look = [&](std::size_t turn) HWY_ATTR __attribute__((always_inline)) {
    return law.approach(i(turn), j(turn), discs);
  };
  const auto take = [&](const typename Law::Approach& near, std::size_t turn) HWY_ATTR __attribute__((always_inline)) {
    Batch& batch = batches[turn / parts];
    const std::size_t begin = count * (turn % parts);
    return law.forces(near, [&batch, begin](std::size_t n) { return batch.memory[n].data() + begin; });
  };
  const auto give = [&](const Forces& found, std::size_t turn) HWY_ATTR __attribute__((always_inline)) {
    add<Law>(found, i(turn), j(turn), loads);
  };

  Forces found = take(look(0), 0);
  if (turns > 1) {
    typename Law::Approach near = look(1);
    for (std::size_t turn = 2; turn < turns; ++turn) {
      const typename Law::Approach next_near = look(turn);
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

/// Particles of one turn, on their way through a step.
template <class AnyGroup>
class Turn {
 public:
  HWY_INLINE Turn(std::size_t first, AnyGroup* groups, Disc* discs, Load* loads)
      : group(groups[first / width]), begin_(first % width), discs_(discs + first) {
    load_columns([&](std::size_t k) HWY_ATTR { return &discs_[k].x; }, x, y, moves_x, moves_y);
    Load* own = loads + first;
    Vector work;
    load_columns([&](std::size_t k) HWY_ATTR { return &own[k].force_x; }, force_x, force_y, turning, work);
    forget_forces(own);
  }

  [[nodiscard]] HWY_INLINE Vector of(const Column& column) const { return hn::Load(lanes, column.data() + begin_); }

  HWY_INLINE void put(Column& column, Vector value) const { hn::Store(value, lanes, column.data() + begin_); }

  HWY_INLINE Vector increase(Column& column, Vector by) const {
    const Vector sum = hn::Add(of(column), by);
    put(column, sum);
    return sum;
  }

  /// Gives the discs x, y, moves_x and moves_y, and what turns(k) says of the disc of lane k.
  template <class Turns>
  HWY_INLINE void finish(Turns turns) const {
    store_columns(x, y, moves_x, moves_y, [&](std::size_t k) HWY_ATTR { return &discs_[k].x; });
    for (std::size_t k = 0; k < count; ++k)
      discs_[k].turns = discs_[k].turns_again = turns(begin_ + k, discs_[k].radius);
  }

  /// [m^2]
  [[nodiscard]] HWY_INLINE Vector squared_way_from(const Column& from_x, const Column& from_y) const {
    const Vector away_x = hn::Sub(x, of(from_x));
    const Vector away_y = hn::Sub(y, of(from_y));
    return hn::Add(hn::Mul(away_x, away_x), hn::Mul(away_y, away_y));
  }

  AnyGroup& group;
  Vector x;
  Vector y;
  Vector moves_x;
  Vector moves_y;
  Vector force_x;
  Vector force_y;
  Vector turning;

 private:
  std::size_t begin_;
  Disc* discs_;
};

/// The largest of something over the particles that are there.
class Largest {
 public:
  explicit HWY_INLINE Largest(std::size_t particles) : particles_(particles) {}
  HWY_INLINE void include(std::size_t first, Vector values) {
    const Mask real = hn::FirstN(lanes, particles_ - first);
    found_ = hn::Max(found_, hn::IfThenElseZero(real, values));
  }
  [[nodiscard]] HWY_INLINE double value() const { return hn::GetLane(hn::MaxOfLanes(lanes, found_)); }

 private:
  std::size_t particles_;
  Vector found_ = hn::Zero(lanes);
};

}  // namespace crossdem::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
