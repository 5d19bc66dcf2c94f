#pragma once
// A scheme in batches: eight pairs and particles at a time, several steps in one pass through memory, on one thread or
// more. It gives the bits of the scheme's plain stepper, which stays as what this is held against.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

#include "../crew.hpp"
#include "blocks.hpp"

namespace crossdem {

/// Makes up to most_ahead steps at a time as a wave through the blocks: block n makes the first of them, then block n -
/// 1 the second, n - 2 the third and so on, while all these are near the processor. Threads share out the steps, one
/// behind the other in the wave.
template <class Scheme>
class BatchedStepper final : public Stepper {
 public:
  BatchedStepper(const Case& setup, World& world)
      : plain_(Scheme::plain(setup, world)),
        scheme_(plain_),
        blocks_(world.particles.count()),
        crew_(std::clamp<std::size_t>(world.particles.count() / fewest_particles, 1,
                                      std::min(world.threads, most_ahead))) {
    if constexpr (!Scheme::moves_first) world.loads = {};  // the blocks have their own
  }

  void advance(World& w, long steps) override {
    if (steps == 0) return;
    last_step_ = w.steps + steps;
    if constexpr (Scheme::moves_first) begin(w);
    moved_ = {.farthest_squared = farthest_squared(w.particles, contacts().listed_at()),
              .stride_squared = fastest_squared(w.particles) * (w.dt * w.dt),
              .marked_squared = marked_squared(w)};
    blocks_.cut(contacts());
    set_rollback_point(w);
    std::vector<std::jthread> others;
    for (std::size_t thread = 1; thread < crew_.size(); ++thread)
      others.emplace_back([this, &w, thread] { work(w, thread); });
    work(w, 0);
    others.clear();
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    if constexpr (Scheme::moves_first) plain_.scheme().finish(w);
  }

  [[nodiscard]] double spring_energy(const World& world) const override { return plain_.spring_energy(world); }

  void save(OutArchive& archive) override { plain_.save(archive); }
  void load(InArchive& archive) override { plain_.load(archive); }

 private:
  using OwnContacts = typename Scheme::Plain::OwnContacts;
  using OwnBar = typename Scheme::OwnBar;

  static constexpr std::size_t most_ahead = 16;
  /// A thread: with less to do, threads wait for one another too much.
  static constexpr std::size_t fewest_particles = 4096;
  /// Times its latest stride, a step of the fastest particle is thought to be at most; what goes further, goes back.
  static constexpr double caution = 1.5;

  /// Blocks that have made a step of the wave; in a cache line that no other thread writes to.
  struct alignas(64) Done {
    std::atomic<std::size_t> blocks = 0;
  };

  /// One step of a wave.
  struct Level {
    std::vector<SurfaceTotals> sums;  // for particles_in_sum at a time
    Surfaces surfaces;                // during the step
    batch::Moved moved;
    std::optional<OwnBar> bar;  // during the step
    bool moves = true;          // its particles, after the forces
  };

  /// What a wave that went too far goes back to. The particles and pairs of the world are as they were then.
  struct RollbackPoint {
    long steps;
    Surfaces surfaces;
    OwnBar bar;
    SurfaceTotals totals;
    MomentumLedger momentum_ledger;
    EnergyLedger energy_ledger;
    batch::Moved moved;
    bool marked_now;
    std::vector<typename OwnContacts::OnSurface> on_surfaces;
  };

  enum class Next { wave, list, start_again, end };

  /// [m^2/s^2]
  static double fastest_squared(const Particles& particles) {
    double largest = 0.0;
    for (const Vector2& velocity : particles.velocity) largest = std::max(largest, velocity.squaredNorm());
    return largest;
  }

  double marked_squared(const World& w) {
    if constexpr (Scheme::marks) return farthest_squared(w.particles, plain_.marked_at());
    return 0.0;
  }

  /// The motion of the first step, with which the plain scheme begins it.
  void begin(World& w) {
    w.enter_impulses(Scheme::share_before);
    plain_.scheme().move(w);
    std::fill(w.loads.begin(), w.loads.end(), Load{});
  }

