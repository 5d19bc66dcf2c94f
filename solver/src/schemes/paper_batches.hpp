#pragma once
// The paper's scheme by the default readings, eight pairs and particles at a time, several steps in one pass through
// memory, on one thread or more: the same bits as PaperStepper, which stays as what this is held against.

#include <atomic>
#include <exception>
#include <vector>

#include "../spin_barrier.hpp"
#include "paper.hpp"
#include "paper_blocks.hpp"

namespace crossdem {

/// Makes up to most_ahead steps at a time as a wave through the blocks: block n makes the first of them, then block n -
/// 1 the second, n - 2 the third and so on, while all these are near the processor. Threads share out the steps, one
/// behind the other in the wave.
class BatchedPaperStepper final : public Stepper {
 public:
  BatchedPaperStepper(const Readings& readings, World& world);

  void advance(World& world, long steps) override;

  [[nodiscard]] double spring_energy(const World& world) const override { return plain_.spring_energy(world); }

 private:
  static constexpr std::size_t most_ahead = 16;

  /// One step of a wave.
  struct Level {
    alignas(64) std::atomic<std::size_t> blocks_done = 0;
    batch::Moved moved;
    std::vector<SurfaceTotals> sums;  // for particles_in_sum at a time
    Surfaces surfaces;                // during the step
  };

  /// What a wave that went too far goes back to. The particles and pairs of the world are as they were then.
  struct Checkpoint {
    long steps;
    Surfaces surfaces;
    SurfaceTotals totals;
    MomentumLedger momentum_ledger;
    EnergyLedger energy_ledger;
    batch::Moved moved;
    std::vector<PaperContacts::OnSurface> on_surfaces;
  };

  enum class Next { wave, list, start_again, end };

  void work(World& world, long last_step, std::size_t thread);
  Next plan(World& world, long last_step);
  void make_list(World& world);
  void run_levels(const World& world, std::size_t thread);
  void finish_wave(World& world);
  void set_checkpoint(const World& world);
  void go_back(World& world);

  PaperContacts& contacts() { return plain_.contacts(); }

  PaperStepper<PaperScheme> plain_;
  PaperBlocks blocks_;
  std::size_t threads_ = 1;
  SpinBarrier barrier_;
  std::array<Level, most_ahead> levels_;
  std::size_t ahead_ = 0;  // steps of the next wave
  batch::Moved moved_;     // in the latest step, and since the list was made
  Checkpoint checkpoint_;
  Next next_ = Next::end;
  bool went_too_far_ = false;  // in the latest wave: further than the list allows
  bool careful_ = false;       // one step at a time until the next list
  std::exception_ptr failure_;
};

}  // namespace crossdem
