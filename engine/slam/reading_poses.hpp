#pragma once

#include <optional>
#include <vector>

#include "maps/odometry.hpp"

namespace smokemap {

/// One reading of a log, in the order of the log.
struct Reading {
  Stamp stamp = 0;
  std::optional<Pose2> T_odom_robot;        ///< the reading itself, or odometry at a scan's stamp
  std::optional<std::size_t> pose_of_scan;  ///< where this scan's pose is in the trajectory
};

/// Where the robot was at every stamp of a log, also between scans: the poses of the scan before and of the one after,
/// carried by odometry, blended. In the order of the log, every stamp once; readings before the first scan or without
/// odometry are left out.
///
/// Logs whose clock ticks in hundredths of a second, or that were written in bursts after a pause, hold readings within
/// half a tick of each other between which the robot has moved, up to half a metre. Which of them a stamp means cannot
/// be told from the stamp; a trajectory has one pose a moment, so it is the mean of theirs.
/// @param scans  Slam::trajectory()
Trajectory poses_of_readings(const std::vector<Reading>& readings, const Trajectory& scans);

}  // namespace smokemap