  void work(World& w, std::size_t thread) {
    const bool leads = thread == 0;
    const auto [begin, end] = share(w.particles.count(), thread, crew_.size(), batch::width);
    const auto take_particles = [&, begin = begin, end = end] {
      blocks_.take(w, scheme_, begin, end);
      if constexpr (Scheme::marks) blocks_.take_marks(plain_.marked_at(), begin, end);
    };
    const auto for_own_blocks = [&](auto function) {
      const auto [first, last] = share(blocks_.count(), thread, crew_.size());
      for (std::size_t block = first; block < last; ++block) function(block);
    };
    const auto take_list = [&](std::size_t block) { blocks_.take_list(w, contacts(), block); };
    const auto give_back_list = [&](std::size_t block) { blocks_.give_back_list(contacts(), block); };

    take_particles();
    for_own_blocks(take_list);
    while (true) {
      crew_.wait_for_all();
      if (leads) next_ = plan(w);
      crew_.wait_for_all();
      switch (next_) {
        case Next::wave:
          run_levels(w, thread);
          crew_.wait_for_all();
          if (leads) finish_wave(w);
          break;
        case Next::list:
          blocks_.give_back(w, scheme_, begin, end);
          for_own_blocks(give_back_list);
          crew_.wait_for_all();
          if (leads)
            make_list(w);
          else
            crew_.serve(thread);
          if (failure_) return;
          for_own_blocks(take_list);
          if constexpr (Scheme::marks) blocks_.take_marks(plain_.marked_at(), begin, end);
          break;
        case Next::start_again:
          take_particles();
          for_own_blocks(take_list);
          break;
        case Next::end:
          blocks_.give_back(w, scheme_, begin, end);
          for_own_blocks(give_back_list);
          return;
      }
    }
  }

  Next plan(World& w) {
    if (went_too_far_) {
      go_back(w);
      return Next::start_again;
    }
    if (w.steps == last_step_) return Next::end;
    if (!marked_now_ && bar().must_list(moved_.marked_squared)) return Next::list;
    const auto most = static_cast<std::size_t>(std::min<long>(careful_ ? 1 : most_ahead, last_step_ - w.steps));
    const double stride = caution * std::sqrt(moved_.stride_squared);
    for (ahead_ = 0; ahead_ < most; ++ahead_) {
      Level& level = levels_[ahead_];
      const double on = static_cast<double>(ahead_) * stride;
      level.surfaces = ahead_ == 0 ? w.surfaces : levels_[ahead_ - 1].surfaces;
      level.bar.emplace(ahead_ == 0 ? bar() : *levels_[ahead_ - 1].bar);
      if (ahead_ > 0 && level.bar->must_list(squared(std::sqrt(moved_.marked_squared) + on))) break;
      if (level.surfaces.bar) level.surfaces.bar->advance(w.dt);
      level.bar->advance(level.surfaces, w.dt, ahead_ == 0 && marked_now_);
      if (contacts().outdated(std::sqrt(moved_.farthest_squared) + on, level.surfaces)) break;
      level.sums.assign((w.particles.count() + particles_in_sum - 1) / particles_in_sum, {});
      level.moved = {};
      level.moves = !Scheme::moves_first || w.steps + static_cast<long>(ahead_) + 1 < last_step_;
      done_[ahead_].blocks = 0;
    }
    return ahead_ == 0 ? Next::list : Next::wave;
  }

  /// Also where it is the code that makes its lists: its marks then.
  void make_list(World& w) {
    make_list_with_crew(w);
    crew_.dismiss();
  }

