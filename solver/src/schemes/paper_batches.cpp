#include "paper_batches.hpp"

#include <algorithm>
#include <exception>
#include <thread>

#include "../spin_barrier.hpp"

namespace crossdem {
namespace {

constexpr std::size_t fewest_sums = 4;  // in a share: with less to do, threads wait for one another too much

}  // namespace

BatchedPaperStepper::BatchedPaperStepper(const Readings& readings, World& world)
    : plain_(PaperScheme{}, readings, world) {
  world.loads = {};  // the shares have their own
  const std::size_t particles = world.particles.count();
  const std::size_t sums = (particles + particles_in_sum - 1) / particles_in_sum;
  const std::size_t shares = std::clamp<std::size_t>(sums / fewest_sums, 1, world.threads);
  for (std::size_t k = 0; k < shares; ++k)
    shares_.emplace_back(k * sums / shares * particles_in_sum,
                         std::min((k + 1) * sums / shares * particles_in_sum, particles));
}

void BatchedPaperStepper::advance(World& world, long steps) {
  SpinBarrier barrier(shares_.size());
  const auto meet = [&] {
    if (shares_.size() > 1) barrier.arrive_and_wait();
  };
  std::exception_ptr failure;
  const auto move = [&](PaperShare& share) {
    const bool leads = &share == &shares_.front();
    share.take(world, contacts());
    meet();
    for (long n = 0; n < steps; ++n) {
      if (leads) begin_step(world);
      meet();
      if (outdated_) {
        share.give_back(world);
        share.give_back_list(contacts());
        meet();
        if (leads) {
          try {
            make_list(world);
          } catch (...) {
            failure = std::current_exception();
          }
        }
        meet();
        if (failure) return;
        share.take_list(contacts());
        meet();
      }
      share.copy_neighbours(shares_);
      meet();
      share.step(world);
      meet();
      if (leads) end_step(world);
    }
    share.give_back(world);
    share.give_back_list(contacts());
  };
  std::vector<std::jthread> helpers;
  for (auto share = shares_.begin() + 1; share != shares_.end(); ++share)
    helpers.emplace_back([&move, share] { move(*share); });
  move(shares_.front());
  helpers.clear();
  if (failure) std::rethrow_exception(failure);
}

void BatchedPaperStepper::begin_step(World& w) {
  if (w.surfaces.bar) w.surfaces.bar->advance(w.dt);
  double farthest_squared = 0.0;
  for (const PaperShare& share : shares_) farthest_squared = std::max(farthest_squared, share.farthest_squared());
  outdated_ = contacts().outdated(std::sqrt(farthest_squared), w.surfaces);
}

void BatchedPaperStepper::make_list(const World& w) {
  if (contacts().strayed(w.particles, w.surfaces)) w.check();
  contacts().rebuild(w.particles, w.surfaces, w.steps);
}

void BatchedPaperStepper::end_step(World& w) {
  w.totals.clear();
  for (const PaperShare& share : shares_) share.add_to(w.totals);
  w.enter_impulses(1.0);
  ++w.steps;
}

}  // namespace crossdem
