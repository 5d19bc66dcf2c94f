#include "contacts.hpp"

#include <algorithm>
#include <cmath>

namespace crossdem {
namespace {

/// Both lists are sorted by key: hands the springs of contacts that stand in both from the old list to the new.
template <class Contact>
void keep_springs(const std::vector<Contact>& old_list, std::vector<Contact>& new_list) {
  auto old_contact = old_list.begin();
  for (Contact& contact : new_list) {
    while (old_contact != old_list.end() && old_contact->key() < contact.key()) ++old_contact;
    if (old_contact == old_list.end()) return;
    if (old_contact->key() == contact.key()) contact.spring = old_contact->spring;
  }
}

}  // namespace

bool Contacts::outdated(const Particles& particles, const Surfaces& surfaces) const {
  if (listed_at_.size() != particles.count()) return true;
  double largest = 0.0;
  for (std::size_t i = 0; i < particles.count(); ++i)
    largest = std::max(largest, (particles.position[i] - listed_at_[i]).squaredNorm());
  const double moved = std::sqrt(largest);
  const double bar_moved = surfaces.bar ? surfaces.bar->travel() - bar_listed_at_ : 0.0;
  return moved + std::max(moved, bar_moved) > skin_;
}

void Contacts::rebuild(const Particles& particles, const Surfaces& surfaces) {
  std::vector<ParticlePair> close = close_pairs(particles, skin_);
  if (owner_ == SpringOwner::particle) {
    const std::size_t half = close.size();
    for (std::size_t k = 0; k < half; ++k) close.push_back({close[k].j, close[k].i});
    std::sort(close.begin(), close.end());
  }
  std::vector<PairContact> pairs;
  pairs.reserve(close.size());
  for (const ParticlePair& pair : close) pairs.push_back({pair.i, pair.j, {}});
  keep_springs(pairs_, pairs);
  pairs_ = std::move(pairs);

  std::vector<SurfaceContact> on_surfaces;
  for (std::uint32_t i = 0; i < particles.count(); ++i)
    for (const Surface surface : all_surfaces)
      if (surfaces.present(surface) &&
          surfaces.nearest_point(surface, particles.position[i]).distance < particles.radius[i] + skin_)
        on_surfaces.push_back({i, surface, {}});
  keep_springs(on_surfaces_, on_surfaces);
  on_surfaces_ = std::move(on_surfaces);

  listed_at_ = particles.position;
  if (surfaces.bar) bar_listed_at_ = surfaces.bar->travel();
}

}  // namespace crossdem
