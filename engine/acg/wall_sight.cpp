#include "acg/wall_sight.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kBeyondEnd_m = 1.0;  ///< how far past a free end is looked
constexpr double kFaceTolerance_m = 0.12;
constexpr double kClearBehind_m = 0.15;  ///< a beam went through if it reached this much farther
constexpr double kGrazing = 0.20;        ///< sine of the flattest angle that says something
constexpr double kEndGap_m = 0.20;       ///< between the last echo and the first beam past the end

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

/// One word per bin: what most of its beams say.
void count(const std::vector<Reading>& all, double length, std::vector<std::int8_t>& bins) {
  std::vector<int> balance(bins.size(), 0);
  std::vector<bool> any(bins.size(), false);
  const double last = static_cast<double>(bins.size()) - 1;
  for (const Reading& r : all) {
    if (r.s < 0 || r.s > length) continue;
    const auto bin = static_cast<std::size_t>(std::clamp(r.s / length * (last + 1), 0.0, last));
    balance[bin] += r.says == Says::kHit ? 1 : -1;
    any[bin] = any[bin] || r.says == Says::kHit;
  }
  for (std::size_t i = 0; i < bins.size(); ++i)
    bins[i] = static_cast<std::int8_t>(balance[i] < 0 ? -1 : any[i] ? 1 : 0);
}

/// Looks outwards from the wall for echoes whose next beam passes; `outwards` is +1 at corner b.
std::vector<SeenEnd> find_ends(const std::vector<Reading>& all, const Sight& sight, const std::vector<ScanRay>& rays,
                               double outwards) {
  std::vector<SeenEnd> ends;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const Reading& hit = outwards > 0 ? all[i] : all[i + 1];
    const Reading& pass = outwards > 0 ? all[i + 1] : all[i];
    const double gap = outwards * (pass.s - hit.s);
    if (hit.says != Says::kHit || pass.says != Says::kThrough || gap > kEndGap_m) continue;
    const auto apart = hit.ray > pass.ray ? hit.ray - pass.ray : pass.ray - hit.ray;
    if (apart != 1 && apart != rays.size() - 1) continue;
    const double s = hit.s + outwards * std::min(0.5 * gap, 0.05);
    ends.push_back({sight.origin + s * sight.u + sight.half * sight.n, std::hypot(0.02, 0.5 * gap)});
  }
  return ends;
}

}  // namespace

WallSight see_wall(const std::vector<ScanRay>& rays, int wall, const Segment2& wall_robot, double half_thickness_m,
                   std::size_t bins, const std::array<bool, 2>& free_end) {
  WallSight out;
  out.wall = wall;
  out.wall_robot = wall_robot;
  out.bins.assign(bins, 0);
  Sight sight;
  sight.origin = wall_robot.a;
  sight.u = wall_robot.direction();
  sight.n = wall_robot.normal();
  if (sight.n.dot(sight.origin) > 0) sight.n = -sight.n;
  sight.stand_off = -sight.n.dot(sight.origin);
  sight.length = wall_robot.length();
  sight.half = half_thickness_m;
  if (sight.stand_off < sight.half + 0.05) return out;
  const auto all = readings(sight, rays, free_end[0] ? kBeyondEnd_m : 0, free_end[1] ? kBeyondEnd_m : 0);
  count(all, sight.length, out.bins);
  for (const std::size_t end : {0u, 1u})
    if (free_end[end]) out.ends[end] = find_ends(all, sight, rays, end == 1 ? 1 : -1);
  return out;
}

}  // namespace smokemap
