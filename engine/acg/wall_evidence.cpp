#include "acg/wall_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kReach_m = 12;       ///< beams are too far apart beyond
constexpr double kBeyondEnd_m = 1.0;  ///< how far past a free end is looked
constexpr double kFaceTolerance_m = 0.12;
constexpr double kClearBehind_m = 0.15;  ///< a beam went through if it reached this much farther
constexpr double kGrazing = 0.20;        ///< sine of the flattest angle that says something
constexpr double kEndGap_m = 0.20;       ///< between the last echo and the first beam past the end
constexpr double kEndReach_m = 7;
constexpr std::size_t kEndsPerCorner = 10;

enum class Says { kNothing, kHit, kThrough };
struct Reading {
  Says says = Says::kNothing;
  double s = 0;  ///< along the wall, 0 at corner a
  std::size_t ray = 0;
};

/// A wall as one node sees it.
struct Sight {
  Point2 origin, u, n;  ///< robot frame; n towards the robot
  double length = 0, half = 0, stand_off = 0;
};

Reading read_ray(const Sight& sight, const ScanRay& ray) {
  const Point2& way = ray.way;
  const double approach = -sight.n.dot(way);
  Reading out;
  if (approach < kGrazing) return out;
  const double cross = sight.stand_off / approach;
  const Point2 end = ray.range_m * way - sight.origin;
  if (ray.hit && std::abs(sight.n.dot(end) - sight.half) < kFaceTolerance_m) {
    out.says = Says::kHit;
    out.s = sight.u.dot(end);
  } else if (ray.range_m > cross + (sight.half + kClearBehind_m) / approach) {
    out.says = Says::kThrough;
    out.s = sight.u.dot(cross * way - sight.origin);
  }
  return out;
}

/// The rays between two bearings less than half a turn apart, in order of bearing.
template <typename Visit>
void rays_between(const std::vector<ScanRay>& rays, double from, double to, const Visit& visit) {
  const auto first = [&](double bearing) {
    return static_cast<std::size_t>(std::lower_bound(rays.begin(), rays.end(), bearing,
                                                     [](const ScanRay& r, double b) { return r.bearing_rad < b; }) -
                                    rays.begin());
  };
  if (from <= to) {
    for (std::size_t i = first(from); i < rays.size() && rays[i].bearing_rad <= to; ++i) visit(i);
    return;
  }
  for (std::size_t i = first(from); i < rays.size(); ++i) visit(i);
  for (std::size_t i = 0; i < rays.size() && rays[i].bearing_rad <= to; ++i) visit(i);
}

std::vector<Reading> readings(const Sight& sight, const std::vector<ScanRay>& rays, double before, double after) {
  const Point2 a = sight.origin - before * sight.u, b = sight.origin + (sight.length + after) * sight.u;
  double from = std::atan2(a.y(), a.x()), to = std::atan2(b.y(), b.x());
  if (wrap_angle(to - from) < 0) std::swap(from, to);
  std::vector<Reading> out;
  rays_between(rays, from, to, [&](std::size_t i) {
    Reading r = read_ray(sight, rays[i]);
    r.ray = i;
    if (r.says != Says::kNothing) out.push_back(r);
  });
  std::stable_sort(out.begin(), out.end(), [](const Reading& x, const Reading& y) { return x.s < y.s; });
  return out;
}

void count(const std::vector<Reading>& all, double length, WallEvidence& evidence) {
  std::vector<int> hit(evidence.hit.size(), 0), through(evidence.hit.size(), 0);
  const double last = static_cast<double>(hit.size()) - 1;
  for (const Reading& r : all) {
    if (r.s < 0 || r.s > length) continue;
    const auto bin = static_cast<std::size_t>(std::clamp(r.s / length * (last + 1), 0.0, last));
    ++(r.says == Says::kHit ? hit : through)[bin];
  }
  for (std::size_t i = 0; i < hit.size(); ++i) {
    evidence.hit[i] += hit[i] > 0 && hit[i] >= through[i];
    evidence.through[i] += through[i] > hit[i];
  }
}

