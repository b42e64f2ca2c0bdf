#include "slam/smoke.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "slam/hit_ranges.hpp"
#include "slam/radar_points.hpp"

namespace smokemap {
namespace {

constexpr double kBehind_m = 0.60;     ///< an echo this far behind the lidar's is another surface
constexpr double kSame_m = 0.35;       ///< an echo this near to the lidar's confirms it
constexpr double kLoneSame_m = 0.15;   ///< the same for an echo that lies on no surface
constexpr double kSector_rad = 0.175;  ///< half width
constexpr double kSmokeShare = 0.60;
constexpr double kNear_m = 8.0;  ///< a wall that a lidar shows in clear air
constexpr int kLeastExpected = 20;

constexpr int kNeighbours = 5;        ///< beams on either side in which a surface goes on
constexpr int kLeastBeside = 5;       ///< of them, at about the same range ...
constexpr int kLeastInLine = 5;       ///< ... or pairs of them in line with the echo
constexpr double kBeside_m = 0.035;   ///< three sigmas of a lidar
constexpr double kBesideSlope = 1.2;  ///< of a surface met at 40 degrees
constexpr double kLoneReach_m = 3.0;  ///< smoke rarely answers from farther away: there it takes the radar's word too

constexpr double kFar_m = 4.0;    ///< smoke answers from farther away once in a thousand echoes of walls
constexpr double kStays_m = 2.0;  ///< farther away, echoes of smoke are too rare to come twice from one place
constexpr int kLeastEarlier = 3;  ///< scans remembered ...
constexpr int kLeastTimes = 2;    ///< ... and how many of them show what stays

enum class Opinion { kNone, kWall, kSmoke };

/// Radar echoes by bearing, as seen from the lidar.
class RadarRanges {
 public:
  RadarRanges(const LaserScan& scan, const RadarSweep& sweep, const Pose2& T_now_then, const RadarParams& params) {
    const Pose2 T_laser_then = scan.T_robot_laser.inverse() * T_now_then;
    for (const RadarEcho& echo : strongest_echoes(sweep, {}, params)) {
      const Point2 p = T_laser_then * echo.p;
      ranges_[bearing_of(std::atan2(p.y(), p.x()))].push_back(p.norm());
    }
  }
  /// What the echoes near one bearing say about a lidar range.
  Opinion ask(double angle_rad, double range_m) const {
    bool behind = false;
    for (const double echo : around(angle_rad)) {
      if (std::abs(echo - range_m) < kSame_m) return Opinion::kWall;
      behind = behind || echo > range_m + kBehind_m;
    }
    return behind ? Opinion::kSmoke : Opinion::kNone;
  }
  bool confirms(double angle_rad, double range_m) const {
    const std::vector<double> echoes = around(angle_rad);
    return std::any_of(echoes.begin(), echoes.end(),
                       [&](double echo) { return std::abs(echo - range_m) < kLoneSame_m; });
  }
  bool near_wall(double angle_rad) const {
    const auto& here = ranges_[bearing_of(angle_rad)];
    return std::any_of(here.begin(), here.end(), [](double echo) { return echo < kNear_m; });
  }

