#include "slam/hit_ranges.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kOldest_s = 1.0;
constexpr double kSamePlace_m = 0.10;   ///< along the beam
constexpr double kOneSurface_m = 0.50;  ///< ranges of two beams side by side on a surface that is grazed

/// Whether a surface between two beams side by side is hit at this range.
bool between(double a, double b, double range_m) {
  if (a <= 0 || b <= 0 || std::abs(a - b) > kOneSurface_m) return false;
  return range_m > std::min(a, b) - kSamePlace_m && range_m < std::max(a, b) + kSamePlace_m;
}

}  // namespace

HitRanges::HitRanges(const LaserScan& scan, const BeamConvention& convention)
    : angle_min_rad_(scan.angle_min_rad),
      step_rad_(scan.angle_increment_rad),
      beams_(static_cast<std::ptrdiff_t>(distinct_beams(scan))) {
  ranges_.reserve(scan.ranges_m.size());
  for (const float range : scan.ranges_m)
    ranges_.push_back(classify(range, scan, convention) == BeamKind::kHit ? static_cast<double>(range) : 0.0);
  full_turn_ = static_cast<double>(beams_) * std::abs(step_rad_) > 2 * kPi - 1.5 * std::abs(step_rad_);
}

std::ptrdiff_t HitRanges::beam_along(double angle_rad) const {
  // From the middle of the scan, so that its ends are not taken for each other.
  const auto middle = static_cast<double>(beams_ / 2);
  const double away = wrap_angle(angle_rad - angle_min_rad_ - middle * step_rad_);
  return static_cast<std::ptrdiff_t>(std::floor(middle + away / step_rad_));
}

void ScanMemory::remember(const LaserScan& scan, const BeamConvention& convention, const Pose2& T_odom_robot) {
  scans_.push_back({scan.stamp, (T_odom_robot * scan.T_robot_laser).inverse(), HitRanges(scan, convention)});
  if (scans_.size() > kScans) scans_.pop_front();
}

bool ScanMemory::is_fresh(const Scan& scan, Stamp now) { return std::abs(to_seconds(now - scan.stamp)) <= kOldest_s; }

int ScanMemory::scans(Stamp now) const {
  return static_cast<int>(
      std::count_if(scans_.begin(), scans_.end(), [now](const Scan& scan) { return is_fresh(scan, now); }));
}

int ScanMemory::times_hit(const Point2& p_odom, Stamp now) const {
  int times = 0;
  for (const Scan& scan : scans_) {
    if (!is_fresh(scan, now)) continue;
    const Point2 p = scan.T_laser_odom * p_odom;
    const double range = p.norm();
    const std::ptrdiff_t beam = scan.hits.beam_along(std::atan2(p.y(), p.x()));
    bool hit = false;
    for (std::ptrdiff_t i = beam - 1; i <= beam + 2 && !hit; ++i) {
      const double here = scan.hits.at(i);
      hit = (here > 0 && std::abs(here - range) < kSamePlace_m) ||
            (i <= beam + 1 && between(here, scan.hits.at(i + 1), range));
    }
    times += hit;
  }
  return times;
}

}  // namespace smokemap
