#include "acg/line_search.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kShareSays = 2.0;   ///< log odds of a wall that was seen on its whole length
constexpr double kLengthSays = 2.0;  ///< more for one that was seen at least on kFullSay_m
constexpr double kFullSay_m = 1.5;
constexpr double kHeldSays = 30.0;  ///< log odds of a line that a person holds
constexpr double kHeld_m = 0.15;
constexpr double kStartSays = 8.0;          ///< most that the start may say
constexpr double kStretchFromStart = 0.10;  ///< of the way from the start to a line

Point2 axis_direction(const PlanModel& plan, std::size_t axis, double turn) {
  const double heading = plan.axis_rad + static_cast<double>(axis) * kPi / 2 + turn;
  return {std::cos(heading), std::sin(heading)};
}

double place_offset_m(std::size_t place) {
  return (static_cast<double>(place) - LineChain::kReach_cells) * LineChain::kCell_m;
}

/// Where the corners of each line are now; corners may have let go of their line.
std::vector<double> lines_now_m(const PlanModel& plan, const GraphState& state, std::size_t axis) {
  const Point2 across = axis_direction(plan, axis, state.turn);
  std::vector<double> sum(plan.lines[axis].size(), 0), count(sum);
  for (std::size_t c = 0; c < plan.corners.size(); ++c) {
    const auto line = static_cast<std::size_t>(plan.line_of_corner[axis][c]);
    sum[line] += across.dot(state.corner(static_cast<int>(c)));
    count[line] += 1;
  }
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] /= std::max(1.0, count[k]);
  return sum;
}

/// The share of it that was seen tells a wall from others like it; that a metre or two of it was seen at all tells a
/// place with a wall from one without.
double log_odds(double share, double length_m) {
  return kShareSays * share * std::min(1.0, length_m / kFullSay_m) +
         kLengthSays * std::clamp(share * length_m / kFullSay_m, -1.0, 1.0);
}

/// Every wall square to the axis, at every place its line may have.
void hear_walls(const SensedFaces& faces, const PlanModel& plan, const GraphState& state, std::size_t axis,
                const LineHolds& holds, LineChain& chain) {
  const Point2 across = axis_direction(plan, axis, state.turn), along(-across.y(), across.x());
  for (std::size_t w = 0; w < plan.walls.size(); ++w) {
    const PlanEdge& wall = plan.walls[w];
    if (!wall.usable || plan.offset_axis(wall) != static_cast<int>(axis) || holds.gone[w]) continue;
    const Segment2 s = state.segment(wall);
    const auto line = static_cast<std::size_t>(plan.line_of_corner[axis][static_cast<std::size_t>(wall.corner_a)]);
    const double at = across.dot(s.midpoint()), from = along.dot(s.a), to = along.dot(s.b);
    for (std::size_t place = 0; place < chain.support[line].size(); ++place)
      chain.support[line][place] += static_cast<float>(
          log_odds(faces.support(at + place_offset_m(place), from, to, wall.half_thickness_m), wall.length_m));
  }
}

void hear_people(const PlanModel& plan, std::size_t axis, const LineHolds& holds, LineChain& chain) {
  for (const int corner : holds.held_corners) {
    auto& support =
        chain.support[static_cast<std::size_t>(plan.line_of_corner[axis][static_cast<std::size_t>(corner)])];
    for (std::size_t place = 0; place < support.size(); ++place)
      if (std::abs(place_offset_m(place)) > kHeld_m) support[place] -= static_cast<float>(kHeldSays);
  }
}

/// The lines on both sides of where the robot began lie as far from it as they are drawn.
void hear_start(const PlanModel& plan, const GraphState& state, std::size_t axis, const LineHolds& holds,
                LineChain& chain) {
  if (!holds.start_map) return;
  const double drawn = axis_direction(plan, axis, 0).dot(holds.start_layout);
  const double now = axis_direction(plan, axis, state.turn).dot(*holds.start_map), scale = std::exp(state.log_scale);
  const auto& lines = plan.lines[axis];
  const auto after = static_cast<std::size_t>(std::lower_bound(lines.begin(), lines.end(), drawn) - lines.begin());
  for (const std::size_t line : {after, after - 1}) {
    if (line >= lines.size()) continue;
    const double away = scale * (lines[line] - drawn),
                 sigma = std::hypot(holds.start_sigma_m, kStretchFromStart * away);
    for (std::size_t place = 0; place < chain.support[line].size(); ++place) {
      const double z = (chain.now_m[line] + place_offset_m(place) - now - away) / sigma;
      chain.support[line][place] -= static_cast<float>(std::min(kStartSays, 0.5 * z * z));
    }
  }
}

}  // namespace

std::array<std::vector<LineBelief>, 2> search_lines(const std::vector<NodeView>& views,
                                                    const std::vector<bool>& use_node, const PlanModel& plan,
                                                    const GraphState& state, const LineHolds& holds,
                                                    const AcgParams& params) {
  std::array<std::vector<LineBelief>, 2> out;
  for (const std::size_t axis : {0u, 1u}) {
    LineChain chain;
    for (const double drawn : plan.lines[axis]) chain.drawn_m.push_back(std::exp(state.log_scale) * drawn);
    chain.now_m = lines_now_m(plan, state, axis);
    chain.support.resize(chain.now_m.size());
    for (auto& support : chain.support) support.fill(0);
    chain.sigma_stretch = params.sigma_wall_log_length;
    chain.correlation_m = 0.6 * params.stretch_length_m;
    const SensedFaces faces(views, use_node, state, plan.axis_rad + static_cast<double>(axis) * kPi / 2 + state.turn);
    hear_walls(faces, plan, state, axis, holds, chain);
    hear_people(plan, axis, holds, chain);
    hear_start(plan, state, axis, holds, chain);
    out[axis] = arrange_lines(chain);
  }
  return out;
}

void move_lines(const PlanModel& plan, std::size_t axis, const std::vector<double>& moves_m, GraphState& state) {
  const Point2 across = axis_direction(plan, axis, state.turn);
  for (std::size_t c = 0; c < plan.corners.size(); ++c) {
    const auto line = static_cast<std::size_t>(plan.line_of_corner[axis][c]);
    const Point2 p = state.corner(static_cast<int>(c)) + moves_m[line] * across;
    state.corners[c] = {p.x(), p.y()};
  }
  state.lines[axis] = lines_now_m(plan, state, axis);
}

}  // namespace smokemap