 private:
  static constexpr std::size_t kBearings = 180;
  static std::size_t bearing_of(double angle_rad) {
    return static_cast<std::size_t>((wrap_angle(angle_rad) + kPi) / (2 * kPi) * kBearings) % kBearings;
  }
  std::vector<double> around(double angle_rad) const {
    const std::size_t bearing = bearing_of(angle_rad);
    std::vector<double> echoes;
    for (const std::size_t b : {(bearing + kBearings - 1) % kBearings, bearing, (bearing + 1) % kBearings})
      echoes.insert(echoes.end(), ranges_[b].begin(), ranges_[b].end());
    return echoes;
  }
  std::array<std::vector<double>, kBearings> ranges_;
};

/// Does no surface go through this hit? The beams beside it end neither at about its range nor in line with it: on a
/// straight wall 1/r of three beams at equal angles fulfils 1/a + 1/c = 2 cos(step) / b.
bool is_lone(const HitRanges& hits, std::ptrdiff_t i) {
  const double range = hits.at(i);
  int beside = 0, in_line = 0;
  for (int k = 1; k <= kNeighbours; ++k) {
    const double before = hits.at(i - k), after = hits.at(i + k), cosine = 2 * std::cos(k * hits.step_rad());
    const double slope_m = kBesideSlope * range * k * std::abs(hits.step_rad());
    for (const double other : {before, after})
      beside += other > 0 && std::abs(other - range) <= std::max(kBeside_m, slope_m);
    const auto agrees = [&](double inverse) {
      return inverse > 0 && std::abs(1 / inverse - range) < std::max(kBeside_m, 0.02 * range);
    };
    if (before > 0 && after > 0) in_line += agrees((1 / before + 1 / after) / cosine);
    if (const double next = hits.at(i - k - k); before > 0 && next > 0) in_line += agrees(cosine / before - 1 / next);
    if (const double next = hits.at(i + k + k); after > 0 && next > 0) in_line += agrees(cosine / after - 1 / next);
  }
  return beside < kLeastBeside && in_line < kLeastInLine;
}

/// What earlier scans say about a hit.
enum class Stay { kUnknown, kStays, kNew };

Stay look_back(const EarlierScans& earlier, const LaserScan& scan, double angle_rad, double range_m) {
  if (!earlier.memory || range_m < kStays_m || earlier.memory->scans(scan.stamp) < kLeastEarlier) return Stay::kUnknown;
  const Point2 p_laser = range_m * Point2(std::cos(angle_rad), std::sin(angle_rad));
  const int times = earlier.memory->times_hit(earlier.T_odom_robot * (scan.T_robot_laser * p_laser), scan.stamp);
  if (times >= kLeastTimes || (times > 0 && range_m > kFar_m)) return Stay::kStays;
  return times == 0 ? Stay::kNew : Stay::kUnknown;
}

}  // namespace

SmokeView look_for_smoke(const LaserScan& scan, const BeamConvention& convention, const RadarSweep& sweep,
                         const Pose2& T_now_then, const RadarParams& params, const EarlierScans& earlier) {
  const std::size_t beams = scan.ranges_m.size();
  SmokeView view{std::vector<bool>(beams, false), 0};
  const RadarRanges radar(scan, sweep, T_now_then, params);
  const HitRanges hits(scan, convention);
  std::vector<Opinion> opinions(beams, Opinion::kNone);
  std::vector<bool> lone(beams, false), stays(beams, false);
  int expected = 0, shown = 0;
  for (std::size_t i = 0; i < beams; ++i) {
    const double range = hits.at(static_cast<std::ptrdiff_t>(i));
    const double angle = scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad;
    const bool hit = range > 0, too_near = range < params.nearest_m;  // for the radar
    if (hit && !too_near) opinions[i] = radar.ask(angle, range);
    const bool no_surface =
        hit && is_lone(hits, static_cast<std::ptrdiff_t>(i)) && (too_near || !radar.confirms(angle, range));
    const Stay stay =
        no_surface || opinions[i] == Opinion::kSmoke ? look_back(earlier, scan, angle, range) : Stay::kUnknown;
    stays[i] = stay == Stay::kStays;
    lone[i] = no_surface && !stays[i] &&
              (range < kLoneReach_m || opinions[i] == Opinion::kSmoke || (stay == Stay::kNew && range < kFar_m));
    if (hit && too_near && !lone[i]) continue;
    if (hit && !too_near ? opinions[i] == Opinion::kNone : !radar.near_wall(angle)) continue;
    ++expected;
    shown += opinions[i] == Opinion::kWall && !lone[i];
  }
  if (expected >= kLeastExpected) view.share = 1 - static_cast<double>(shown) / expected;
  const auto half = std::max<std::ptrdiff_t>(1, std::lround(kSector_rad / std::abs(scan.angle_increment_rad)));
  for (std::size_t i = 0; i < beams; ++i) {
    view.beams[i] = lone[i];
    if (lone[i] || stays[i] || opinions[i] != Opinion::kSmoke) continue;
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
