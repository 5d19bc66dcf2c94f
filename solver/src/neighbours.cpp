#include "neighbours.hpp"

#include <algorithm>

namespace crossdem {
namespace {

/// Particles sorted by square cells that are as wide as the largest distance of interest: partners of a particle are in
/// its own cell or in the eight around it.
class CellGrid {
 public:
  CellGrid(const Particles& particles, double cell_size) : cell_size_(cell_size) {
    Vector2 high = particles.position.front();
    low_ = high;
    for (const Vector2& at : particles.position) {
      low_ = low_.cwiseMin(at);
      high = high.cwiseMax(at);
    }
    // A few particles far away must not make a grid of mostly empty cells: beyond the cap, outer cells hold more.
    const int cap = 4 + static_cast<int>(particles.count());
    columns_ = std::clamp(1 + cell(high.x() - low_.x(), cap), 1, cap);
    rows_ = std::clamp(1 + cell(high.y() - low_.y(), cap), 1, std::max(1, 4 * cap / columns_));

    first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (const Vector2& at : particles.position) ++first_[index(column(at), row(at)) + 1];
    for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
    members_.resize(particles.count());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < particles.count(); ++i)
      members_[next[index(column(particles.position[i]), row(particles.position[i]))]++] = i;
  }

  template <class Visit>
  void for_each_near(const Vector2& at, Visit visit) const {
    const int last_column = std::min(column(at) + 1, columns_ - 1);
    const int last_row = std::min(row(at) + 1, rows_ - 1);
    for (int r = std::max(row(at) - 1, 0); r <= last_row; ++r)
      for (std::uint32_t k = first_[index(std::max(column(at) - 1, 0), r)]; k < first_[index(last_column, r) + 1]; ++k)
        visit(members_[k]);
  }

 private:
  [[nodiscard]] int cell(double offset, int last) const {
    return static_cast<int>(std::min(offset / cell_size_, static_cast<double>(last)));
  }
  [[nodiscard]] int column(const Vector2& at) const { return cell(at.x() - low_.x(), columns_ - 1); }
  [[nodiscard]] int row(const Vector2& at) const { return cell(at.y() - low_.y(), rows_ - 1); }
  [[nodiscard]] std::size_t index(int at_column, int at_row) const {
    return static_cast<std::size_t>(at_row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(at_column);
  }

  double cell_size_;  // [m]
  Vector2 low_;       // [m], corner of the grid
  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::uint32_t> first_;    // of each cell in members_; a row's cells lie side by side
  std::vector<std::uint32_t> members_;  // particles, cell by cell
};

}  // namespace

std::vector<ParticlePair> close_pairs(const Particles& particles, double gap, Crew& crew) {
  if (particles.count() < 2) return {};
  const double largest = *std::max_element(particles.radius.begin(), particles.radius.end());
  const CellGrid grid(particles, 2 * largest + gap);
  std::vector<ParticlePair> found =
      gathered<ParticlePair>(particles.count(), crew, [&](std::size_t begin, std::size_t end) {
        std::vector<ParticlePair> pairs;
        // More than discs of like size have in two dimensions, each counted once; the first takes in the others.
        pairs.reserve(4 * (begin == 0 ? particles.count() : end - begin));
        std::vector<std::uint32_t> partners;
        for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
          partners.clear();
          grid.for_each_near(particles.position[i], [&](std::uint32_t j) {
            if (j > i && closer_than(gap, particles, {i, j})) partners.push_back(j);
          });
          std::sort(partners.begin(), partners.end());
          for (const std::uint32_t j : partners) pairs.push_back({i, j});
        }
        return pairs;
      });
  found.shrink_to_fit();
  return found;
}

}  // namespace crossdem
