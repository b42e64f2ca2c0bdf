#include "maps/laser_scan.hpp"

#include <cmath>

namespace smokemap {

BeamKind classify(float range_m, const LaserScan& scan, const BeamConvention& convention) {
  const double usable = convention.usable_range_m > 0 && convention.usable_range_m < scan.range_max_m
                            ? convention.usable_range_m
                            : scan.range_max_m;
  if (std::isnan(range_m) || range_m <= 0) return BeamKind::kUnknown;  // also -inf: too near to tell
  // Ranges are floats: 5.6 as a float lies below 5.6 as a double, and "nothing up to 5.6 m" would be a wall there.
  if (range_m < static_cast<float>(scan.range_min_m)) return BeamKind::kUnknown;
  if (range_m < static_cast<float>(usable)) return BeamKind::kHit;
  return convention.no_return_is_free ? BeamKind::kFreeToMax : BeamKind::kUnknown;
}

Result<Ok> check(const LaserScan& scan) {
  constexpr std::size_t kMostBeams = 20'000;
  if (scan.ranges_m.empty()) return fail(Errc::kCorrupt, "scan without ranges");
  if (scan.ranges_m.size() > kMostBeams)
    return fail(Errc::kTooLarge, "scan with " + std::to_string(scan.ranges_m.size()) + " beams");
  constexpr double kMostTurned = 4 * kPi;  // more is degrees, or no angle at all
  if (!std::isfinite(scan.angle_increment_rad) || scan.angle_increment_rad == 0 || !std::isfinite(scan.angle_min_rad))
    return fail(Errc::kCorrupt, "scan without a usable angle increment");
  const double span = std::abs(scan.angle_increment_rad) * static_cast<double>(scan.ranges_m.size() - 1);
  if (std::abs(scan.angle_min_rad) > kMostTurned || !(span <= kMostTurned))
    return fail(Errc::kCorrupt, "scan over more than two turns");
  if (!std::isfinite(scan.range_max_m) || !(scan.range_min_m >= 0) || !(scan.range_min_m < scan.range_max_m))
    return fail(Errc::kCorrupt, "scan without usable range limits");
  if (!scan.T_robot_laser.is_finite() || !std::isfinite(scan.time_increment_s))
    return fail(Errc::kCorrupt, "scan with a pose or time that is not finite");
  if (!scan.intensities.empty() && scan.intensities.size() != scan.ranges_m.size())
    return fail(Errc::kCorrupt, "scan with intensities of another length than its ranges");
  return Ok{};
}

std::size_t distinct_beams(const LaserScan& scan) {
  const std::size_t beams = scan.ranges_m.size();
  const double in_a_turn = std::round(2 * kPi / std::abs(scan.angle_increment_rad));
  return in_a_turn >= 1 && in_a_turn < static_cast<double>(beams) ? static_cast<std::size_t>(in_a_turn) : beams;
}

std::vector<Point2> hit_points(const LaserScan& scan, const BeamConvention& convention) {
  std::vector<Point2> points;
  const std::size_t beams = distinct_beams(scan);
  points.reserve(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const float range = scan.ranges_m[i];
    if (classify(range, scan, convention) != BeamKind::kHit) continue;
    const double angle = scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad;
    points.emplace_back(range * std::cos(angle), range * std::sin(angle));
  }
  return points;
}

}  // namespace smokemap
