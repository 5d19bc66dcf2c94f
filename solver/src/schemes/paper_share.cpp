#include "paper_share.hpp"

#include <algorithm>

#include "../laws/tanaka.hpp"

namespace crossdem {
namespace {

constexpr double nowhere = 1e9;  // [m]
/// Particles in a block: with their contacts they are read twice in a step, and stay near the processor in between.
constexpr std::size_t particles_in_block = 256;
static_assert(particles_in_sum % particles_in_block == 0 && particles_in_block % batch::width == 0);

std::size_t whole(std::size_t count) { return (count + batch::width - 1) / batch::width; }

}  // namespace

void PaperShare::take(const World& w, PaperContacts& contacts) {
  const Particles& p = w.particles;
  groups_.assign(whole(end_ - begin_), {});
  discs_.assign(groups_.size() * batch::width, {});
  loads_.assign(discs_.size(), {});
  for (std::size_t i = begin_; i < end_; ++i) {
    const std::size_t at = i - begin_;
    const std::size_t k = at % batch::width;
    discs_[at] = {.x = p.position[i].x(),
                  .y = p.position[i].y(),
                  .displacement_x = p.displacement[i].x(),
                  .displacement_y = p.displacement[i].y(),
                  .roll = p.radius[i] * p.rotation[i],
                  .radius = p.radius[i]};
    loads_[at].work = w.contact_work[i];
    batch::Group& group = groups_[at / batch::width];
    group.velocity_x[k] = p.velocity[i].x();
    group.velocity_y[k] = p.velocity[i].y();
    group.spin[k] = p.spin[i];
    group.rotation[k] = p.rotation[i];
    group.angle[k] = p.angle[i];
    group.push[k] = w.dt / p.mass[i];
    group.turn[k] = p.radius[i] * (w.dt / p.inertia[i]);
  }
  take_list(contacts);
}

void PaperShare::take_list(PaperContacts& contacts) {
  for (std::size_t i = begin_; i < end_; ++i) {
    batch::Group& group = groups_[(i - begin_) / batch::width];
    group.listed_x[(i - begin_) % batch::width] = contacts.listed_at()[i].x();
    group.listed_y[(i - begin_) % batch::width] = contacts.listed_at()[i].y();
  }

  neighbours_.clear();
  std::size_t own_pairs = 0;
  for (const PaperContacts::Pair& pair : contacts.pairs()) {
    if (owns(pair.i) || owns(pair.j)) ++own_pairs;
    if (owns(pair.i) != owns(pair.j)) neighbours_.push_back(owns(pair.i) ? pair.j : pair.i);
  }
  std::sort(neighbours_.begin(), neighbours_.end());
  neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
  const std::size_t lone = groups_.size() * batch::width;
  discs_.resize(lone + 2 + neighbours_.size());
  discs_[lone].x = nowhere;
  discs_[lone + 1].x = -nowhere;
  loads_.resize(discs_.size());

  batch::Pairs none{};
  none.i.fill(static_cast<std::uint32_t>(lone));
  none.j.fill(static_cast<std::uint32_t>(lone + 1));
  none.normal_spring.fill(batch::not_touching);
  blocks_.clear();
  pairs_.clear();
  pairs_.reserve(whole(own_pairs) + whole(end_ - begin_) / (particles_in_block / batch::width) + 1);
  auto pair = contacts.pairs().cbegin();
  auto on_surface = std::partition_point(contacts.on_surfaces().begin(), contacts.on_surfaces().end(),
                                         [&](const auto& contact) { return contact.i < begin_; });
  for (std::size_t begin = begin_; begin < end_; begin += particles_in_block) {
    const std::size_t end = std::min(begin + particles_in_block, end_);
    const std::size_t first_batch = pairs_.size();
    std::size_t k = batch::width;
    for (; pair != contacts.pairs().cend() && pair->i < end; ++pair) {
      if (!owns(pair->i) && !owns(pair->j)) continue;
      if (k == batch::width) {
        pairs_.push_back(none);
        k = 0;
      }
      pairs_.back().i[k] = local(pair->i);
      pairs_.back().j[k] = local(pair->j);
      if (pair->memory.touching) pairs_.back().normal_spring[k] = pair->memory.normal;
      pairs_.back().shear_spring[k] = pair->memory.shear;
      ++k;
    }
    const auto first_on_surface = on_surface;
    while (on_surface != contacts.on_surfaces().end() && on_surface->i < end) ++on_surface;
    blocks_.push_back({.begin = begin - begin_,
                       .end = end - begin_,
                       .first_batch = first_batch,
                       .batches = pairs_.size() - first_batch,
                       .on_surfaces = {first_on_surface, on_surface}});
  }
}

void PaperShare::give_back(World& w) const {
  Particles& p = w.particles;
  for (std::size_t i = begin_; i < end_; ++i) {
    const batch::Disc& disc = discs_[i - begin_];
    const batch::Group& group = groups_[(i - begin_) / batch::width];
    const std::size_t k = (i - begin_) % batch::width;
    p.position[i] = {disc.x, disc.y};
    p.displacement[i] = {disc.displacement_x, disc.displacement_y};
    p.velocity[i] = {group.velocity_x[k], group.velocity_y[k]};
    p.spin[i] = group.spin[k];
    p.rotation[i] = group.rotation[k];
    p.angle[i] = group.angle[k];
    w.contact_work[i] = loads_[i - begin_].work;
  }
}

void PaperShare::give_back_list(PaperContacts& contacts) {
  auto pair = contacts.pairs().begin();
  for (const Block& block : blocks_) {
    std::size_t n = block.first_batch * batch::width;
    for (; pair != contacts.pairs().end() && pair->i < begin_ + block.end; ++pair) {
      if (!owns(pair->i) && !owns(pair->j)) continue;
      const batch::Pairs& pairs = pairs_[n / batch::width];
      const std::size_t k = n++ % batch::width;
      if (!owns(pair->i)) continue;  // the other share's to write, though the same
      const bool touching = pairs.normal_spring[k] >= 0.0;
      pair->memory = touching ? ContactSpring{pairs.normal_spring[k], pairs.shear_spring[k], true} : ContactSpring{};
    }
  }
  pairs_ = {};  // room for the next list of the contacts
}

std::uint32_t PaperShare::local(std::uint32_t i) const {
  if (owns(i)) return static_cast<std::uint32_t>(i - begin_);
  const auto place = std::lower_bound(neighbours_.begin(), neighbours_.end(), i) - neighbours_.begin();
  return static_cast<std::uint32_t>(groups_.size() * batch::width + 2 + static_cast<std::size_t>(place));
}

void PaperShare::copy_neighbours(const std::vector<PaperShare>& all) {
  auto of = all.begin();
  std::size_t copy = groups_.size() * batch::width + 2;
  for (const std::uint32_t i : neighbours_) {
    while (!of->owns(i)) ++of;
    discs_[copy] = of->discs_[of->local(i)];
    loads_[copy] = {};
    ++copy;
  }
}

void PaperShare::step(const World& w) {
  farthest_squared_ = 0.0;
  sums_.assign((end_ - begin_ + particles_in_sum - 1) / particles_in_sum, {});
  for (const Block& block : blocks_) {
    batch::add_pair_forces({pairs_.data() + block.first_batch, block.batches}, discs_.data(), loads_.data(),
                           w.particle_particle, w.dt);
    for (PaperContacts::OnSurface& contact : block.on_surfaces)
      surface_load(w, contact, sums_[block.begin / particles_in_sum]);
    const double moved_squared = batch::move(block.end - block.begin, &groups_[block.begin / batch::width],
                                             &discs_[block.begin], &loads_[block.begin], w.gravity, w.dt);
    farthest_squared_ = std::max(farthest_squared_, moved_squared);
  }
}

void PaperShare::surface_load(const World& w, PaperContacts::OnSurface& contact, SurfaceTotals& totals) {
  const std::size_t at = contact.i - begin_;
  const batch::Disc& disc = discs_[at];
  const batch::Group& group = groups_[at / batch::width];
  const std::size_t k = at % batch::width;
  const DiscInMotion motion{{disc.x, disc.y},
                            disc.radius,
                            {disc.displacement_x, disc.displacement_y},
                            group.rotation[k],
                            {group.velocity_x[k], group.velocity_y[k]},
                            group.spin[k]};
  SurfaceForce f;
  if (!surface_force(TanakaLaw<DefaultReadings>{}, w, contact.surface, motion, contact.memory, f)) return;
  const Vector2 on_disc = received(f.force, f.normal);
  batch::Load& load = loads_[at];
  load.force_x += on_disc.x();
  load.force_y += on_disc.y();
  load.rim += f.lever * f.force.shear;
  load.work += f.work;
  totals.add(w.surfaces, contact.surface, motion.centre, on_disc);
}

}  // namespace crossdem
