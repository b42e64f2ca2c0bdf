#include "acg/wall_rivals.hpp"

#include <algorithm>
#include <cmath>

#include "acg/sensed_faces.hpp"

namespace smokemap {
namespace {

constexpr double kRivalFrom_m = 0.25;  ///< nearer is the same wall, with its thickness drawn wrong
constexpr double kRivalTo_m = 1.3;
constexpr double kRivalStep_m = 0.05;
constexpr double kRivalledWall_m = 0.6;  ///< shorter ones have like things beside them everywhere
constexpr double kRivalSeen = 0.7;       ///< share of the length
constexpr double kRivalLess = 0.15;      ///< a rival may be seen on this much less than the wall itself
constexpr double kAnotherWall_m = 0.25;

/// A wall along one axis: where it is across the axis, and from where to where along it.
struct Strip {
  std::size_t wall = 0;
  double at = 0, from = 0, to = 0, half = 0;

  double shared_m(const Strip& other) const { return std::min(to, other.to) - std::max(from, other.from); }
};

std::vector<Strip> strips_across(const PlanModel& plan, const GraphState& state, std::size_t axis) {
  const double heading = plan.axis_rad + static_cast<double>(axis) * kPi / 2 + state.turn;
  const Point2 across(std::cos(heading), std::sin(heading)), along(-across.y(), across.x());
  std::vector<Strip> out;
  for (std::size_t w = 0; w < plan.walls.size(); ++w) {
    if (!plan.walls[w].usable || plan.offset_axis(plan.walls[w]) != static_cast<int>(axis)) continue;
    const Segment2 s = state.segment(plan.walls[w]);
    const double a = along.dot(s.a), b = along.dot(s.b);
    out.push_back({w, across.dot(s.midpoint()), std::min(a, b), std::max(a, b), plan.walls[w].half_thickness_m});
  }
  return out;
}

}  // namespace

std::vector<double> wall_rivals_m(const std::vector<NodeView>& views, const std::vector<bool>& use_node,
                                  const PlanModel& plan, const GraphState& state, const std::vector<WallState>& walls) {
  std::vector<double> out(plan.walls.size(), 0);
  for (const std::size_t axis : {0u, 1u}) {
    const SensedFaces faces(views, use_node, state, plan.axis_rad + static_cast<double>(axis) * kPi / 2 + state.turn);
    const std::vector<Strip> strips = strips_across(plan, state, axis);
    for (const Strip& s : strips) {
      if (walls[s.wall] != WallState::kConfirmed || s.to - s.from < kRivalledWall_m) continue;
      const auto known = [&](double at) {
        return std::any_of(strips.begin(), strips.end(), [&](const Strip& o) {
          return o.wall != s.wall && walls[o.wall] != WallState::kMissing && std::abs(o.at - at) < kAnotherWall_m &&
                 s.shared_m(o) > 0.3 * (s.to - s.from);
        });
      };
      double best = std::max(kRivalSeen, faces.support(s.at, s.from, s.to, s.half) - kRivalLess);
      for (double away = kRivalFrom_m; away <= kRivalTo_m; away += kRivalStep_m)
        for (const double offset : {away, -away}) {
          const double seen = faces.support(s.at + offset, s.from, s.to, s.half);
          if (seen <= best || known(s.at + offset)) continue;
          best = seen;
          out[s.wall] = away;
        }
    }
  }
  return out;
}

}  // namespace smokemap
