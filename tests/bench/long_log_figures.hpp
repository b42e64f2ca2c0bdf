#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "maps/laser_scan.hpp"
#include "slam/trajectory_error.hpp"

namespace smokemap::bench {

/// What makes a long log harder than a good one.
struct LongLogKind {
  /// All rooms, doors and pillars are the same, every few metres: one step along a corridor looks like the next, and
  /// only its ends and the lengths of the blocks tell where the robot is.
  bool alike = false;
  /// Scans lie at least so far apart, or are turned by so much (0: every 0.2 m and 0.2 rad); the odometry between them
  /// is there. As logs are that a mapper has thinned.
  double scans_apart_m = 0, scans_apart_rad = 0;
  double turn_told = 1;  ///< share of every turn that the odometry tells
  int people = 0;        ///< who walk some metres before the robot, all the time
};

/// A drive of a kilometre and more, as the logs of universities are: a grid of corridors around blocks of rooms
/// (about 65 m x 50 m), a scanner that looks forward over half a turn (180 beams, 1 cm noise), wheels that slip.
struct LongLog {
  std::vector<std::variant<LaserScan, Odometry>> items;
  Trajectory truth;  ///< one entry a scan
  /// What people would verify: steps of about a metre, and every place seen again.
  std::vector<PoseRelation> relations;
  std::vector<PoseRelation> revisits;  ///< those of them that close a loop
  double way_m = 0;
};

/// Walks at random through the corridors, into a room now and then, until `way_m` are driven. The same seed gives the
/// same building and the same way, whatever the kind but `alike`.
LongLog long_log(std::uint64_t seed, double way_m, const LongLogKind& kind = {});

}  // namespace smokemap::bench
