#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/expect.hpp"
#include "grids/grid_frame.hpp"
#include "grids/ray.hpp"

namespace smokemap {

/// A cell of an NDT-OM: the distribution of the points in it, and how occupied it is.
struct NdtCell {
  int count = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();  ///< sum of (p - mean)(p - mean)^T
  double log_odds = 0;                                ///< of being occupied; < 0: seen free

  bool has_gaussian() const { return count >= 3 && log_odds > 0; }
  void shift(double by) { log_odds = std::clamp(log_odds + by, -6.0, 6.0); }
  /// Sample covariance, eigenvalues raised to at least `smallest` times the larger one. Needs count >= 2.
  Eigen::Matrix2d covariance(double smallest = 0.001) const;
  /// Direction of the larger spread: along the wall. Radians.
  double main_direction() const;
};

/// The peer of bench ndt and bench slam-fields, not part of the product (slam/align.hpp and features/corners.hpp say
/// why). Normal Distributions Transform occupancy map: one Gaussian a cell, free cells remembered, unbounded, sparse.
/// Source: Saarinen et al., NDT-OM (IROS 2013); differs: exact running mean and scatter, fixed log-odds step a point.
class NdtGrid {
 public:
  explicit NdtGrid(double cell_m = 0.5) : cell_m_(cell_m) {}

  /// A beam from `origin` that ended at `end`: the end joins its cell, cells passed become freer.
  void add_hit(const Eigen::Vector2d& origin, const Eigen::Vector2d& end);
  /// Cells passed become freer.
  void add_free(const Eigen::Vector2d& origin, const Eigen::Vector2d& end);
  /// A point without a beam.
  void add_point(const Eigen::Vector2d& p);

  /// Null where nothing was seen. Valid until the next add.
  const NdtCell* find(Cell cell) const;
  const NdtCell* at(const Eigen::Vector2d& p) const { return find(cell_of(p)); }
  Cell cell_of(const Eigen::Vector2d& p) const;
  Eigen::Vector2d center_of(Cell cell) const { return cell_m_ * Eigen::Vector2d(cell.x + 0.5, cell.y + 0.5); }
  /// Every seen cell, by row and column.
  std::vector<Cell> cells() const;
  double cell_m() const { return cell_m_; }

 private:
  void clear_along(const Eigen::Vector2d& origin, const Eigen::Vector2d& end, bool up_to_end);
  NdtCell& touch(Cell cell);

  double cell_m_;
  std::unordered_map<std::uint64_t, NdtCell> cells_;
};

inline std::uint64_t ndt_cell_key(Cell cell) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.y)) << 32) | static_cast<std::uint32_t>(cell.x);
}

inline Cell ndt_cell_from(std::uint64_t key) {
  return {static_cast<std::int32_t>(static_cast<std::uint32_t>(key)),
          static_cast<std::int32_t>(static_cast<std::uint32_t>(key >> 32))};
}

inline Eigen::Matrix2d NdtCell::covariance(double smallest) const {
  ENGINE_EXPECT(count >= 2);
  const Eigen::Matrix2d cov = scatter / (count - 1);
  const double half_gap = std::hypot(0.5 * (cov(0, 0) - cov(1, 1)), cov(0, 1)), middle = 0.5 * cov.trace();
  const double large = middle + half_gap, small = std::max(middle - half_gap, smallest * large);
  const double along = main_direction();
  const Eigen::Vector2d d(std::cos(along), std::sin(along)), n(-d.y(), d.x());
  return large * d * d.transpose() + small * n * n.transpose();
}

inline double NdtCell::main_direction() const {
  return 0.5 * std::atan2(2 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
}

inline Cell NdtGrid::cell_of(const Eigen::Vector2d& p) const {
  return {static_cast<int>(std::floor(p.x() / cell_m_)), static_cast<int>(std::floor(p.y() / cell_m_))};
}

inline NdtCell& NdtGrid::touch(Cell cell) { return cells_[ndt_cell_key(cell)]; }

inline const NdtCell* NdtGrid::find(Cell cell) const {
  const auto found = cells_.find(ndt_cell_key(cell));
  return found == cells_.end() ? nullptr : &found->second;
}

inline void NdtGrid::add_point(const Eigen::Vector2d& p) {
  NdtCell& cell = touch(cell_of(p));
  ++cell.count;
  const Eigen::Vector2d before = p - cell.mean;
  cell.mean += before / cell.count;
  cell.scatter += before * (p - cell.mean).transpose();  // Welford
  cell.scatter(0, 1) = cell.scatter(1, 0) = 0.5 * (cell.scatter(0, 1) + cell.scatter(1, 0));
  cell.shift(0.6);
}

inline void NdtGrid::add_hit(const Eigen::Vector2d& origin, const Eigen::Vector2d& end) {
  clear_along(origin, end, false);
  add_point(end);
}

inline void NdtGrid::add_free(const Eigen::Vector2d& origin, const Eigen::Vector2d& end) {
  clear_along(origin, end, true);
}

inline void NdtGrid::clear_along(const Eigen::Vector2d& origin, const Eigen::Vector2d& end, bool up_to_end) {
  GridFrame frame;
  frame.resolution_m = cell_m_;
  const Cell last = cell_of(end);
  walk_ray(frame, origin, end, [&](Cell cell) {
    if (up_to_end || !(cell == last)) touch(cell).shift(-0.1);
    return true;
  });
}

inline std::vector<Cell> NdtGrid::cells() const {
  std::vector<Cell> all;
  all.reserve(cells_.size());
  for (const auto& [key, cell] : cells_) all.push_back(ndt_cell_from(key));
  std::sort(all.begin(), all.end(), [](Cell a, Cell b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return all;
}

}  // namespace smokemap
