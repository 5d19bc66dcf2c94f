#include "paper_batches.hpp"

namespace crossdem {
namespace {

constexpr double nowhere = 1e9;                   // [m]
constexpr std::size_t particles_in_block = 1024;  // about 200 kB with their pairs

std::size_t whole(std::size_t count) { return (count + batch::width - 1) / batch::width; }

}  // namespace

void BatchedPaperStepper::take(const World& w) {
  const Particles& p = w.particles;
  groups_.assign(whole(p.count()), {});
  discs_.assign(groups_.size() * batch::width + 2, {});
  loads_.assign(discs_.size(), {});
  for (std::size_t i = 0; i < p.count(); ++i) {
    discs_[i] = {.x = p.position[i].x(),
                 .y = p.position[i].y(),
                 .displacement_x = p.displacement[i].x(),
                 .displacement_y = p.displacement[i].y(),
                 .roll = p.radius[i] * p.rotation[i],
                 .radius = p.radius[i]};
    batch::Group& group = groups_[i / batch::width];
    const std::size_t k = i % batch::width;
    group.velocity_x[k] = p.velocity[i].x();
    group.velocity_y[k] = p.velocity[i].y();
    group.spin[k] = p.spin[i];
    group.rotation[k] = p.rotation[i];
    group.angle[k] = p.angle[i];
    group.work[k] = w.contact_work[i];
    group.push[k] = w.dt / p.mass[i];
    group.turn[k] = p.radius[i] * (w.dt / p.inertia[i]);
    group.listed_x[k] = contacts().listed_at()[i].x();
    group.listed_y[k] = contacts().listed_at()[i].y();
  }

  const auto lone = static_cast<std::uint32_t>(discs_.size() - 2);
  discs_[lone].x = nowhere;
  discs_[lone + 1].x = -nowhere;
  blocks_.clear();
  pairs_.clear();
  auto pair = contacts().pairs().cbegin();
  std::size_t on_surface = 0;
  for (std::size_t begin = 0; begin < p.count(); begin += particles_in_block) {
    const std::size_t end = std::min(begin + particles_in_block, p.count());
    Block block{{begin, end}, {pairs_.size(), 0}, {on_surface, 0}};
    for (std::size_t n = 0; pair != contacts().pairs().cend() && pair->i < end; ++n, ++pair) {
      const std::size_t k = n % batch::width;
      if (k == 0) {
        pairs_.emplace_back();
        pairs_.back().i.fill(lone);
        pairs_.back().j.fill(lone + 1);
        pairs_.back().normal_spring.fill(batch::not_touching);
      }
      pairs_.back().i[k] = pair->i;
      pairs_.back().j[k] = pair->j;
      pairs_.back().normal_spring[k] = pair->memory.touching ? pair->memory.normal : batch::not_touching;
      pairs_.back().shear_spring[k] = pair->memory.shear;
    }
    while (on_surface < contacts().on_surfaces().size() && contacts().on_surfaces()[on_surface].i < end) ++on_surface;
    block.pairs.end = pairs_.size();
    block.on_surfaces.end = on_surface;
    blocks_.push_back(block);
  }
}

void BatchedPaperStepper::give_back(World& w) {
  Particles& p = w.particles;
  for (std::size_t i = 0; i < p.count(); ++i) {
    const batch::Disc& disc = discs_[i];
    const batch::Group& group = groups_[i / batch::width];
    const std::size_t k = i % batch::width;
    p.position[i] = {disc.x, disc.y};
    p.displacement[i] = {disc.displacement_x, disc.displacement_y};
    p.velocity[i] = {group.velocity_x[k], group.velocity_y[k]};
    p.spin[i] = group.spin[k];
    p.rotation[i] = group.rotation[k];
    p.angle[i] = group.angle[k];
    w.contact_work[i] = group.work[k];
  }
  auto pair = contacts().pairs().begin();
  for (const Block& block : blocks_) {
    for (std::size_t n = 0; pair != contacts().pairs().end() && pair->i < block.particles.end; ++n, ++pair) {
      const batch::Pairs& pairs = pairs_[block.pairs.begin + n / batch::width];
      const std::size_t k = n % batch::width;
      const bool touching = pairs.normal_spring[k] >= 0.0;
      pair->memory = touching ? ContactSpring{pairs.normal_spring[k], pairs.shear_spring[k], true} : ContactSpring{};
    }
  }
}

}  // namespace crossdem
