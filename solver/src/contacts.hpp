#pragma once
// The contacts and their memory: a list of everything that may touch before the list is made anew.

#include <algorithm>
#include <cmath>
#include <vector>

#include "neighbours.hpp"
#include "surfaces.hpp"

namespace crossdem {

/// `Memory`: what a law carries from step to step for one contact; its initial value is that of no contact.
template <class Memory>
struct PairContact {
  std::uint32_t i = 0;
  std::uint32_t j = 0;
  Memory memory;
  [[nodiscard]] ParticlePair key() const { return {i, j}; }
};

template <class Memory>
struct SurfaceContact {
  std::uint32_t i = 0;
  Surface surface = Surface::floor;
  Memory memory;
  [[nodiscard]] ParticlePair key() const { return {i, static_cast<std::uint32_t>(surface)}; }
};

/// [m] Neighbours within a fifth of the smallest diameter are listed: wide enough that lists last hundreds of steps in
/// a bed that creeps, narrow enough that few pairs are looked at in vain.
inline double list_skin(const Particles& particles) {
  constexpr double share_of_diameter = 0.05;
  return share_of_diameter * 2 * *std::min_element(particles.radius.begin(), particles.radius.end());
}

/// Whose memory a contact is: one for both partners, or (readings "in turn") each particle its own.
enum class MemoryOwner { pair, particle };

template <class PairMemory, class SurfaceMemory>
class Contacts {
 public:
  using Pair = PairContact<PairMemory>;
  using OnSurface = SurfaceContact<SurfaceMemory>;

  /// `skin` [m]: how far surfaces may be apart and still be in the list.
  Contacts(MemoryOwner owner, double skin) : owner_(owner), skin_(skin) {}

  /// True when something has moved so far that the list could miss a contact.
  [[nodiscard]] bool outdated(const Particles& particles, const Surfaces& surfaces) const {
    if (listed_at_.size() != particles.count()) return true;
    double largest = 0.0;
    for (std::size_t i = 0; i < particles.count(); ++i)
      largest = std::max(largest, (particles.position[i] - listed_at_[i]).squaredNorm());
    return outdated(std::sqrt(largest), surfaces);
  }

  /// The same; `moved` [m]: how far the farthest particle is from where it was listed.
  [[nodiscard]] bool outdated(double moved, const Surfaces& surfaces) const {
    const double bar_moved = surfaces.bar ? surfaces.bar->travel() - bar_listed_at_ : 0.0;
    return moved + std::max(moved, bar_moved) > skin_;
  }

  /// Makes the list anew; contacts that stay in it keep their memory. Positions must be finite.
  void rebuild(const Particles& particles, const Surfaces& surfaces) {
    std::vector<ParticlePair> close = close_pairs(particles, skin_);
    if (owner_ == MemoryOwner::particle) {
      const std::size_t half = close.size();
      for (std::size_t k = 0; k < half; ++k) close.push_back({close[k].j, close[k].i});
      std::sort(close.begin(), close.end());
    }
    std::vector<Pair> pairs;
    pairs.reserve(close.size());
    for (const ParticlePair& pair : close) pairs.push_back({pair.i, pair.j, {}});
    keep_memories(pairs_, pairs);
    pairs_ = std::move(pairs);

    std::vector<OnSurface> on_surfaces;
    for (std::uint32_t i = 0; i < particles.count(); ++i)
      for (const Surface surface : all_surfaces)
        if (surfaces.present(surface) &&
            surfaces.nearest_point(surface, particles.position[i]).distance < particles.radius[i] + skin_)
          on_surfaces.push_back({i, surface, {}});
    keep_memories(on_surfaces_, on_surfaces);
    on_surfaces_ = std::move(on_surfaces);

    listed_at_ = particles.position;
    if (surfaces.bar) bar_listed_at_ = surfaces.bar->travel();
  }

  std::vector<Pair>& pairs() { return pairs_; }
  std::vector<OnSurface>& on_surfaces() { return on_surfaces_; }
  [[nodiscard]] const std::vector<Pair>& pairs() const { return pairs_; }
  [[nodiscard]] const std::vector<Vector2>& listed_at() const { return listed_at_; }
  [[nodiscard]] const std::vector<OnSurface>& on_surfaces() const { return on_surfaces_; }

 private:
  /// Both lists are sorted by key: hands the memories of contacts that stand in both from the old list to the new.
  template <class Contact>
  static void keep_memories(const std::vector<Contact>& old_list, std::vector<Contact>& new_list) {
    auto old_contact = old_list.begin();
    for (Contact& contact : new_list) {
      while (old_contact != old_list.end() && old_contact->key() < contact.key()) ++old_contact;
      if (old_contact == old_list.end()) return;
      if (old_contact->key() == contact.key()) contact.memory = old_contact->memory;
    }
  }

  MemoryOwner owner_;
  double skin_;
  std::vector<Pair> pairs_;             // sorted by i, then j
  std::vector<OnSurface> on_surfaces_;  // sorted by i, then surface
  std::vector<Vector2> listed_at_;      // positions when the list was made
  double bar_listed_at_ = 0.0;          // [m], the bar's travel then
};

}  // namespace crossdem
