#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "maps/odometry.hpp"

namespace smokemap {

/// Trajectories as the TUM benchmark has them: "t x y z qx qy qz qw" a line, seconds, metres; lines with # are
/// comments. The stamp keeps all nine decimals. Covariances are not part of the format.
std::string to_tum(const Trajectory& trajectory);
/// kCorrupt names the first line that is not eight numbers, or whose quaternion has no heading.
Result<Trajectory> from_tum(std::string_view text);

Result<Ok> write_tum(const Trajectory& trajectory, const std::filesystem::path& path);
Result<Trajectory> read_tum(const std::filesystem::path& path);

}  // namespace smokemap
