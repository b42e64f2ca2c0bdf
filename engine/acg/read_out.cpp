#include "acg/read_out.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

/// Where the undistorted plan would lie: what a wall's displacement is measured from.
Similarity2 rigid_plan(const SolvedPlan& solved) {
  std::vector<PointPair> pairs;
  for (std::size_t i = 0; i < solved.plan->corners.size(); ++i)
    pairs.push_back({solved.state->corner(static_cast<int>(i)), solved.plan->corners[i], 1.0});
  const auto fit = fit_similarity(pairs);
  return fit.ok() ? *fit : Similarity2{};
}

constexpr double kNothingNear =
    0.3;  ///< of a wall's length: pieces within its gate there say that it is misplaced, not missing

constexpr double kStub_m = 0.5;

constexpr double kKept = 0.5, kDoubtful = 0.1;  ///< robust weights

double confidence_of(WallState state, const WallEvidence& evidence) {
  const double length = std::max(0.1, evidence.length_m());
  switch (state) {
    case WallState::kConfirmed:
    case WallState::kMoved:
      return std::clamp(0.5 + 0.5 * evidence.hit_m() / length, 0.5, 0.98);
    case WallState::kMissing:
      return std::clamp(evidence.through_m() / length, 0.3, 0.98);
    default:
      return std::clamp(0.6 - 0.5 * evidence.through_m() / length, 0.1, 0.6);
  }
}

MergedWall read_wall(const SolvedPlan& solved, std::size_t w, const Similarity2& rigid, const AcgParams& params) {
  const PlanEdge& edge = solved.plan->walls[w];
  MergedWall wall;
  wall.layout_wall = static_cast<int>(w);
  wall.segment_map = solved.state->segment(edge);
  const auto plan_at = [&](int c) { return rigid * solved.plan->corners[static_cast<std::size_t>(c)]; };
  wall.displacement_m = 0.5 * ((plan_at(edge.corner_a) - wall.segment_map.a).norm() +
                               (plan_at(edge.corner_b) - wall.segment_map.b).norm());
  wall.state = solved.wall_states[w];
  if (wall.state == WallState::kConfirmed && wall.displacement_m > params.moved_m) wall.state = WallState::kMoved;
  wall.confidence = confidence_of(wall.state, solved.evidence[w]);
  if (!solved.doubt.empty()) wall.confidence *= 1 - solved.doubt[w];
  wall.evidence_m = std::max(solved.evidence[w].hit_m(), solved.evidence[w].through_m());
  return wall;
}

/// A corner is seen when a wall of it was seen near it.
std::vector<bool> seen_corners(const SolvedPlan& solved) {
  std::vector<bool> seen(solved.plan->corners.size(), false);
  for (std::size_t w = 0; w < solved.plan->walls.size(); ++w) {
    const WallEvidence& e = solved.evidence[w];
    if (solved.wall_states[w] == WallState::kMissing || e.hit.empty()) continue;
    const auto reach = static_cast<std::size_t>(std::max(1.0, 0.6 / std::max(0.01, e.bin_m)));
    for (std::size_t i = 0; i < e.hit.size(); ++i) {
      if (e.hit[i] == 0) continue;
      if (i < reach) seen[static_cast<std::size_t>(solved.plan->walls[w].corner_a)] = true;
      if (i + reach >= e.hit.size()) seen[static_cast<std::size_t>(solved.plan->walls[w].corner_b)] = true;
    }
  }
  return seen;
}

void read_links(const SolvedPlan& solved, MergedMap& out) {
  for (const CornerLink& link : solved.links) {
    const auto state = link.weight > kKept       ? LinkState::kKept
                       : link.weight > kDoubtful ? LinkState::kDoubtful
                                                 : LinkState::kRejected;
    out.links.push_back({solved.state->pose(link.node) * link.seen_robot, link.corner, state});
  }
}

}  // namespace

WallState judge_wall_state(const WallEvidence& evidence, double linked_m, double near_m, const AcgParams& params) {
  const double length = std::max(0.05, evidence.length_m());
  const double hit = evidence.hit_m() / length, through = evidence.through_m() / length;
  if (through >= params.missing_share && hit < 0.5 * through && near_m < kNothingNear * length)
    return WallState::kMissing;
  if (hit >= 0.25 || evidence.hit_m() > params.mature_m || linked_m > params.mature_m) return WallState::kConfirmed;
  return WallState::kUnseen;
}

void stubs_go_with_their_walls(const PlanModel& plan, std::vector<WallState>& states) {
  const auto wall_at = [&](int corner) {
    for (std::size_t w = 0; w < plan.walls.size(); ++w)
      if (plan.walls[w].usable && (plan.walls[w].corner_a == corner || plan.walls[w].corner_b == corner)) return w;
    return plan.walls.size();
  };
  for (const PlanEdge& gap : plan.gaps) {
    const std::size_t one = wall_at(gap.corner_a), other = wall_at(gap.corner_b);
    if (std::max(one, other) >= plan.walls.size()) continue;
    const auto follow = [&](std::size_t wall, std::size_t stub, int end) {
      if (states[wall] != WallState::kMissing || plan.walls[stub].length_m >= kStub_m ||
          plan.degree[static_cast<std::size_t>(end)] != 1 ||
          line_angle_between(plan.walls[wall].heading_rad, plan.walls[stub].heading_rad) > radians(10))
        return;
      states[stub] = WallState::kMissing;
    };
    follow(one, other, gap.corner_b);
    follow(other, one, gap.corner_a);
  }
}

void read_out_plan(const SolvedPlan& solved, const AcgParams& params, MergedMap& out) {
  const Similarity2 rigid = rigid_plan(solved);
  for (std::size_t w = 0; w < solved.plan->walls.size(); ++w) out.walls.push_back(read_wall(solved, w, rigid, params));
  const std::vector<bool> seen = seen_corners(solved);
  std::vector<PointPair> pairs;
  for (std::size_t i = 0; i < solved.plan->corners.size(); ++i) {
    const Point2 p = solved.state->corner(static_cast<int>(i));
    out.corners.push_back({solved.layout->corners[i].p_px, p, solved.corner_sigma_m[i], seen[i]});
    pairs.push_back({p, solved.plan->corners[i], solved.corner_sigma_m[i]});
  }
  if (auto deformation = Deformation::build(pairs); deformation.ok()) out.layout_to_map = std::move(*deformation);
  read_links(solved, out);
}

void read_out_new_walls(const std::vector<NewWall>& walls, MergedMap& out) {
  for (const NewWall& w : walls) {
    MergedWall wall;
    wall.segment_map = w.segment_map;
    wall.state = WallState::kNew;
    wall.confidence = w.confidence;
    wall.evidence_m = w.evidence_m;
    out.walls.push_back(wall);
  }
}

}  // namespace smokemap
