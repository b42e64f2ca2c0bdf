#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "grids/grid_frame.hpp"

namespace smokemap {

/// A cell of an NDT-OM: the distribution of the points in it, and how occupied it is.
struct NdtCell {
  int count = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();  ///< sum of (p - mean)(p - mean)^T
  double log_odds = 0;                                ///< of being occupied; < 0: seen free

  bool has_gaussian() const { return count >= 3 && log_odds > 0; }
  /// Sample covariance, eigenvalues raised to at least `smallest` times the larger one. Needs count >= 2.
  Eigen::Matrix2d covariance(double smallest = 0.001) const;
  /// Direction of the larger spread: along the wall. Radians.
  double main_direction() const;
};

/// Normal Distributions Transform occupancy map: one Gaussian a cell, free cells remembered, unbounded, sparse.
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

}  // namespace smokemap
