#include "slam/smoke.hpp"

#include <algorithm>
#include <cmath>

#include "slam/radar_points.hpp"

namespace smokemap {
namespace {

constexpr double kBehind_m = 0.60;     ///< an echo this far behind the lidar's is another surface
constexpr double kSame_m = 0.35;       ///< an echo this near to the lidar's confirms it
constexpr double kSector_rad = 0.175;  ///< half width
constexpr double kSmokeShare = 0.60;
constexpr double kNear_m = 8.0;  ///< a wall that a lidar shows in clear air
constexpr int kLeastExpected = 20;

enum class Opinion { kNone, kWall, kSmoke };

/// What the radar's echoes near one bearing say about a lidar range.
Opinion ask(const std::vector<std::vector<double>>& ranges_by_bearing, std::size_t bearing, double range_m) {
  const std::size_t count = ranges_by_bearing.size();
  bool behind = false;
  for (const std::size_t b : {(bearing + count - 1) % count, bearing, (bearing + 1) % count})
    for (const double echo : ranges_by_bearing[b]) {
      if (std::abs(echo - range_m) < kSame_m) return Opinion::kWall;
      behind = behind || echo > range_m + kBehind_m;
    }
  return behind ? Opinion::kSmoke : Opinion::kNone;
}

}  // namespace

SmokeView look_for_smoke(const LaserScan& scan, const BeamConvention& convention, const RadarSweep& sweep,
                         const Pose2& T_now_then, const RadarParams& params) {
  const std::size_t beams = scan.ranges_m.size();
  SmokeView view{std::vector<bool>(beams, false), 0};
  constexpr std::size_t kBearings = 180;
  std::vector<std::vector<double>> ranges_by_bearing(kBearings);
  const Pose2 T_laser_then = scan.T_robot_laser.inverse() * T_now_then;
  for (const RadarEcho& echo : strongest_echoes(sweep, {}, params)) {
    const Point2 p = T_laser_then * echo.p;
    const double share = (std::atan2(p.y(), p.x()) + kPi) / (2 * kPi);
    ranges_by_bearing[static_cast<std::size_t>(share * kBearings) % kBearings].push_back(p.norm());
  }
  std::vector<Opinion> opinions(beams, Opinion::kNone);
  int expected = 0, shown = 0;
  for (std::size_t i = 0; i < beams; ++i) {
    const double range = static_cast<double>(scan.ranges_m[i]);
    const bool hit = classify(scan.ranges_m[i], scan, convention) == BeamKind::kHit;
    if (hit && range < params.nearest_m) continue;
    const double angle = wrap_angle(scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad);
    const std::size_t bearing = static_cast<std::size_t>((angle + kPi) / (2 * kPi) * kBearings) % kBearings;
    if (hit) opinions[i] = ask(ranges_by_bearing, bearing, range);
    const bool near_wall = std::any_of(ranges_by_bearing[bearing].begin(), ranges_by_bearing[bearing].end(),
                                       [](double echo) { return echo < kNear_m; });
    if (hit ? opinions[i] == Opinion::kNone : !near_wall) continue;
    ++expected;
    shown += opinions[i] == Opinion::kWall;
  }
  if (expected >= kLeastExpected) view.share = 1 - static_cast<double>(shown) / expected;
  const auto half = std::max<std::ptrdiff_t>(1, std::lround(kSector_rad / std::abs(scan.angle_increment_rad)));
  for (std::size_t i = 0; i < beams; ++i) {
    if (opinions[i] != Opinion::kSmoke) continue;
    int says_smoke = 0, says_wall = 0;
    for (std::ptrdiff_t j = static_cast<std::ptrdiff_t>(i) - half; j <= static_cast<std::ptrdiff_t>(i) + half; ++j) {
      if (j < 0 || j >= static_cast<std::ptrdiff_t>(beams)) continue;
      says_smoke += opinions[static_cast<std::size_t>(j)] == Opinion::kSmoke;
      says_wall += opinions[static_cast<std::size_t>(j)] == Opinion::kWall;
    }
    view.beams[i] = says_smoke >= kSmokeShare * (says_smoke + says_wall);
  }
  return view;
}

}  // namespace smokemap
