#pragma once
// The contacts and their memory: a list of everything that may touch before the list is made anew.

#include <vector>

#include "contact_law.hpp"
#include "neighbours.hpp"
#include "surfaces.hpp"

namespace crossdem {

struct PairContact {
  std::uint32_t i = 0;
  std::uint32_t j = 0;
  ContactSpring spring;
  [[nodiscard]] ParticlePair key() const { return {i, j}; }
};

struct SurfaceContact {
  std::uint32_t i = 0;
  Surface surface = Surface::floor;
  ContactSpring spring;
  [[nodiscard]] ParticlePair key() const { return {i, static_cast<std::uint32_t>(surface)}; }
};

/// Whose memory a contact is: one spring for both partners, or (readings "in turn") each particle its own.
enum class SpringOwner { pair, particle };

class Contacts {
 public:
  /// `skin` [m]: how far surfaces may be apart and still be in the list.
  Contacts(SpringOwner owner, double skin) : owner_(owner), skin_(skin) {}

  /// True when something has moved so far that the list could miss a contact.
  [[nodiscard]] bool outdated(const Particles& particles, const Surfaces& surfaces) const;

  /// Makes the list anew; contacts that stay in it keep their memory. Positions must be finite.
  void rebuild(const Particles& particles, const Surfaces& surfaces);

  std::vector<PairContact>& pairs() { return pairs_; }
  std::vector<SurfaceContact>& on_surfaces() { return on_surfaces_; }
  [[nodiscard]] const std::vector<PairContact>& pairs() const { return pairs_; }
  [[nodiscard]] const std::vector<SurfaceContact>& on_surfaces() const { return on_surfaces_; }

 private:
  SpringOwner owner_;
  double skin_;
  std::vector<PairContact> pairs_;           // sorted by i, then j
  std::vector<SurfaceContact> on_surfaces_;  // sorted by i, then surface
  std::vector<Vector2> listed_at_;           // positions when the list was made
  double bar_listed_at_ = 0.0;               // [m], the bar's travel then
};

}  // namespace crossdem
