#include "grids/log_odds_grid.hpp"

#include <algorithm>
#include <cmath>

#include "grids/ray.hpp"

namespace smokemap {
namespace {
constexpr double kGrowBy_m = 10.0;  ///< room added on each side, so that growing is rare
}

LogOddsGrid::LogOddsGrid(double resolution_m, const LogOddsParams& params) : params_(params) {
  frame_.resolution_m = resolution_m;
}

void LogOddsGrid::clear() {
  frame_ = GridFrame{frame_.resolution_m, Eigen::Vector2d::Zero(), 0, 0};
  counts_.clear();
}

void LogOddsGrid::grow(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double margin_m) {
  if (!counts_.empty() && frame_.contains(frame_.cell_of(low)) && frame_.contains(frame_.cell_of(high))) return;
  Eigen::Vector2d from = low, to = high;
  if (!counts_.empty()) {
    const Eigen::Vector2d size(frame_.width_cells, frame_.height_cells);
    from = from.cwiseMin(frame_.origin);
    to = to.cwiseMax(Eigen::Vector2d(frame_.origin + size * frame_.resolution_m));
  }
  const GridFrame wider = frame_around(from, to, frame_.resolution_m, margin_m);
  std::vector<Counts> moved(wider.cell_count());
  if (!counts_.empty()) {
    const Cell shift = wider.cell_of(frame_.center_of({0, 0}));
    for (int y = 0; y < frame_.height_cells; ++y) {
      const auto row = counts_.begin() + static_cast<std::ptrdiff_t>(frame_.index({0, y}));
      std::copy(row, row + frame_.width_cells,
                moved.begin() + static_cast<std::ptrdiff_t>(wider.index({shift.x, y + shift.y})));
    }
  }
  frame_ = wider;
  counts_ = std::move(moved);
}

void LogOddsGrid::trace(const Eigen::Vector2d& origin, const Eigen::Vector2d& end, bool hit, int times,
                        double grazed_m) {
  if (!origin.allFinite() || !end.allFinite()) return;
  grow(origin.cwiseMin(end), origin.cwiseMax(end), kGrowBy_m);
  const Cell last = frame_.cell_of(end);
  walk_ray(frame_, origin, end, [&](Cell cell) {
    Counts& counts = counts_[frame_.index(cell)];
    if (cell == last && hit)
      counts.hits += times;
    else if (grazed_m <= 0 || (frame_.center_of(cell) - end).squaredNorm() > grazed_m * grazed_m)
      counts.passes += times;
    return true;
  });
}

double LogOddsGrid::log_odds(Cell cell) const {
  if (!frame_.contains(cell)) return 0;
  const Counts& counts = counts_[frame_.index(cell)];
  return std::clamp(counts.hits * params_.hit + counts.passes * params_.pass, -params_.clamp, params_.clamp);
}

bool LogOddsGrid::seen(Cell cell) const {
  if (!frame_.contains(cell)) return false;
  const Counts& counts = counts_[frame_.index(cell)];
  return counts.hits != 0 || counts.passes != 0;
}

std::int8_t LogOddsGrid::percent(const Counts& counts) const {
  if (counts.hits == 0 && counts.passes == 0) return OccupancyGrid::kUnknown;
  const double sum =
      std::clamp(counts.hits * params_.hit + counts.passes * params_.pass, -params_.clamp, params_.clamp);
  return static_cast<std::int8_t>(std::lround(100.0 / (1.0 + std::exp(-sum))));
}

OccupancyGrid LogOddsGrid::occupancy(int margin_cells) const {
  Cell low{frame_.width_cells, frame_.height_cells}, high{-1, -1};
  for (int y = 0; y < frame_.height_cells; ++y)
    for (int x = 0; x < frame_.width_cells; ++x) {
      const Counts& counts = counts_[frame_.index({x, y})];
      if (counts.hits == 0 && counts.passes == 0) continue;
      low = {std::min(low.x, x), std::min(low.y, y)};
      high = {std::max(high.x, x), std::max(high.y, y)};
    }
  if (high.x < 0) return {};
  GridFrame frame;
  frame.resolution_m = frame_.resolution_m;
  frame.origin = frame_.origin + frame_.resolution_m * Eigen::Vector2d(low.x - margin_cells, low.y - margin_cells);
  frame.width_cells = high.x - low.x + 1 + 2 * margin_cells;
  frame.height_cells = high.y - low.y + 1 + 2 * margin_cells;
  OccupancyGrid grid(frame);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x)
      grid.at({x - low.x + margin_cells, y - low.y + margin_cells}) = percent(counts_[frame_.index({x, y})]);
  return grid;
}

}  // namespace smokemap
