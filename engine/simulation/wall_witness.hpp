#pragma once

#include <vector>

#include "geometry/segment2.hpp"
#include "maps/laser_scan.hpp"

namespace smokemap {

/// Counts, from outside, what a robot could know about walls: which parts of them its lidar's echoes fell on, and which
/// parts its beams went through. For judging an answer: a wall that was never looked at cannot be called right or
/// wrong.
class WallWitness {
 public:
  /// @param walls  centre lines, world
  explicit WallWitness(const std::vector<Segment2>& walls);

  /// The robot moved from T_world_start to T_world_end during the scan (the same pose twice for a scan without skew).
  void add(const LaserScan& scan, const Pose2& T_world_start, const Pose2& T_world_end);

  /// Share of the wall's length with at least `least` echoes within 0.25 m of its centre line, counted in pieces of
  /// 0.15 m.
  double seen(int wall, int least) const;
  /// The stretches of the wall that `seen` counts.
  std::vector<Segment2> seen_parts(int wall, int least) const;
  /// Share of its length that at least `least` beams went through, with 0.3 m to spare on both sides.
  double crossed(int wall, int least) const;
  /// Echoes of this wall within `radius_m` of a point.
  int echoes_near(int wall, const Point2& p_world, double radius_m) const;

 private:
  struct Tally {
    Segment2 line;
    Point2 low, high;  ///< box around everything that counts
    std::vector<int> echoes, crossings;
  };
  static double share(const std::vector<int>& counts, int least);
  void add_echo(const Point2& p_world);
  void add_beam(const Point2& from, const Point2& to);
  std::vector<Tally> walls_;
};

}  // namespace smokemap
