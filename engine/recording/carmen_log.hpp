#pragma once

#include <string_view>

#include "core/result.hpp"
#include "recording/sensor_log.hpp"

namespace smokemap {

/// CARMEN's log text. Read are
///   FLASER n r1..rn  laser x y theta  robot x y theta  t host m
///   ROBOTLASER1 type start fov step max accuracy mode  n r1..rn  m i1..im  laser x y theta  robot x y theta ...  t
///   host m ODOM x y theta  speed turn-rate acceleration  t host m PARAM laser_front_laser_fov (degrees), PARAM
///   robot_front_laser_max (m)
/// The robot's pose in a scan is an odometry reading too and comes just before the scan. ROBOTLASER1 is used only in a
/// log without FLASER (programs that write both write every scan twice).
///
/// A scan looks 180 degrees ahead unless PARAM says otherwise. An even number of beams divides the field of view, an
/// odd number has a beam at both its ends. The laser's pose on the robot is taken from the two poses of a scan where
/// they agree in every scan (in corrected logs they do not: then the laser sits at the middle and a warning says so).
///
/// SICK lasers say "no return" with a value of their own: range_max_m becomes 80 m where ranges of 80 m and more occur,
/// else 50 m where those occur, else PARAM robot_front_laser_max, else the largest range if it occurs again and again.
Result<SensorLog> read_carmen(std::string_view text);

/// Do the first lines look like a CARMEN log?
bool looks_like_carmen(std::string_view text);

}  // namespace smokemap
