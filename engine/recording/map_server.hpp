#pragma once

#include <filesystem>

#include "core/result.hpp"
#include "grids/occupancy_grid.hpp"

namespace smokemap {

/// Writes `prefix`.pgm and `prefix`.yaml as ROS map_server keeps maps (trinary, 254 free, 0 occupied, 205 unknown), and
/// `prefix`.png, the same picture for people. Nothing is left behind on failure. kDegenerate for an empty grid.
Result<Ok> write_map(const OccupancyGrid& grid, const std::filesystem::path& prefix);

/// Reads a map by its yaml (modes trinary, scale and raw; negate honoured; PGM or PNG beside it).
/// kUnsupported for an origin that is turned, kTooLarge over 100 million cells.
Result<OccupancyGrid> read_map(const std::filesystem::path& yaml);

}  // namespace smokemap
