#pragma once
// A world in batches, cut into blocks that can be stepped one after the other, each many steps ahead of the next but
// one.

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "../batch/kernels.hpp"
#include "../huge_pages.hpp"
#include "../world.hpp"

namespace crossdem {

/// A block is a run of particles, with the contacts that list one of them first; the partners of its pairs are in it or
/// in the next one. So a block can make step n as soon as the next one has made step n - 1 and the one before it step
/// n, and every particle has its sum in the order of the list, whichever way through blocks and steps is taken.
///
/// `Scheme` says what is done in batches, see schemes/paper_batches.hpp.
template <class Scheme>
class Blocks {
 public:
  using OwnContacts = typename Scheme::Plain::OwnContacts;

  explicit Blocks(std::size_t particles) : particles_(particles) {
    groups_.resize(whole(particles));
    discs_.resize(groups_.size() * batch::width);
    loads_.resize(discs_.size());
  }

  /// The particles [begin, end) from the world, and back; `begin` is a multiple of batch::width.
  void take(const World& w, const Scheme& scheme, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      typename Scheme::Group& group = groups_[i / batch::width];
      const std::size_t k = i % batch::width;
      const Vector2& at = w.particles.position[i];
      discs_[i] = {.x = at.x(), .y = at.y(), .radius = w.particles.radius[i], .radius_again = w.particles.radius[i]};
      loads_[i] = {.work = w.contact_work[i]};
      group.angle[k] = w.particles.angle[i];
      scheme.take(w, i, discs_[i], group, k);
    }
  }

  void give_back(World& w, const Scheme& scheme, std::size_t begin, std::size_t end) const {
    for (std::size_t i = begin; i < end; ++i) {
      const typename Scheme::Group& group = groups_[i / batch::width];
      const std::size_t k = i % batch::width;
      w.particles.position[i] = {discs_[i].x, discs_[i].y};
      w.contact_work[i] = loads_[i].work;
      w.particles.angle[i] = group.angle[k];
      scheme.give_back(w, i, discs_[i], loads_[i], group, k);
    }
  }

