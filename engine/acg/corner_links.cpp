#include "acg/corner_links.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kLikeAngle_rad = kPi / 4;
constexpr double kStraight_rad = 0.5;  ///< sectors this near to half a turn are no corners
constexpr double kReach_m = 8.0;       ///< corners farther from the robot are not sure enough
constexpr double kAgree_m = 0.15;      ///< two links of a node that shift the scan alike bear each other out
constexpr double kAlone = 0.1;         ///< weight of a link that nothing bears out

struct Arm {
  int wall = 0;
  double heading_rad = 0;  ///< away from the corner
  double half_m = 0;
};

std::vector<std::vector<Arm>> arms_of_corners(const PlanModel& plan, const GraphState& state) {
  std::vector<std::vector<Arm>> arms(plan.corners.size());
  for (std::size_t w = 0; w < plan.walls.size(); ++w) {
    const PlanEdge& wall = plan.walls[w];
    const Segment2 s = state.segment(wall);
    if (!wall.usable || s.length() < 0.05) continue;
    arms[static_cast<std::size_t>(wall.corner_a)].push_back({static_cast<int>(w), s.heading(), wall.half_thickness_m});
    arms[static_cast<std::size_t>(wall.corner_b)].push_back(
        {static_cast<int>(w), wrap_angle(s.heading() + kPi), wall.half_thickness_m});
  }
  for (auto& list : arms)
    std::stable_sort(list.begin(), list.end(),
                     [](const Arm& a, const Arm& b) { return a.heading_rad < b.heading_rad; });
  return arms;
}

/// The crossing of the faces lies half a thickness to the left of `from` and to the right of `to`.
std::optional<CornerSector> sector(int corner, const Arm& from, const Arm& to) {
  CornerSector out{corner, from.wall, to.wall, 0, wrap_angle(to.heading_rad - from.heading_rad), Point2::Zero()};
  if (out.opening_rad <= 0) out.opening_rad += 2 * kPi;
  if (std::abs(out.opening_rad - kPi) < kStraight_rad || out.opening_rad < 0.5 || out.opening_rad > 2 * kPi - 0.5)
    return std::nullopt;
  out.orientation_rad = wrap_angle(from.heading_rad + out.opening_rad / 2);
  Eigen::Matrix2d normals;
  normals << -std::sin(from.heading_rad), std::cos(from.heading_rad), std::sin(to.heading_rad),
      -std::cos(to.heading_rad);
  out.offset_map = -(normals.inverse() * Eigen::Vector2d(from.half_m, to.half_m));
  return out;
}

/// A link, and by how much it shifts the scan.
struct CornerMatch {
  CornerLink link;
  Point2 shift = Point2::Zero();  ///< from the scan to the plan
};

std::vector<CornerMatch> mutual_nearest(const NodeView& view, std::size_t node, const Pose2& pose,
                                        const std::vector<CornerSector>& sectors, const GraphState& state,
                                        const std::vector<double>& gate_m) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  struct Best {
    std::size_t other = kNone;
    double distance = 1e9;
  };
  std::vector<Best> of_seen(view.corners.size()), of_sector(sectors.size());
  for (std::size_t j = 0; j < sectors.size(); ++j) {
    const CornerSector& s = sectors[j];
    const Point2 crossing = state.corner(s.corner) - s.offset_map;
    const double gate =
        std::min(gate_m[static_cast<std::size_t>(s.wall_a)], gate_m[static_cast<std::size_t>(s.wall_b)]);
    if (gate <= 0 || (crossing - pose.translation()).norm() > kReach_m + gate) continue;
    for (std::size_t i = 0; i < view.corners.size(); ++i) {
      const Corner& c = view.corners[i];
      const double distance = (pose * c.position - crossing).norm();
      if (distance > gate || c.position.norm() > kReach_m) continue;
      if (std::abs(wrap_angle(c.orientation_rad + pose.heading() - s.orientation_rad)) > kLikeAngle_rad) continue;
      if (std::abs(c.opening_rad - s.opening_rad) > kLikeAngle_rad) continue;
      if (distance < of_seen[i].distance) of_seen[i] = {j, distance};
      if (distance < of_sector[j].distance) of_sector[j] = {i, distance};
    }
  }
  std::vector<CornerMatch> out;
  for (std::size_t i = 0; i < of_seen.size(); ++i) {
    const std::size_t j = of_seen[i].other;
    if (j == kNone || of_sector[j].other != i) continue;
    CornerMatch s;
    s.link = {node,
              sectors[j].corner,
              {sectors[j].wall_a, sectors[j].wall_b},
              view.corners[i].position,
              sectors[j].offset_map,
              of_seen[i].distance,
              1,
              1};
    s.shift = state.corner(sectors[j].corner) - sectors[j].offset_map - pose * view.corners[i].position;
    out.push_back(s);
  }
  return out;
}

}  // namespace

std::vector<CornerSector> corner_sectors(const PlanModel& plan, const GraphState& state) {
  std::vector<CornerSector> out;
  const auto arms = arms_of_corners(plan, state);
  for (std::size_t c = 0; c < arms.size(); ++c) {
    if (arms[c].size() < 2) continue;
    for (std::size_t k = 0; k < arms[c].size(); ++k)
      if (const auto s = sector(static_cast<int>(c), arms[c][k], arms[c][(k + 1) % arms[c].size()])) out.push_back(*s);
  }
  return out;
}

std::vector<CornerLink> link_corners(const std::vector<NodeView>& views, const std::vector<bool>& use_node,
                                     const PlanModel& plan, const GraphState& state,
                                     const std::vector<double>& gate_m) {
  const std::vector<CornerSector> sectors = corner_sectors(plan, state);
  std::vector<CornerLink> links;
  for (std::size_t node = 0; node < views.size(); ++node) {
    if (!use_node[node]) continue;
    const auto found = mutual_nearest(views[node], node, state.pose(node), sectors, state, gate_m);
    for (const CornerMatch& one : found) {
      const bool borne_out = std::any_of(found.begin(), found.end(), [&](const CornerMatch& other) {
        return &other != &one && other.link.corner != one.link.corner && (other.shift - one.shift).norm() < kAgree_m;
      });
      links.push_back(one.link);
      if (!borne_out) links.back().borne_out = kAlone;
    }
  }
  return links;
}

double misfit_m(const CornerLink& link, const GraphState& state) {
  return (state.pose(link.node) * link.seen_robot + link.offset_map - state.corner(link.corner)).norm();
}

}  // namespace smokemap
