#include "paper_batches.hpp"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

namespace crossdem {
namespace {

constexpr std::size_t fewest_particles = 4096;  // a thread: with less to do, threads wait for one another too much
/// Times its latest stride, a step of the fastest particle is thought to be at most; what goes further, goes back.
constexpr double caution = 1.5;

/// Part number `part` of `parts` of [0, count), as multiples of `unit` where they end before `count`.
std::pair<std::size_t, std::size_t> share(std::size_t count, std::size_t part, std::size_t parts,
                                          std::size_t unit = 1) {
  const std::size_t units = (count + unit - 1) / unit;
  const auto end_of = [&](std::size_t number) { return std::min(units * number / parts * unit, count); };
  return {end_of(part), end_of(part + 1)};
}

}  // namespace

BatchedPaperStepper::BatchedPaperStepper(const Readings& readings, World& world)
    : plain_(PaperScheme{}, readings, world),
      blocks_(world.particles.count()),
      threads_(
          std::clamp<std::size_t>(world.particles.count() / fewest_particles, 1, std::min(world.threads, most_ahead))),
      barrier_(threads_) {
  world.loads = {};  // the blocks have their own
}

void BatchedPaperStepper::advance(World& world, long steps) {
  const long last_step = world.steps + steps;
  blocks_.cut(contacts());
  set_checkpoint(world);
  std::vector<std::jthread> others;
  for (std::size_t thread = 1; thread < threads_; ++thread)
    others.emplace_back([this, &world, last_step, thread] { work(world, last_step, thread); });
  work(world, last_step, 0);
  others.clear();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void BatchedPaperStepper::work(World& world, long last_step, std::size_t thread) {
  const bool leads = thread == 0;
  const auto [begin, end] = share(world.particles.count(), thread, threads_, batch::width);
  const auto for_own_blocks = [&](auto function) {
    const auto [first, last] = share(blocks_.count(), thread, threads_);
    for (std::size_t block = first; block < last; ++block) function(block);
  };
  const auto take_list = [&](std::size_t block) { blocks_.take_list(contacts(), block); };
  const auto give_back_list = [&](std::size_t block) { blocks_.give_back_list(contacts(), block); };

  blocks_.take(world, begin, end);
  for_own_blocks(take_list);
  while (true) {
    barrier_.arrive_and_wait();
    if (leads) next_ = plan(world, last_step);
    barrier_.arrive_and_wait();
    switch (next_) {
      case Next::wave:
        run_levels(world, thread);
        barrier_.arrive_and_wait();
        if (leads) finish_wave(world);
        break;
      case Next::list:
        blocks_.give_back(world, begin, end);
        for_own_blocks(give_back_list);
        barrier_.arrive_and_wait();
        if (leads) make_list(world);
        barrier_.arrive_and_wait();
        if (failure_) return;
        for_own_blocks(take_list);
        break;
      case Next::start_again:
        blocks_.take(world, begin, end);
        for_own_blocks(take_list);
        break;
      case Next::end:
        blocks_.give_back(world, begin, end);
        for_own_blocks(give_back_list);
        return;
    }
  }
}

BatchedPaperStepper::Next BatchedPaperStepper::plan(World& w, long last_step) {
  if (went_too_far_) {
    go_back(w);
    return Next::start_again;
  }
  if (w.steps == last_step) return Next::end;
  const auto most = static_cast<std::size_t>(std::min<long>(careful_ ? 1 : most_ahead, last_step - w.steps));
  const double stride = caution * std::sqrt(moved_.stride_squared);
  for (ahead_ = 0; ahead_ < most; ++ahead_) {
    Level& level = levels_[ahead_];
    level.surfaces = ahead_ == 0 ? w.surfaces : levels_[ahead_ - 1].surfaces;
    if (level.surfaces.bar) level.surfaces.bar->advance(w.dt);
    const double farthest = std::sqrt(moved_.farthest_squared) + static_cast<double>(ahead_) * stride;
    if (contacts().outdated(farthest, level.surfaces)) break;
    level.sums.assign((w.particles.count() + particles_in_sum - 1) / particles_in_sum, {});
    level.moved = {};
    level.blocks_done = 0;
  }
  return ahead_ == 0 ? Next::list : Next::wave;
}

void BatchedPaperStepper::make_list(World& w) {
  blocks_.drop_list();
  const Surfaces now = std::exchange(w.surfaces, levels_.front().surfaces);  // the bar where the next step finds it
  try {
    if (contacts().strayed(w.particles, w.surfaces)) w.check();
    contacts().rebuild(w.particles, w.surfaces, w.steps);
  } catch (...) {
    failure_ = std::current_exception();
    return;
  }
  w.surfaces = now;
  blocks_.cut(contacts());
  moved_.farthest_squared = 0.0;
  careful_ = false;
  set_checkpoint(w);
}

void BatchedPaperStepper::run_levels(const World& w, std::size_t thread) {
  const auto [first, last] = share(ahead_, thread, threads_);
  for (std::size_t front = first; front + 1 < blocks_.count() + last; ++front) {
    for (std::size_t number = first; number < last; ++number) {
      if (front < number || front - number >= blocks_.count()) continue;
      const std::size_t block = front - number;
      Level& level = levels_[number];
      if (number > 0) {
        const std::size_t needed = std::min(block + 2, blocks_.count());
        const std::atomic<std::size_t>& done = levels_[number - 1].blocks_done;
        wait_until([&] { return done.load(std::memory_order_acquire) >= needed; });
      }
      level.moved.include(blocks_.step(block, w, level.surfaces, level.sums));
      level.blocks_done.store(block + 1, std::memory_order_release);
    }
  }
}

void BatchedPaperStepper::finish_wave(World& w) {
  for (std::size_t number = 1; number < ahead_; ++number) {
    const double farthest = std::sqrt(levels_[number - 1].moved.farthest_squared);
    went_too_far_ = went_too_far_ || contacts().outdated(farthest, levels_[number].surfaces);
  }
  if (went_too_far_) return;
  for (std::size_t number = 0; number < ahead_; ++number) {
    const Level& level = levels_[number];
    w.surfaces = level.surfaces;
    w.totals.clear();
    for (const SurfaceTotals& sum : level.sums) w.totals += sum;
    w.enter_impulses(1.0);
    ++w.steps;
    moved_ = level.moved;
  }
}

void BatchedPaperStepper::set_checkpoint(const World& w) {
  checkpoint_ = {w.steps, w.surfaces, w.totals, w.momentum_ledger, w.energy_ledger, moved_, contacts().on_surfaces()};
}

void BatchedPaperStepper::go_back(World& w) {
  w.steps = checkpoint_.steps;
  w.surfaces = checkpoint_.surfaces;
  w.totals = checkpoint_.totals;
  w.momentum_ledger = checkpoint_.momentum_ledger;
  w.energy_ledger = checkpoint_.energy_ledger;
  moved_ = checkpoint_.moved;
  std::copy(checkpoint_.on_surfaces.begin(), checkpoint_.on_surfaces.end(), contacts().on_surfaces().begin());
  went_too_far_ = false;
  careful_ = true;
}

}  // namespace crossdem