  /// For the motion that marks particles: where they were marked.
  void take_marks(const std::vector<Vector2>& marked_at, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      groups_[i / batch::width].marked_x[i % batch::width] = marked_at[i].x();
      groups_[i / batch::width].marked_y[i % batch::width] = marked_at[i].y();
    }
  }

  /// Cuts the blocks for a list; then take_list() takes the pairs of each.
  void cut(OwnContacts& contacts) {
    const std::vector<typename OwnContacts::Pair>& pairs = contacts.pairs();
    std::size_t farthest_partner = 0;
    for (const typename OwnContacts::Pair& pair : pairs)
      farthest_partner = std::max<std::size_t>(farthest_partner, pair.j - pair.i);
    const std::size_t size = std::max(particles_in_block, whole(farthest_partner) * batch::width);

    blocks_.clear();
    std::size_t batches = 0;
    std::size_t pair = 0;
    auto on_surface = contacts.on_surfaces().begin();
    for (std::size_t begin = 0; begin < particles_; begin += size) {
      const std::size_t end = std::min(begin + size, particles_);
      const auto of_later = [end](const auto& contact) { return contact.i < end; };
      const auto first_on_surface = on_surface;
      on_surface = std::partition_point(on_surface, contacts.on_surfaces().end(), of_later);
      const auto last_pair =
          std::partition_point(pairs.begin() + static_cast<std::ptrdiff_t>(pair), pairs.end(), of_later);
      blocks_.push_back({.begin = begin,
                         .end = end,
                         .first_pair = pair,
                         .last_pair = static_cast<std::size_t>(last_pair - pairs.begin()),
                         .first_batch = batches,
                         .on_surfaces = {first_on_surface, on_surface}});
      pair = blocks_.back().last_pair;
      batches += blocks_.back().batches();
    }
    pairs_.resize(batches);
    discs_.resize(lone_disc(blocks_.size()));
    for (std::size_t number = 0; number < blocks_.size(); ++number) {  // with radii, which levers are divided by
      discs_[lone_disc(number)] = {.x = nowhere, .radius = 1.0, .radius_again = 1.0};
      discs_[lone_disc(number) + 1] = {.x = -nowhere, .radius = 1.0, .radius_again = 1.0};
    }
    loads_.resize(discs_.size());
  }

  void take_list(const World& w, const OwnContacts& contacts, std::size_t block_number) {
    const Block& block = blocks_[block_number];
    if constexpr (Scheme::weight_comes_before_surfaces) {
      for (std::size_t i = block.begin; i < block.end; ++i)
        groups_[i / batch::width].weight[i % batch::width] = weight(w, i);
      for (const auto& contact : block.on_surfaces)
        groups_[contact.i / batch::width].weight[contact.i % batch::width] = 0.0;
    }
    for (std::size_t i = block.begin; i < block.end; ++i) {
      groups_[i / batch::width].listed_x[i % batch::width] = contacts.listed_at()[i].x();
      groups_[i / batch::width].listed_y[i % batch::width] = contacts.listed_at()[i].y();
    }
    const std::size_t places = block.batches() * batch::width;
    const std::size_t taken = block.last_pair - block.first_pair;
    for (std::size_t n = 0; n < places; ++n) {
      typename Scheme::Pairs& pairs = pairs_[block.first_batch + n / batch::width];
      const std::size_t k = n % batch::width;
      const auto lone = static_cast<std::uint32_t>(lone_disc(block_number));
      const typename OwnContacts::Pair pair =
          n < taken ? contacts.pairs()[block.first_pair + n] : typename OwnContacts::Pair{lone, lone + 1, {}};
      pairs.i[k] = pair.i;
      pairs.j[k] = pair.j;
      const auto numbers = Scheme::numbers(pair.memory);
      for (std::size_t m = 0; m < numbers.size(); ++m) pairs.memory[m][k] = numbers[m];
    }
  }

  void give_back_list(OwnContacts& contacts, std::size_t block_number) const {
    const Block& block = blocks_[block_number];
    for (std::size_t n = 0; n < block.last_pair - block.first_pair; ++n) {
      const typename Scheme::Pairs& pairs = pairs_[block.first_batch + n / batch::width];
      const std::size_t k = n % batch::width;
      Numbers numbers;
      for (std::size_t m = 0; m < numbers.size(); ++m) numbers[m] = pairs.memory[m][k];
      contacts.pairs()[block.first_pair + n].memory = Scheme::memory(numbers);
    }
  }

  /// Forgets the pairs, to make room for the next list.
  void drop_list() { pairs_ = {}; }

  [[nodiscard]] std::size_t count() const { return blocks_.size(); }

  /// Forces, then moves if the particles of this step do move, of one block. What the surfaces receive of particle i is
  /// added to sums[i / particles_in_sum].
  batch::Moved step(std::size_t block_number, const World& w, const Scheme& scheme, const Surfaces& surfaces,
                    const typename Scheme::OwnBar& bar, std::span<SurfaceTotals> sums, bool moves) {
    const Block& block = blocks_[block_number];
    scheme.add_pair_forces(w, {pairs_.data() + block.first_batch, block.batches()}, discs_.data(), loads_.data());
    std::size_t latest = particles_;
    for (typename OwnContacts::OnSurface& contact : block.on_surfaces) {
      const std::size_t i = contact.i;
      if constexpr (Scheme::weight_comes_before_surfaces) {
        if (i != latest) loads_[i].force_y -= weight(w, i);
        latest = i;
      }
      scheme.surface(w, surfaces, bar, contact, discs_[i], groups_[i / batch::width], loads_[i],
                     sums[i / particles_in_sum]);
    }
    if (!moves) return {};
    return scheme.move(w, block.end - block.begin, &groups_[block.begin / batch::width], &discs_[block.begin],
                       &loads_[block.begin]);
  }

 private:
  using Numbers = decltype(Scheme::numbers({}));  // a contact's memory

  static constexpr double nowhere = 1e9;  // [m]
  /// Particles in a block, at least: with their contacts they fit into the nearest cache, where they are read twice a
  /// step.
  static constexpr std::size_t particles_in_block = 256;
  static_assert(particles_in_block % batch::width == 0);

  struct Block {
    std::size_t begin;  // of the particles, as `end`
    std::size_t end;
    std::size_t first_pair;  // in the list
    std::size_t last_pair;
    std::size_t first_batch;  // in pairs_
    std::span<typename OwnContacts::OnSurface> on_surfaces;
    [[nodiscard]] std::size_t batches() const { return whole(last_pair - first_pair); }
  };

  static double weight(const World& w, std::size_t i) { return w.particles.mass[i] * w.gravity; }  // [N]

  /// Batches that hold so many.
  static constexpr std::size_t whole(std::size_t count) { return (count + batch::width - 1) / batch::width; }

  /// The first of two discs that no other is near, with which the pairs of a block are filled up to whole batches.
  [[nodiscard]] std::size_t lone_disc(std::size_t block) const { return groups_.size() * batch::width + 2 * block; }

  std::size_t particles_;
  LargeArray<batch::Disc> discs_;  // of whole groups, and lone ones
  LargeArray<batch::Load> loads_;
  LargeArray<typename Scheme::Group> groups_;
  LargeArray<typename Scheme::Pairs> pairs_;
  std::vector<Block> blocks_;
};

}  // namespace crossdem
