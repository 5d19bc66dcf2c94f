#pragma once
// A world in batches, cut into blocks that can be stepped one after the other, each many steps ahead of the next but
// one.

#include <span>
#include <vector>

#include "../batch/kernels.hpp"
#include "../huge_pages.hpp"
#include "../step.hpp"

namespace crossdem {

/// By the paper's scheme with the default readings. A block is a run of particles, with the contacts that list one of
/// them first; the partners of its pairs are in it or in the next one. So a block can make step n as soon as the next
/// one has made step n - 1 and the one before it step n, and every particle has its sum in the order of the list,
/// whichever way through blocks and steps is taken.
class PaperBlocks {
 public:
  explicit PaperBlocks(std::size_t particles);

  /// The particles [begin, end) from the world, and back; `begin` is a multiple of batch::width.
  void take(const World& world, std::size_t begin, std::size_t end);
  void give_back(World& world, std::size_t begin, std::size_t end) const;

  /// Cuts the blocks for a list; then take_list() takes the pairs of each.
  void cut(PaperContacts& contacts);
  void take_list(const PaperContacts& contacts, std::size_t block);
  void give_back_list(PaperContacts& contacts, std::size_t block) const;
  /// Forgets the pairs, to make room for the next list.
  void drop_list() { pairs_ = {}; }

  [[nodiscard]] std::size_t count() const { return blocks_.size(); }

  /// Forces, then moves, of one block; what the surfaces receive of particle i is added to sums[i / particles_in_sum].
  batch::Moved step(std::size_t block, const World& world, const Surfaces& surfaces, std::span<SurfaceTotals> sums);

 private:
  struct Block {
    std::size_t begin;  // of the particles, as `end`
    std::size_t end;
    std::size_t first_pair;  // in the list
    std::size_t last_pair;
    std::size_t first_batch;  // in pairs_
    std::span<PaperContacts::OnSurface> on_surfaces;
    [[nodiscard]] std::size_t batches() const { return (last_pair - first_pair + batch::width - 1) / batch::width; }
  };

  /// The first of two discs that no other is near, with which the pairs of a block are filled up to whole batches.
  [[nodiscard]] std::size_t lone_disc(std::size_t block) const { return groups_.size() * batch::width + 2 * block; }
  void surface_load(const World& world, const Surfaces& surfaces, PaperContacts::OnSurface& contact,
                    SurfaceTotals& totals);

  std::size_t particles_;
  LargeArray<batch::Disc> discs_;  // of whole groups, and lone ones
  LargeArray<batch::Load> loads_;
  LargeArray<batch::Group> groups_;
  LargeArray<batch::Pairs> pairs_;
  std::vector<Block> blocks_;
};

}  // namespace crossdem
