#include "slam/pose_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace smokemap {
namespace {

/// A block of 2^level x 2^level shifts at one angle, and the most that any of them may score.
struct Block {
  int angle = 0;
  int x = 0, y = 0;  ///< lowest shift, cells from the middle of the window
  std::int64_t bound = 0;
  bool operator==(const Block&) const = default;
};

class Search {
 public:
  Search(const std::vector<Point2>& points, const LikelihoodGrid& grid, const SearchWindow& window)
      : grid_(grid),
        window_(window),
        half_cells_(static_cast<int>(std::ceil(window.half_m / grid.frame().resolution_m))) {
    double farthest = grid.frame().resolution_m;
    for (const Point2& p : points) farthest = std::max(farthest, p.norm());
    step_rad_ = 2 * std::asin(std::min(1.0, 0.5 * grid.frame().resolution_m / farthest));
    half_angles_ =
        std::min(static_cast<int>(std::ceil(window.half_rad / step_rad_)), static_cast<int>(kPi / step_rad_));
    for (int a = -half_angles_; a <= half_angles_; ++a) {
      const Pose2 turned(window.T_map_robot.translation(), window.T_map_robot.heading() + a * step_rad_);
      std::vector<Cell>& cells = cells_.emplace_back();
      const Eigen::Matrix2d R = turned.rotation();
      for (const Point2& p : points) cells.push_back(grid.frame().cell_of(R * p + turned.translation()));
    }
    most_ = 255 * static_cast<std::int64_t>(points.size());
  }

  /// The best block of level 0 that scores more than `beat`, at least `apart_cells` from `away_from`.
  std::optional<Block> best(std::int64_t beat, const Block* away_from = nullptr, int apart_cells = 0) {
    away_from_ = away_from;
    apart_cells_ = apart_cells;
    best_.reset();
    beat_ = beat;
    int level = 0;
    while (level + 1 < grid_.levels() && (1 << (level + 1)) <= 2 * half_cells_ + 1) ++level;
    std::vector<Block> blocks;
    for (int angle = 0; angle < static_cast<int>(cells_.size()); ++angle)
      for (int y = -half_cells_; y <= half_cells_; y += 1 << level)
        for (int x = -half_cells_; x <= half_cells_; x += 1 << level) blocks.push_back(bounded(level, angle, x, y));
    descend(level, blocks);
    return best_;
  }

  Pose2 pose_of(const Block& block) const {
    const double cell = grid_.frame().resolution_m;
    return {window_.T_map_robot.translation() + cell * Point2(block.x, block.y),
            window_.T_map_robot.heading() + (block.angle - half_angles_) * step_rad_};
  }
  std::int64_t most() const { return most_; }

 private:
  Block bounded(int level, int angle, int x, int y) const {
    std::int64_t sum = 0;
    for (const Cell& cell : cells_[static_cast<std::size_t>(angle)]) sum += grid_.most(level, cell.x + x, cell.y + y);
    return {angle, x, y, sum};
  }

  bool excluded(const Block& block) const {
    return away_from_ && std::max(std::abs(block.x - away_from_->x), std::abs(block.y - away_from_->y)) < apart_cells_;
  }

  void descend(int level, std::vector<Block>& blocks) {
    std::stable_sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) { return a.bound > b.bound; });
    for (const Block& block : blocks) {
      if (block.bound <= beat_) return;
      if (level == 0) {
        if (excluded(block)) continue;
        best_ = block;
        beat_ = block.bound;
        return;  // sorted: the rest is no better
      }
      const int half = 1 << (level - 1);
      std::vector<Block> parts;
      for (const int y : {block.y, block.y + half})
        for (const int x : {block.x, block.x + half})
          if (x <= half_cells_ && y <= half_cells_) parts.push_back(bounded(level - 1, block.angle, x, y));
      descend(level - 1, parts);
    }
  }

  const LikelihoodGrid& grid_;
  SearchWindow window_;
  int half_cells_ = 0, half_angles_ = 0;
  double step_rad_ = 0;
  std::vector<std::vector<Cell>> cells_;  ///< of the points, per angle, unshifted
  std::int64_t most_ = 0, beat_ = 0;
  std::optional<Block> best_;
  const Block* away_from_ = nullptr;
  int apart_cells_ = 0;
};

}  // namespace

std::optional<SearchResult> search_pose(const std::vector<Point2>& points_robot, const LikelihoodGrid& grid,
                                        const SearchWindow& window, double least_score, double apart_m) {
  if (points_robot.empty()) return std::nullopt;
  Search search(points_robot, grid, window);
  const auto most = static_cast<double>(search.most());
  const auto least = static_cast<std::int64_t>(std::ceil(least_score * most)) - 1;
  const std::optional<Block> best = search.best(least);
  if (!best) return std::nullopt;
  SearchResult result{search.pose_of(*best), static_cast<double>(best->bound) / most, 0};
  if (apart_m <= 0) return result;
  const int apart_cells = std::max(1, static_cast<int>(std::round(apart_m / grid.frame().resolution_m)));
  // Only a runner-up that comes near the winner is of interest: bounding it keeps the second search short.
  const auto second = search.best(std::max(least, static_cast<std::int64_t>(0.8 * static_cast<double>(best->bound))),
                                  &*best, apart_cells);
  if (second) result.runner_up_score = static_cast<double>(second->bound) / most;
  return result;
}

}  // namespace smokemap
