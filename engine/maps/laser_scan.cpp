#include "maps/laser_scan.hpp"

#include <cmath>

namespace smokemap {

BeamKind classify(float range_m, const LaserScan& scan, const BeamConvention& convention) {
  const double usable = convention.usable_range_m > 0 && convention.usable_range_m < scan.range_max_m
                            ? convention.usable_range_m
                            : scan.range_max_m;
  if (std::isnan(range_m) || range_m <= 0) return BeamKind::kUnknown;  // also -inf: too near to tell
  if (range_m < scan.range_min_m) return BeamKind::kUnknown;
  if (range_m < usable) return BeamKind::kHit;
  return convention.no_return_is_free ? BeamKind::kFreeToMax : BeamKind::kUnknown;
}

Result<Ok> check(const LaserScan& scan) {
  constexpr std::size_t kMostBeams = 20'000;
  if (scan.ranges_m.empty()) return fail(Errc::kCorrupt, "scan without ranges");
  if (scan.ranges_m.size() > kMostBeams)
    return fail(Errc::kTooLarge, "scan with " + std::to_string(scan.ranges_m.size()) + " beams");
  if (!std::isfinite(scan.angle_increment_rad) || scan.angle_increment_rad == 0 || !std::isfinite(scan.angle_min_rad))
    return fail(Errc::kCorrupt, "scan without a usable angle increment");
  if (!std::isfinite(scan.range_max_m) || scan.range_max_m <= 0 || !(scan.range_min_m >= 0))
    return fail(Errc::kCorrupt, "scan without usable range limits");
  if (!scan.T_robot_laser.is_finite() || !std::isfinite(scan.time_increment_s))
    return fail(Errc::kCorrupt, "scan with a pose or time that is not finite");
  if (!scan.intensities.empty() && scan.intensities.size() != scan.ranges_m.size())
    return fail(Errc::kCorrupt, "scan with intensities of another length than its ranges");
  return Ok{};
}

std::size_t distinct_beams(const LaserScan& scan) {
  const std::size_t beams = scan.ranges_m.size();
  const double span = std::abs(scan.angle_increment_rad) * static_cast<double>(beams - (beams > 0));
  return beams > 1 && span > 2 * kPi - 0.5 * std::abs(scan.angle_increment_rad) ? beams - 1 : beams;
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
