#include "paper_blocks.hpp"

#include <algorithm>

#include "../laws/tanaka.hpp"

namespace crossdem {
namespace {

constexpr double nowhere = 1e9;  // [m]
/// Particles in a block, at least: with their contacts they fit into the nearest cache, where they are read twice a
/// step.
constexpr std::size_t particles_in_block = 256;
static_assert(particles_in_block % batch::width == 0);

std::size_t whole(std::size_t count) { return (count + batch::width - 1) / batch::width; }

}  // namespace

PaperBlocks::PaperBlocks(std::size_t particles) : particles_(particles) {
  groups_.resize(whole(particles));
  discs_.resize(groups_.size() * batch::width);
  loads_.resize(discs_.size());
}

void PaperBlocks::take(const World& w, std::size_t begin, std::size_t end) {
  const Particles& p = w.particles;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t k = i % batch::width;
    discs_[i] = {.x = p.position[i].x(),
                 .y = p.position[i].y(),
                 .displacement_x = p.displacement[i].x(),
                 .displacement_y = p.displacement[i].y(),
                 .roll = p.radius[i] * p.rotation[i],
                 .radius = p.radius[i]};
    loads_[i] = {.work = w.contact_work[i]};
    batch::Group& group = groups_[i / batch::width];
    group.velocity_x[k] = p.velocity[i].x();
    group.velocity_y[k] = p.velocity[i].y();
    group.spin[k] = p.spin[i];
    group.rotation[k] = p.rotation[i];
    group.angle[k] = p.angle[i];
    group.push[k] = w.dt / p.mass[i];
    group.turn[k] = p.radius[i] * (w.dt / p.inertia[i]);
  }
}

void PaperBlocks::give_back(World& w, std::size_t begin, std::size_t end) const {
  Particles& p = w.particles;
  for (std::size_t i = begin; i < end; ++i) {
    const batch::Disc& disc = discs_[i];
    const batch::Group& group = groups_[i / batch::width];
    const std::size_t k = i % batch::width;
    p.position[i] = {disc.x, disc.y};
    p.displacement[i] = {disc.displacement_x, disc.displacement_y};
    p.velocity[i] = {group.velocity_x[k], group.velocity_y[k]};
    p.spin[i] = group.spin[k];
    p.rotation[i] = group.rotation[k];
    p.angle[i] = group.angle[k];
    w.contact_work[i] = loads_[i].work;
  }
}

void PaperBlocks::cut(PaperContacts& contacts) {
  const std::vector<PaperContacts::Pair>& pairs = contacts.pairs();
  std::size_t farthest_partner = 0;
  for (const PaperContacts::Pair& pair : pairs)
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
  for (std::size_t number = 0; number < blocks_.size(); ++number) {
    discs_[lone_disc(number)].x = nowhere;
    discs_[lone_disc(number) + 1].x = -nowhere;
  }
  loads_.resize(discs_.size());
}

void PaperBlocks::take_list(const PaperContacts& contacts, std::size_t block_number) {
  const Block& block = blocks_[block_number];
  for (std::size_t i = block.begin; i < block.end; ++i) {
    groups_[i / batch::width].listed_x[i % batch::width] = contacts.listed_at()[i].x();
    groups_[i / batch::width].listed_y[i % batch::width] = contacts.listed_at()[i].y();
  }
  const std::size_t places = block.batches() * batch::width;
  const std::size_t taken = block.last_pair - block.first_pair;
  for (std::size_t n = 0; n < places; ++n) {
    batch::Pairs& pairs = pairs_[block.first_batch + n / batch::width];
    const std::size_t k = n % batch::width;
    const auto lone = static_cast<std::uint32_t>(lone_disc(block_number));
    const PaperContacts::Pair pair =
        n < taken ? contacts.pairs()[block.first_pair + n] : PaperContacts::Pair{lone, lone + 1, {}};
    pairs.i[k] = pair.i;
    pairs.j[k] = pair.j;
    pairs.normal_spring[k] = pair.memory.touching ? pair.memory.normal : batch::not_touching;
    pairs.shear_spring[k] = pair.memory.shear;
  }
}

void PaperBlocks::give_back_list(PaperContacts& contacts, std::size_t block_number) const {
  const Block& block = blocks_[block_number];
  for (std::size_t n = 0; n < block.last_pair - block.first_pair; ++n) {
    const batch::Pairs& pairs = pairs_[block.first_batch + n / batch::width];
    const std::size_t k = n % batch::width;
    const bool touching = pairs.normal_spring[k] >= 0.0;
    contacts.pairs()[block.first_pair + n].memory =
        touching ? ContactSpring{pairs.normal_spring[k], pairs.shear_spring[k], true} : ContactSpring{};
  }
}

batch::Moved PaperBlocks::step(std::size_t block_number, const World& w, const Surfaces& surfaces,
                               std::span<SurfaceTotals> sums) {
  const Block& block = blocks_[block_number];
  batch::add_pair_forces({pairs_.data() + block.first_batch, block.batches()}, discs_.data(), loads_.data(),
                         w.particle_particle, w.dt);
  for (PaperContacts::OnSurface& contact : block.on_surfaces)
    surface_load(w, surfaces, contact, sums[contact.i / particles_in_sum]);
  return batch::move(block.end - block.begin, &groups_[block.begin / batch::width], &discs_[block.begin],
                     &loads_[block.begin], w.gravity, w.dt);
}

void PaperBlocks::surface_load(const World& w, const Surfaces& surfaces, PaperContacts::OnSurface& contact,
                               SurfaceTotals& totals) {
  const batch::Disc& disc = discs_[contact.i];
  const batch::Group& group = groups_[contact.i / batch::width];
  const std::size_t k = contact.i % batch::width;
  const DiscInMotion motion{{disc.x, disc.y},
                            disc.radius,
                            {disc.displacement_x, disc.displacement_y},
                            group.rotation[k],
                            {group.velocity_x[k], group.velocity_y[k]},
                            group.spin[k]};
  SurfaceForce f;
  if (!surface_force(TanakaLaw<DefaultReadings>{}, surfaces, w.particle_wall, w.dt, contact, motion, f)) return;
  const Vector2 on_disc = received(f.force, f.normal);
  batch::Load& load = loads_[contact.i];
  load.force_x += on_disc.x();
  load.force_y += on_disc.y();
  load.rim += f.lever * f.force.shear;
  load.work += f.work;
  totals.add(surfaces, contact.surface, motion.centre, on_disc);
}

}  // namespace crossdem
