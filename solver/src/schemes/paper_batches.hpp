#pragma once
// The paper's scheme by the default readings, eight pairs and particles at a time, on one thread or more: the same bits
// as PaperStepper, which stays as what this is held against.

#include <vector>

#include "paper.hpp"
#include "paper_share.hpp"

namespace crossdem {

class BatchedPaperStepper final : public Stepper {
 public:
  /// On at most so many threads as the world allows: fewer where one would have too little to do.
  BatchedPaperStepper(const Readings& readings, World& world);

  void advance(World& world, long steps) override;

  [[nodiscard]] double spring_energy(const World& world) const override { return plain_.spring_energy(world); }

 private:
  /// Moves the bar, and looks whether the list is outdated.
  void begin_step(World& world);
  void make_list(const World& world);
  void end_step(World& world);

  PaperContacts& contacts() { return plain_.contacts(); }

  PaperStepper<PaperScheme> plain_;
  std::vector<PaperShare> shares_;
  bool outdated_ = false;  // the list
};

}  // namespace crossdem