/// Looks outwards from the wall for an echo whose next beam passes; `outwards` is +1 at corner b.
bool find_end(const std::vector<Reading>& all, const Sight& sight, const std::vector<ScanRay>& rays, double outwards,
              double gate, EndLink& link) {
  const double expected = outwards > 0 ? sight.length : 0;
  bool found = false;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const Reading& hit = outwards > 0 ? all[i] : all[i + 1];
    const Reading& pass = outwards > 0 ? all[i + 1] : all[i];
    const double gap = outwards * (pass.s - hit.s);
    if (hit.says != Says::kHit || pass.says != Says::kThrough || gap > kEndGap_m) continue;
    const auto apart = hit.ray > pass.ray ? hit.ray - pass.ray : pass.ray - hit.ray;
    if (apart != 1 && apart != rays.size() - 1) continue;
    const double s = hit.s + outwards * std::min(0.5 * gap, 0.05), misfit = outwards * (s - expected);
    if (std::abs(misfit) > gate || (found && std::abs(misfit) > std::abs(link.misfit_m))) continue;
    found = true;
    link.misfit_m = misfit;
    link.end_robot = sight.origin + s * sight.u + sight.half * sight.n;
    link.sigma_m = std::hypot(0.02, 0.5 * gap);
  }
  return found;
}

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

BeamReading read_beams(const std::vector<NodeView>& views, const std::vector<bool>& use_node, const PlanModel& plan,
                       const GraphState& state, const std::vector<double>& end_gate_m) {
  BeamReading out;
  std::vector<Segment2> walls;
  for (const PlanEdge& w : plan.walls) {
    walls.push_back(state.segment(w));
    WallEvidence evidence;
    const double length = walls.back().length();
    const auto bins = static_cast<std::size_t>(std::max(1.0, std::round(length / evidence.bin_m)));
    evidence.hit.assign(bins, 0);
    evidence.through.assign(bins, 0);
    evidence.bin_m = length / static_cast<double>(bins);
    out.walls.push_back(evidence);
  }
  std::vector<EndLink> ends;
  for (std::size_t node = 0; node < views.size(); ++node) {
    if (!use_node[node]) continue;
    const Pose2 pose = state.pose(node), T_robot_map = pose.inverse();
    for (std::size_t w = 0; w < walls.size(); ++w) {
      if (!plan.walls[w].usable || walls[w].length() < 0.05 || distance(walls[w], pose.translation()) > kReach_m)
        continue;
      Sight sight;
      sight.origin = T_robot_map * walls[w].a;
      sight.u = (T_robot_map * walls[w].b - sight.origin).normalized();
      sight.n = Point2(-sight.u.y(), sight.u.x());
      if (sight.n.dot(sight.origin) > 0) sight.n = -sight.n;
      sight.stand_off = -sight.n.dot(sight.origin);
      sight.length = walls[w].length();
      sight.half = plan.walls[w].half_thickness_m;
      if (sight.stand_off < sight.half + 0.05) continue;
      const auto free_end = [&](int c) { return plan.degree[static_cast<std::size_t>(c)] == 1; };
      const bool free_a = free_end(plan.walls[w].corner_a), free_b = free_end(plan.walls[w].corner_b);
      const auto all = readings(sight, views[node].rays, free_a ? kBeyondEnd_m : 0, free_b ? kBeyondEnd_m : 0);
      count(all, sight.length, out.walls[w]);
      for (const bool at_b : {false, true}) {
        if (!(at_b ? free_b : free_a) || end_gate_m[w] <= 0) continue;
        EndLink link;
        link.node = node;
        link.wall = static_cast<int>(w);
        link.corner = at_b ? plan.walls[w].corner_b : plan.walls[w].corner_a;
        link.other_corner = at_b ? plan.walls[w].corner_a : plan.walls[w].corner_b;
        if (find_end(all, sight, views[node].rays, at_b ? 1 : -1, end_gate_m[w], link) &&
            link.end_robot.norm() < kEndReach_m)
          ends.push_back(link);
      }
    }
  }
  out.ends = best_ends(ends);
  return out;
}

}  // namespace smokemap
