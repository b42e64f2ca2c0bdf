#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "maps/laser_scan.hpp"

namespace smokemap {

/// Ranges of the beams of a scan that hit something, by index.
class HitRanges {
 public:
  HitRanges(const LaserScan& scan, const BeamConvention& convention);
  std::ptrdiff_t beams() const { return beams_; }
  double step_rad() const { return step_rad_; }
  double angle(std::ptrdiff_t i) const { return angle_min_rad_ + static_cast<double>(i) * step_rad_; }
  bool full_turn() const { return full_turn_; }
  /// 0 for beams that hit nothing, and beyond the ends of a scan that is no full turn; around a full turn goes on.
  double at(std::ptrdiff_t i) const {
    if (full_turn_) i = (i % beams_ + beams_) % beams_;
    return i >= 0 && i < beams_ ? ranges_[static_cast<std::size_t>(i)] : 0.0;
  }
  /// The beam that looks along a bearing of the laser's frame; it may lie beyond the ends.
  std::ptrdiff_t beam_along(double angle_rad) const;

 private:
  double angle_min_rad_, step_rad_;
  std::ptrdiff_t beams_;
  bool full_turn_ = false;
  std::vector<double> ranges_;
};

/// The last few scans and where they were taken. A wall that was hit is hit again from a little farther on; smoke
/// answers from another depth every time.
class ScanMemory {
 public:
  static constexpr std::size_t kScans = 4;
  /// @param T_odom_robot  wheels or a matched track; has to be smooth over a second only
  void remember(const LaserScan& scan, const BeamConvention& convention, const Pose2& T_odom_robot);
  /// Scans remembered that are at most a second older than `now`.
  int scans(Stamp now) const;
  /// In how many of these something was hit at this place: beside it at the same range, or on both sides of it on one
  /// surface.
  int times_hit(const Point2& p_odom, Stamp now) const;

 private:
  struct Scan {
    Stamp stamp;
    Pose2 T_laser_odom;
    HitRanges hits;
  };
  static bool is_fresh(const Scan& scan, Stamp now);
  std::deque<Scan> scans_;
};

}  // namespace smokemap
