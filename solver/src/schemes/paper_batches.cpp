#include "paper_batches.hpp"

namespace crossdem {
namespace {

constexpr double nowhere = 1e9;  // [m]

std::size_t whole(std::size_t count) { return (count + batch::width - 1) / batch::width; }

}  // namespace

void BatchedPaperStepper::take(const World& w) {
  const Particles& p = w.particles;
  groups_.assign(whole(p.count()), {});
  for (batch::Group& group : groups_) {
    group.mass.fill(1.0);
    group.inertia.fill(1.0);
  }
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
    group.mass[k] = p.mass[i];
    group.inertia[k] = p.inertia[i];
    group.work[k] = w.contact_work[i];
    group.listed_x[k] = contacts().listed_at()[i].x();
    group.listed_y[k] = contacts().listed_at()[i].y();
  }

  const auto lone = static_cast<std::uint32_t>(discs_.size() - 2);
  discs_[lone].x = nowhere;
  discs_[lone + 1].x = -nowhere;
  const std::vector<PaperContacts::Pair>& listed = contacts().pairs();
  pairs_.resize(whole(listed.size()));
  for (std::size_t n = 0; n < pairs_.size() * batch::width; ++n) {
    batch::Pairs& pairs = pairs_[n / batch::width];
    const std::size_t k = n % batch::width;
    const PaperContacts::Pair pair = n < listed.size() ? listed[n] : PaperContacts::Pair{lone, lone + 1, {}};
    pairs.i[k] = pair.i;
    pairs.j[k] = pair.j;
    pairs.normal_spring[k] = pair.memory.touching ? pair.memory.normal : batch::not_touching;
    pairs.shear_spring[k] = pair.memory.shear;
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
  std::vector<PaperContacts::Pair>& listed = contacts().pairs();
  for (std::size_t n = 0; n < listed.size(); ++n) {
    const batch::Pairs& pairs = pairs_[n / batch::width];
    const std::size_t k = n % batch::width;
    const bool touching = pairs.normal_spring[k] >= 0.0;
    listed[n].memory = touching ? ContactSpring{pairs.normal_spring[k], pairs.shear_spring[k], true} : ContactSpring{};
  }
}

}  // namespace crossdem
