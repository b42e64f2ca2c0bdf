#include "acg/wall_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace smokemap {
namespace {

constexpr double kReach_m = 12;  ///< beams are too far apart beyond
constexpr double kEndReach_m = 7;
constexpr double kStill_m = 0.02;  ///< a wall whose ends moved less against the robot need not be read anew
constexpr double kBin_m = 0.1;
constexpr std::size_t kEndsPerCorner = 10;

/// The nearest nodes' opinions on each corner, without those that contradict their median.
std::vector<EndLink> best_ends(const std::vector<EndLink>& all) {
  std::map<std::pair<int, int>, std::vector<EndLink>> by_corner;
  for (const EndLink& e : all) by_corner[{e.corner, e.wall}].push_back(e);
  std::vector<EndLink> out;
  for (auto& [corner, ends] : by_corner) {
    std::vector<double> misfits;
    for (const EndLink& e : ends) misfits.push_back(e.misfit_m);
    std::nth_element(misfits.begin(), misfits.begin() + static_cast<std::ptrdiff_t>(misfits.size() / 2), misfits.end());
    const double median = misfits[misfits.size() / 2];
    std::erase_if(ends, [&](const EndLink& e) { return std::abs(e.misfit_m - median) > 0.10; });
    if (ends.size() < 2) continue;
    std::stable_sort(ends.begin(), ends.end(),
                     [](const EndLink& a, const EndLink& b) { return a.end_robot.norm() < b.end_robot.norm(); });
    ends.resize(std::min(ends.size(), kEndsPerCorner));
    out.insert(out.end(), ends.begin(), ends.end());
  }
  return out;
}

/// The seen end nearest to where the plan has it now, not farther than the gate.
std::optional<EndLink> nearest_end(const WallSight& sight, bool at_b, const Segment2& wall_robot, double gate_m) {
  const Point2 corner = at_b ? wall_robot.b : wall_robot.a, u = (at_b ? 1.0 : -1.0) * wall_robot.direction();
  std::optional<EndLink> best;
  for (const SeenEnd& end : sight.ends[at_b ? 1 : 0]) {
    const double misfit = u.dot(end.end_robot - corner);
    if (std::abs(misfit) > gate_m || (best && std::abs(misfit) > std::abs(best->misfit_m))) continue;
    if (end.end_robot.norm() >= kEndReach_m) continue;
    best.emplace();
    best->misfit_m = misfit;
    best->end_robot = end.end_robot;
    best->sigma_m = end.sigma_m;
  }
  return best;
}

WallEvidence nothing_seen(const PlanEdge& wall, double length_m) {
  WallEvidence evidence;
  const auto bins = static_cast<std::size_t>(std::max(1.0, std::round(wall.length_m / kBin_m)));
  evidence.hit.assign(bins, 0);
  evidence.through.assign(bins, 0);
  evidence.bin_m = length_m / static_cast<double>(bins);
  return evidence;
}

}  // namespace

double WallEvidence::hit_m() const {
  double m = 0;
  for (std::size_t i = 0; i < hit.size(); ++i) m += hit[i] > 0 && 2 * hit[i] > through[i] ? bin_m : 0;
  return m;
}

double WallEvidence::through_m() const {
  double m = 0;
  for (std::size_t i = 0; i < hit.size(); ++i) m += through[i] >= 2 && 5 * hit[i] <= through[i] ? bin_m : 0;
  return m;
}

std::shared_ptr<const WallSight> BeamMemory::recall(std::size_t node, int wall, const Segment2& wall_robot) const {
  const auto& known = sights_[node];
  const auto at = std::lower_bound(known.begin(), known.end(), wall, [](const auto& s, int w) { return s->wall < w; });
  if (at == known.end() || (*at)->wall != wall) return nullptr;
  const Segment2& then = (*at)->wall_robot;
  const bool still = (then.a - wall_robot.a).norm() < kStill_m && (then.b - wall_robot.b).norm() < kStill_m;
  return still ? *at : nullptr;
}

BeamReading BeamMemory::read(const std::vector<NodeView>& views, const std::vector<bool>& use_node,
                             const PlanModel& plan, const GraphState& state, const std::vector<double>& end_gate_m) {
  BeamReading out;
  std::vector<Segment2> walls;
  std::vector<std::array<bool, 2>> free_ends;
  const auto is_free = [&](int c) { return plan.degree[static_cast<std::size_t>(c)] == 1; };
  for (const PlanEdge& w : plan.walls) {
    walls.push_back(state.segment(w));
    free_ends.push_back({is_free(w.corner_a), is_free(w.corner_b)});
    out.walls.push_back(nothing_seen(w, walls.back().length()));
  }
  sights_.resize(views.size());
  std::vector<EndLink> ends;
  for (std::size_t node = 0; node < views.size(); ++node) {
    if (!use_node[node]) continue;
    const Pose2 pose = state.pose(node), T_robot_map = pose.inverse();
    std::vector<std::shared_ptr<const WallSight>> now;
    for (std::size_t w = 0; w < walls.size(); ++w) {
      if (!plan.walls[w].usable || walls[w].length() < 0.05 || distance(walls[w], pose.translation()) > kReach_m)
        continue;
      const Segment2 wall_robot{T_robot_map * walls[w].a, T_robot_map * walls[w].b};
      WallEvidence& evidence = out.walls[w];
      auto sight = recall(node, static_cast<int>(w), wall_robot);
      if (!sight)
        sight = std::make_shared<const WallSight>(see_wall(views[node].rays, static_cast<int>(w), wall_robot,
                                                           plan.walls[w].half_thickness_m, evidence.hit.size(),
                                                           free_ends[w]));
      now.push_back(sight);
      for (std::size_t i = 0; i < sight->bins.size(); ++i) {
        evidence.hit[i] += sight->bins[i] > 0;
        evidence.through[i] += sight->bins[i] < 0;
      }
      for (const bool at_b : {false, true}) {
        if (!free_ends[w][at_b ? 1 : 0] || end_gate_m[w] <= 0) continue;
        auto link = nearest_end(*sight, at_b, wall_robot, end_gate_m[w]);
        if (!link) continue;
        link->node = node;
        link->wall = static_cast<int>(w);
        link->corner = at_b ? plan.walls[w].corner_b : plan.walls[w].corner_a;
        link->other_corner = at_b ? plan.walls[w].corner_a : plan.walls[w].corner_b;
        ends.push_back(*link);
      }
    }
    sights_[node] = std::move(now);
  }
  out.ends = best_ends(ends);
  return out;
}

}  // namespace smokemap
