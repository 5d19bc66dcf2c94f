#pragma once
// The contacts and their memory: a list of everything that may touch before the list is made anew.

#include <algorithm>
#include <cmath>
#include <vector>

#include "list_skin.hpp"
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

template <class Archive, class Memory>
void serialize(Archive& archive, PairContact<Memory>& contact) {
  archive(contact.i, contact.j, contact.memory);
}

template <class Archive, class Memory>
void serialize(Archive& archive, SurfaceContact<Memory>& contact) {
  archive(contact.i, contact.surface, contact.memory);
}

/// Whether particle and surface are closer than `gap` [m].
inline bool closer_than(double gap, const Particles& particles, const Surfaces& surfaces, std::uint32_t i,
                        Surface surface) {
  return surfaces.nearest_point(surface, particles.position[i]).distance < particles.radius[i] + gap;
}

/// [m^2], the largest square of the way from where a particle was to where it is.
inline double farthest_squared(const Particles& particles, const std::vector<Vector2>& was_at) {
  double largest = 0.0;
  for (std::size_t i = 0; i < particles.count(); ++i)
    largest = std::max(largest, (particles.position[i] - was_at[i]).squaredNorm());
  return largest;
}

/// Whose memory a contact is: one for both partners, or (readings "in turn") each particle its own.
enum class MemoryOwner { pair, particle };

template <class PairMemory, class SurfaceMemory>
class Contacts {
 public:
  using Pair = PairContact<PairMemory>;
  using OnSurface = SurfaceContact<SurfaceMemory>;

  /// `joint_stretch` [m]: the gap over which two particles may still hold together.
  Contacts(MemoryOwner owner, const ListSkin& skin, double joint_stretch = 0.0)
      : owner_(owner), skin_(skin), joint_stretch_(joint_stretch) {}

  /// True when something has moved so far that the list could miss a contact.
  [[nodiscard]] bool outdated(const Particles& particles, const Surfaces& surfaces) const {
    if (listed_at_.size() != particles.count()) return true;
    return outdated(std::sqrt(farthest_squared(particles, listed_at_)), surfaces);
  }

  /// The same; `moved` [m]: how far the farthest particle is from where it was listed.
  [[nodiscard]] bool outdated(double moved, const Surfaces& surfaces) const {
    const double bar_moved = surfaces.bar ? surfaces.bar->travel() - bar_listed_at_ : 0.0;
    return moved + std::max(moved, bar_moved) > skin_.now();
  }

  /// True when the list cannot be made of the candidates any more: the next rebuild() looks at all particles again.
  [[nodiscard]] bool strayed(const Particles& particles, const Surfaces& surfaces) const {
    if (searched_at_.size() != particles.count()) return true;
    const double moved = std::sqrt(farthest_squared(particles, searched_at_));
    const double bar_moved = surfaces.bar ? surfaces.bar->travel() - bar_searched_at_ : 0.0;
    return skin_.now() + moved + std::max(moved, bar_moved) > width_;
  }

  /// Makes the list anew after `steps` of the world; contacts that stay in it keep their memory. Positions must be
  /// finite if they have strayed.
  void rebuild(const Particles& particles, const Surfaces& surfaces, long steps = 0) {
    Crew alone;
    rebuild(particles, surfaces, steps, alone);
  }
  void rebuild(const Particles& particles, const Surfaces& surfaces, long steps, Crew& crew) {
    if (!listed_at_.empty()) skin_.lasted(steps - listed_steps_);
    listed_steps_ = steps;
    if (strayed(particles, surfaces)) search(particles, surfaces, crew);
    pairs_ = gathered<Pair>(candidates_.size(), crew, [&](std::size_t begin, std::size_t end) {
      std::vector<Pair> pairs;
      const std::size_t expected = pairs_.size() + pairs_.size() / 8;
      pairs.reserve(begin == 0 ? expected : expected / crew.size());  // the first takes in the others
      for (std::size_t n = begin; n < end; ++n)
        if (closer_than(skin_.now() + joint_stretch_, particles, candidates_[n]))
          pairs.push_back({candidates_[n].i, candidates_[n].j, {}});
      keep_memories(pairs_, pairs);
      return pairs;
    });

    std::vector<OnSurface> on_surfaces;
    for (const OnSurface& candidate : surface_candidates_)
      if (closer_than(skin_.now(), particles, surfaces, candidate.i, candidate.surface))
        on_surfaces.push_back(candidate);
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

  /// The list as it is; the candidates for the next one are searched anew.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(skin_, pairs_, on_surfaces_, listed_at_, bar_listed_at_, listed_steps_);
    if constexpr (Archive::is_loading::value) searched_at_.clear();
  }

 private:
  void search(const Particles& particles, const Surfaces& surfaces, Crew& crew) {
    width_ = skin_.now() + skin_.reserve();
    candidates_ = {};  // before there are others
    candidates_ = close_pairs(particles, width_ + joint_stretch_, crew);
    if (owner_ == MemoryOwner::particle) {
      const std::size_t half = candidates_.size();
      for (std::size_t k = 0; k < half; ++k) candidates_.push_back({candidates_[k].j, candidates_[k].i});
      std::sort(candidates_.begin(), candidates_.end());
    }
    surface_candidates_.clear();
    for (std::uint32_t i = 0; i < particles.count(); ++i) {
      for (const Surface surface : all_surfaces) {
        if (surfaces.present(surface) && closer_than(width_, particles, surfaces, i, surface))
          surface_candidates_.push_back({i, surface, {}});
      }
    }
    searched_at_ = particles.position;
    if (surfaces.bar) bar_searched_at_ = surfaces.bar->travel();
  }

  /// Both lists are sorted by key: hands the memories of contacts that stand in both from the old list to the new.
  template <class Contact>
  static void keep_memories(const std::vector<Contact>& old_list, std::vector<Contact>& new_list) {
    if (new_list.empty()) return;
    const auto comes_before = [](const Contact& a, const Contact& b) { return a.key() < b.key(); };
    auto old_contact = std::lower_bound(old_list.begin(), old_list.end(), new_list.front(), comes_before);
    for (Contact& contact : new_list) {
      while (old_contact != old_list.end() && old_contact->key() < contact.key()) ++old_contact;
      if (old_contact == old_list.end()) return;
      if (old_contact->key() == contact.key()) contact.memory = old_contact->memory;
    }
  }

  MemoryOwner owner_;
  ListSkin skin_;
  double joint_stretch_;                  // [m]
  std::vector<Pair> pairs_;               // sorted by i, then j
  std::vector<OnSurface> on_surfaces_;    // sorted by i, then surface
  std::vector<Vector2> listed_at_;        // positions when the list was made
  double bar_listed_at_ = 0.0;            // [m], the bar's travel then
  long listed_steps_ = 0;                 // of the world, then
  double width_ = 0.0;                    // [m], of the gaps among the candidates, beyond the stretch of joints
  std::vector<ParticlePair> candidates_;  // sorted as the pairs: all that come near while particles have not strayed
  std::vector<OnSurface> surface_candidates_;  // sorted as those in the list; their memories mean nothing
  std::vector<Vector2> searched_at_;           // positions when the candidates were found
  double bar_searched_at_ = 0.0;               // [m], the bar's travel then
};

}  // namespace crossdem
