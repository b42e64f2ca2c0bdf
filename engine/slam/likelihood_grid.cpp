#include "slam/likelihood_grid.hpp"

#include <algorithm>
#include <cmath>

#include "core/expect.hpp"

namespace smokemap {
namespace {

GridFrame frame_of(const std::vector<Point2>& points, double cell_m, double margin_m) {
  Point2 low = Point2::Zero(), high = Point2::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    low = i == 0 ? points[i] : Point2(low.cwiseMin(points[i]));
    high = i == 0 ? points[i] : Point2(high.cwiseMax(points[i]));
  }
  return frame_around(low, high, cell_m, margin_m);
}

}  // namespace

LikelihoodGrid::LikelihoodGrid(const std::vector<Point2>& points, double cell_m, double sigma_m, int levels)
    : frame_(frame_of(points, cell_m, 3 * sigma_m + cell_m)) {
  ENGINE_EXPECT(levels >= 1);
  Level base{0, frame_.width_cells, frame_.height_cells, std::vector<std::uint8_t>(frame_.cell_count(), 0)};
  const int reach = static_cast<int>(std::ceil(3 * sigma_m / cell_m));
  for (const Point2& p : points) {
    const Cell middle = frame_.cell_of(p);
    for (int y = middle.y - reach; y <= middle.y + reach; ++y)
      for (int x = middle.x - reach; x <= middle.x + reach; ++x) {
        if (!frame_.contains({x, y})) continue;
        const double squared = (frame_.center_of({x, y}) - p).squaredNorm() / (sigma_m * sigma_m);
        if (squared > 9) continue;
        const auto value = static_cast<std::uint8_t>(255.0 * std::exp(-0.5 * squared));
        std::uint8_t& cell = base.value[frame_.index({x, y})];
        cell = std::max(cell, value);
      }
  }
  levels_.push_back(std::move(base));
  for (int k = 1; k < levels; ++k) levels_.push_back(coarser(levels_.back(), 1 << (k - 1)));
}

/// Windows twice as wide: the larger of four windows, `reach_cells` apart.
LikelihoodGrid::Level LikelihoodGrid::coarser(const Level& fine, int reach_cells) {
  Level coarse{fine.pad + reach_cells, fine.width + reach_cells, fine.height + reach_cells, {}};
  const auto width = static_cast<std::size_t>(coarse.width);
  coarse.value.assign(width * static_cast<std::size_t>(coarse.height), 0);
  std::vector<std::uint8_t> wide(width * static_cast<std::size_t>(fine.height), 0);  // maxima along rows first
  for (int y = 0; y < fine.height; ++y) {
    const std::uint8_t* in = &fine.value[static_cast<std::size_t>(y) * static_cast<std::size_t>(fine.width)];
    std::uint8_t* out = &wide[static_cast<std::size_t>(y) * width];
    for (int x = 0; x < fine.width; ++x) {
      out[x] = std::max(out[x], in[x]);  // as the far half of the window that begins reach_cells before
      out[x + reach_cells] = std::max(out[x + reach_cells], in[x]);
    }
  }
  for (int y = 0; y < fine.height; ++y) {
    const std::uint8_t* in = &wide[static_cast<std::size_t>(y) * width];
    for (const int to : {y, y + reach_cells}) {
      std::uint8_t* out = &coarse.value[static_cast<std::size_t>(to) * width];
      for (std::size_t x = 0; x < width; ++x) out[x] = std::max(out[x], in[x]);
    }
  }
  return coarse;
}

}  // namespace smokemap
