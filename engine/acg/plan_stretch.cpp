#include "acg/plan_stretch.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kApart_m = 1.5;             ///< between lines; nearer ones say more about the pen than about the sheet
constexpr double kPriorStrips = 4;           ///< what is known of plans is worth this many strips
constexpr double kLeast = 0.6, kMost = 2.5;  ///< times what plans are like

/// Variance of the mean stretch over a strip, for a local stretch of variance 1.
double mean_variance(double width_m, double correlation_m) {
  const double w = width_m / correlation_m;
  return 2 * (w - 1 + std::exp(-w)) / (w * w);
}

}  // namespace

std::vector<double> seen_on_lines_m(const PlanModel& plan, std::size_t axis, const std::vector<WallState>& walls,
                                    const std::vector<double>& linked_m) {
  std::vector<double> seen_m(plan.lines[axis].size(), 0);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const int corner = plan.walls[w].corner_a;
    if (walls[w] == WallState::kConfirmed && plan.offset_axis(plan.walls[w]) == static_cast<int>(axis))
      seen_m[static_cast<std::size_t>(plan.line_of_corner[axis][static_cast<std::size_t>(corner)])] += linked_m[w];
  }
  return seen_m;
}

double learnt_stretch(const PlanModel& plan, const GraphState& state, const std::vector<WallState>& walls,
                      const std::vector<double>& linked_m, const AcgParams& params) {
  const double known = params.sigma_wall_log_length, scale = std::exp(state.log_scale);
  double squares = kPriorStrips * known * known, strips = kPriorStrips;
  for (const std::size_t axis : {0u, 1u}) {
    const std::vector<double> seen_m = seen_on_lines_m(plan, axis, walls, linked_m);
    std::size_t last = seen_m.size();
    for (std::size_t k = 0; k < seen_m.size(); ++k) {
      if (seen_m[k] < kLineSeen_m) continue;
      const double width = last < k ? plan.lines[axis][k] - plan.lines[axis][last] : 0;
      if (last < k && width < kApart_m) continue;
      if (last < k) {
        const double stretch = (state.lines[axis][k] - state.lines[axis][last]) / (scale * width) - 1;
        const double pen = 2 * std::pow(params.sigma_corner_draw_m / width, 2);
        squares += std::max(0.0, stretch * stretch - pen) / mean_variance(width, 0.6 * params.stretch_length_m);
        strips += 1;
      }
      last = k;
    }
  }
  return std::clamp(std::sqrt(squares / strips), kLeast * known, kMost * known);
}

}  // namespace smokemap
