#include <algorithm>
#include <cmath>
#include <numeric>

#include "acg/gates.hpp"
#include "acg/graph_impl.hpp"
#include "geometry/delaunay.hpp"

namespace smokemap {
namespace {

constexpr double kAlignWay_m = 4.0;    ///< of way whose scans align the plan to a start
constexpr double kAlignReach_m = 5.0;  ///< farther hits would see too much of the plan's stretch
constexpr double kGlobalReach_m = 8.0;
constexpr double kCloserLook_m = 9.0;      ///< of way on which rival alignments are compared
constexpr double kTension = 0.02;          ///< share of explained length that one squared sigma per wall is worth
constexpr double kGlobalWay_m = 8.0;       ///< the same without any hint
constexpr double kGlobalExplained = 0.55;  ///< share of hits on walls before an alignment without a hint is believed
constexpr double kGlobalMargin = 0.06;

}  // namespace

bool AutoCompleteGraph::Impl::align(Learnt& l) const {
  AlignmentSearch search;
  search.scale_sigma = std::max(0.05, plan->scale_sigma);
  double way = kAlignWay_m;
  if (anchors.size() >= 2) {
    std::vector<PointPair> pairs;
    const PixelFrame frame{layout.height_px, plan->metres_per_pixel};
    for (const auto& [id, a] : anchors) pairs.push_back({a.p_map, frame.to_metres(a.p_px), 0.1});
    if (const auto fit = fit_similarity(pairs); fit.ok()) {
      put_down(PlanPlacement::from(*fit, plan->axis_rad), l);
      return true;
    }
  }
  if (start) {
    const Pose2 T_map_layout = l.state.pose(0) * start->T_layout_robot.inverse();
    search.guess = Similarity2{1, T_map_layout};
    search.sigma_m = std::max(0.05, start->sigma_m);
    search.sigma_rad = std::max(0.01, start->sigma_rad);
  } else {
    way = kGlobalWay_m;
    if (nodes.way_m().back() < way) return false;
    way = std::max(way, std::min(30.0, nodes.way_m().back()));
  }
  const auto found = align_plan(*plan, first_hits(nodes.views(), l.state, way, start ? kAlignReach_m : kGlobalReach_m),
                                l.state.pose(0).translation(), search);
  if (!found) {
    if (search.guess) put_down(PlanPlacement::from(*search.guess, plan->axis_rad), l);
    return false;
  }
  if (!start && (found->front().explained < kGlobalExplained || found->front().margin < kGlobalMargin)) return false;
  choose(*found, l);
  return true;
}

/// Tries each alignment on the first metres of way with the full model and keeps the one that explains most.
void AutoCompleteGraph::Impl::choose(const std::vector<PlanAlignment>& found, Learnt& l) const {
  Learnt best;
  double best_score = -1;
  for (const PlanAlignment& a : found) {
    Learnt trial = l;
    put_down(a.placement, trial);
    const double score = found.size() > 1 ? first_metres_explained(trial) : 0;
    if (score <= best_score) continue;
    best_score = score;
    best = l;
    put_down(a.placement, best);
  }
  l = std::move(best);
}

double AutoCompleteGraph::Impl::first_metres_explained(Learnt trial) const {
  SolveInput input;
  std::vector<bool> use = nodes.spaced();
  for (std::size_t i = 0; i < use.size(); ++i) use[i] = use[i] && nodes.way_m()[i] <= kCloserLook_m;
  for (const double way : {0.4, 1.0}) {
    std::vector<bool> part = use;
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = part[i] && nodes.way_m()[i] <= way * kCloserLook_m;
    for (const double sharpness : {1.0, 0.4})
      if (!round(trial, part, sharpness, {}, {}, &input)) return 0;
  }
  double linked = 0, all = 0;
  for (std::size_t i = 0; i < use.size(); ++i)
    if (use[i])
      for (const ScanPiece& p : nodes.views()[i].pieces) all += p.segment.length();
  for (const PieceLink& link : input.links) linked += link.weight * link.part_robot.length();
  return all > 0 ? linked / all - kTension * plan_tension(*plan, trial.state, params) : 0;
}

void AutoCompleteGraph::Impl::put_down(const PlanPlacement& s, Learnt& l) const {
  l.state.turn = s.turn_rad;
  l.state.log_scale = s.scale.array().log().mean();
  l.state.corners.clear();
  for (const Point2& p : plan->corners) {
    const Point2 q = s * p;
    l.state.corners.push_back({q.x(), q.y()});
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double heading = plan->axis_rad + static_cast<double>(axis) * kPi / 2;
    const Point2 u(std::cos(heading), std::sin(heading)), u_map = Pose2(0, 0, l.state.turn) * u;
    l.state.lines[axis].clear();
    for (const double at : plan->lines[axis]) l.state.lines[axis].push_back(u_map.dot(s * (at * u)));
  }
  l.walls.assign(plan->walls.size(), WallState::kUnseen);
  l.linked_m.assign(plan->walls.size(), 0);
  l.near_m.assign(plan->walls.size(), 0);
  l.sigma_m.clear();
  l.taken_way_m = 0;
}

std::vector<AnchorLink> AutoCompleteGraph::Impl::anchor_links() const {
  std::vector<AnchorLink> links;
  const PixelFrame frame{layout.height_px, plan->metres_per_pixel};
  for (const auto& [id, a] : anchors) {
    // The three nearest corners that are not in line carry the point.
    const Point2 p = frame.to_metres(a.p_px);
    std::vector<int> order(plan->corners.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    const auto at = [&](int i) -> const Point2& { return plan->corners[static_cast<std::size_t>(i)]; };
    std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return (at(i) - p).norm() < (at(j) - p).norm(); });
    for (std::size_t k = 2; k < order.size(); ++k) {
      const Point2 u = at(order[1]) - at(order[0]), v = at(order[k]) - at(order[0]);
      if (u.norm() < 0.05 || std::abs(u.x() * v.y() - u.y() * v.x()) < 0.3 * u.norm() * v.norm()) continue;
      links.push_back(
          {{order[0], order[1], order[k]}, barycentric(p, at(order[0]), at(order[1]), at(order[k])), a.p_map});
      break;
    }
  }
  return links;
}

}  // namespace smokemap
