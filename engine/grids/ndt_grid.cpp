#include "grids/ndt_grid.hpp"

#include <algorithm>
#include <cmath>

#include "core/expect.hpp"
#include "grids/ray.hpp"

namespace smokemap {
namespace {

constexpr double kHitLogOdds = 0.6, kPassLogOdds = -0.1, kClampLogOdds = 6.0;

std::uint64_t cell_key(Cell cell) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.y)) << 32) | static_cast<std::uint32_t>(cell.x);
}

Cell cell_from(std::uint64_t key) {
  return {static_cast<std::int32_t>(static_cast<std::uint32_t>(key)),
          static_cast<std::int32_t>(static_cast<std::uint32_t>(key >> 32))};
}

void shift(NdtCell& cell, double by) { cell.log_odds = std::clamp(cell.log_odds + by, -kClampLogOdds, kClampLogOdds); }

}  // namespace

Eigen::Matrix2d NdtCell::covariance(double smallest) const {
  ENGINE_EXPECT(count >= 2);
  const Eigen::Matrix2d cov = scatter / (count - 1);
  const double half_gap = std::hypot(0.5 * (cov(0, 0) - cov(1, 1)), cov(0, 1)), middle = 0.5 * cov.trace();
  const double large = middle + half_gap, small = std::max(middle - half_gap, smallest * large);
  const double along = main_direction();
  const Eigen::Vector2d d(std::cos(along), std::sin(along)), n(-d.y(), d.x());
  return large * d * d.transpose() + small * n * n.transpose();
}

double NdtCell::main_direction() const { return 0.5 * std::atan2(2 * scatter(0, 1), scatter(0, 0) - scatter(1, 1)); }

Cell NdtGrid::cell_of(const Eigen::Vector2d& p) const {
  return {static_cast<int>(std::floor(p.x() / cell_m_)), static_cast<int>(std::floor(p.y() / cell_m_))};
}

NdtCell& NdtGrid::touch(Cell cell) { return cells_[cell_key(cell)]; }

const NdtCell* NdtGrid::find(Cell cell) const {
  const auto found = cells_.find(cell_key(cell));
  return found == cells_.end() ? nullptr : &found->second;
}

void NdtGrid::add_point(const Eigen::Vector2d& p) {
  NdtCell& cell = touch(cell_of(p));
  ++cell.count;
  const Eigen::Vector2d before = p - cell.mean;
  cell.mean += before / cell.count;
  cell.scatter += before * (p - cell.mean).transpose();  // Welford
  cell.scatter(0, 1) = cell.scatter(1, 0) = 0.5 * (cell.scatter(0, 1) + cell.scatter(1, 0));
  shift(cell, kHitLogOdds);
}

void NdtGrid::add_hit(const Eigen::Vector2d& origin, const Eigen::Vector2d& end) {
  clear_along(origin, end, false);
  add_point(end);
}

void NdtGrid::add_free(const Eigen::Vector2d& origin, const Eigen::Vector2d& end) { clear_along(origin, end, true); }

void NdtGrid::clear_along(const Eigen::Vector2d& origin, const Eigen::Vector2d& end, bool up_to_end) {
  GridFrame frame;
  frame.resolution_m = cell_m_;
  const Cell last = cell_of(end);
  walk_ray(frame, origin, end, [&](Cell cell) {
    if (up_to_end || !(cell == last)) shift(touch(cell), kPassLogOdds);
    return true;
  });
}

std::vector<Cell> NdtGrid::cells() const {
  std::vector<Cell> all;
  all.reserve(cells_.size());
  for (const auto& [key, cell] : cells_) all.push_back(cell_from(key));
  std::sort(all.begin(), all.end(), [](Cell a, Cell b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return all;
}

}  // namespace smokemap
