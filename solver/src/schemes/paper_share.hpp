#pragma once
// What one thread moves of a world by the paper's scheme with the default readings.

#include <span>
#include <vector>

#include "../batch/kernels.hpp"
#include "../huge_pages.hpp"
#include "../step.hpp"

namespace crossdem {

/// A run of particles in batches, with copies of the neighbours that other shares move. A pair across the edge stands
/// in both shares: each takes the force, and memory, for itself, so that every particle has its sum in the order of the
/// list however many shares there are.
class PaperShare {
 public:
  /// [begin, end) of the particles; `begin` is a multiple of particles_in_sum.
  PaperShare(std::size_t begin, std::size_t end) : begin_(begin), end_(end) {}

  /// Takes over the particles and the list.
  void take(const World& world, PaperContacts& contacts);
  /// Takes over the list where only that is new.
  void take_list(PaperContacts& contacts);
  /// Writes the particles back.
  void give_back(World& world) const;
  /// Writes the memories of the list back, and does without it until the next take_list().
  void give_back_list(PaperContacts& contacts);

  /// Before a step: brings the copies of what `all` the shares move up to date. Not while any of them steps.
  void copy_neighbours(const std::vector<PaperShare>& all);

  /// Forces, then moves. Reads of `world` what is the same for all particles.
  void step(const World& world);

  /// [m^2], largest of a particle's way since it was listed.
  [[nodiscard]] double farthest_squared() const { return farthest_squared_; }
  /// Adds what the surfaces did in the last step, in the order of the particles.
  void add_to(SurfaceTotals& totals) const {
    for (const SurfaceTotals& sum : sums_) totals += sum;
  }

 private:
  /// Particles that move as soon as the forces of the pairs are there that list one of them first, and their contacts
  /// with surfaces: later pairs need them no more, and all is still near the processor.
  struct Block {
    std::size_t begin;        // local, as `end`
    std::size_t end;          // of the particles
    std::size_t first_batch;  // in pairs_
    std::size_t batches;
    std::span<PaperContacts::OnSurface> on_surfaces;
  };

  [[nodiscard]] bool owns(std::uint32_t i) const { return i >= begin_ && i < end_; }
  /// Place of a particle, or of its copy, in discs_ and loads_.
  [[nodiscard]] std::uint32_t local(std::uint32_t i) const;
  void surface_load(const World& w, PaperContacts::OnSurface& contact, SurfaceTotals& totals);

  std::size_t begin_;
  std::size_t end_;
  LargeArray<batch::Disc> discs_;  // of whole groups, of two discs that no other is near, and of copies
  LargeArray<batch::Load> loads_;
  LargeArray<batch::Group> groups_;
  LargeArray<batch::Pairs> pairs_;
  std::vector<Block> blocks_;
  std::vector<SurfaceTotals> sums_;        // of the last step
  std::vector<std::uint32_t> neighbours_;  // that others move; sorted
  double farthest_squared_ = 0.0;          // [m^2]
};

}  // namespace crossdem
