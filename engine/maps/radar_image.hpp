#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.hpp"
#include "maps/radar_sweep.hpp"

namespace smokemap {

/// A radar sweep as the float picture (ROS encoding 32FC1) in which it crosses sensor_msgs/Image and bags.
///
/// One row an azimuth. As in the pictures of the Navtech drivers and the Oxford radar data set, every row begins with
/// what is needed to read it, here four floats: azimuth (rad), seconds since the stamp of the picture, range of the
/// first bin (m), metres per bin. Then the power of each bin. Differs from those pictures: floats instead of bytes, so
/// that nothing is lost and any picture viewer still shows it.
inline constexpr int kRadarRowHeader = 4;
/// More than any spinning radar delivers; what claims more is refused.
inline constexpr int kMostRadarAzimuths = 8192;
inline constexpr int kMostRadarBins = 32768;

/// azimuths x (kRadarRowHeader + bins), row-major.
std::vector<float> to_radar_rows(const RadarSweep& sweep);

/// Stamp, robot and T_robot_radar are left to the caller. kCorrupt unless azimuths are evenly spaced (to a tenth of a
/// step), times do not run backwards, and every row has the same range scale; duration is taken from the row times.
/// Angles and times survive to float precision.
Result<RadarSweep> from_radar_rows(std::span<const float> rows, int height, int width);

/// Rejects what no later stage should see: wrong lengths, no azimuths, non-finite pose or scale.
Result<Ok> check(const RadarSweep& sweep);

}  // namespace smokemap