  void make_list_with_crew(World& w) {
    blocks_.drop_list();
    marked_now_ = marked_now_ || bar().must_list(moved_.marked_squared);
    if constexpr (Scheme::marks) {
      if (marked_now_) plain_.marked_at() = w.particles.position;
    }
    const Surfaces now = w.surfaces;  // the bar goes where the next step finds it
    if (w.surfaces.bar) w.surfaces.bar->advance(w.dt);
    try {
      if (contacts().strayed(w.particles, w.surfaces)) w.check();
      contacts().rebuild(w.particles, w.surfaces, w.steps, crew_);
    } catch (...) {
      failure_ = std::current_exception();
      return;
    }
    w.surfaces = now;
    blocks_.cut(contacts());
    moved_.farthest_squared = 0.0;
    if (marked_now_) moved_.marked_squared = 0.0;
    careful_ = false;
    set_rollback_point(w);
  }

  void run_levels(const World& w, std::size_t thread) {
    const auto [first, last] = share(ahead_, thread, crew_.size());
    for (std::size_t front = first; front + 1 < blocks_.count() + last; ++front) {
      for (std::size_t number = first; number < last; ++number) {
        if (front < number || front - number >= blocks_.count()) continue;
        const std::size_t block = front - number;
        Level& level = levels_[number];
        if (number > 0) {
          const std::size_t needed = std::min(block + 2, blocks_.count());
          const std::atomic<std::size_t>& done = done_[number - 1].blocks;
          wait_until([&] { return done.load(std::memory_order_acquire) >= needed; });
        }
        level.moved.include(blocks_.step(block, w, scheme_, level.surfaces, *level.bar, level.sums, level.moves));
        done_[number].blocks.store(block + 1, std::memory_order_release);
      }
    }
  }

  void finish_wave(World& w) {
    for (std::size_t number = 1; number < ahead_; ++number) {
      const Level& before = levels_[number - 1];
      const double farthest = std::sqrt(before.moved.farthest_squared);
      went_too_far_ = went_too_far_ || contacts().outdated(farthest, levels_[number].surfaces) ||
                      before.bar->must_list(before.moved.marked_squared);
    }
    if (went_too_far_) return;
    for (std::size_t number = 0; number < ahead_; ++number) {
      const Level& level = levels_[number];
      w.surfaces = level.surfaces;
      w.totals.clear();
      for (const SurfaceTotals& sum : level.sums) w.totals += sum;
      w.enter_impulses(Scheme::share_after);
      ++w.steps;
      if (w.steps != last_step_) w.enter_impulses(Scheme::share_before);
      moved_ = level.moved;
      bar() = *level.bar;
    }
    marked_now_ = false;
  }

  void set_rollback_point(const World& w) {
    rollback_point_.emplace(RollbackPoint{w.steps, w.surfaces, bar(), w.totals, w.momentum_ledger, w.energy_ledger,
                                          moved_, marked_now_, contacts().on_surfaces()});
  }

  void go_back(World& w) {
    const RollbackPoint& at = *rollback_point_;
    w.steps = at.steps;
    w.surfaces = at.surfaces;
    bar() = at.bar;
    w.totals = at.totals;
    w.momentum_ledger = at.momentum_ledger;
    w.energy_ledger = at.energy_ledger;
    moved_ = at.moved;
    marked_now_ = at.marked_now;
    std::copy(at.on_surfaces.begin(), at.on_surfaces.end(), contacts().on_surfaces().begin());
    went_too_far_ = false;
    careful_ = true;
  }

  static double squared(double x) { return x * x; }

  OwnContacts& contacts() { return plain_.contacts(); }
  OwnBar& bar() { return Scheme::bar(plain_); }

  typename Scheme::Plain plain_;
  Scheme scheme_;
  Blocks<Scheme> blocks_;
  Crew crew_;
  std::array<Level, most_ahead> levels_;
  std::array<Done, most_ahead> done_;
  std::size_t ahead_ = 0;  // steps of the next wave
  long last_step_ = 0;     // of this advance
  batch::Moved moved_;     // in the latest step, and since the list was made
  std::optional<RollbackPoint> rollback_point_;
  Next next_ = Next::end;
  bool marked_now_ = false;    // the particles, where they are in the next step
  bool went_too_far_ = false;  // in the latest wave: further than the list allows
  bool careful_ = false;       // one step at a time until the next list
  std::exception_ptr failure_;
};

}  // namespace crossdem
