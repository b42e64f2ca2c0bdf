#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"
#include "geometry/segment2.hpp"
#include "maps/pose_graph.hpp"

namespace smokemap::bench {

/// A sensor map and a plan of one floor, with pairs of the same corners; pixels, y down.
struct PairedMaps {
  std::string name, sensor_png, layout_png;
  std::vector<std::pair<Point2, Point2>> corners_px;  ///< sensor, layout
};

/// The maps of one floor (E5, F5, ...) in the folder floor_plans/halmstad. Maps whose pairs cannot be read, or cannot
/// be true (no similarity brings nine in ten to within 5 % of the extent), are left out.
std::vector<PairedMaps> read_paired_maps(const std::string& folder, const std::string& floor);

/// Scans cast in a sensor map (white free, black occupied, grey unknown) along a walk through its free space. Poses are
/// right and held by edges so tight that nothing bends the map. Frame map: metres, y up, origin at the picture's lower
/// left.
PoseGraph walk_in_picture(const std::string& sensor_png, double metres_per_pixel);

}  // namespace smokemap::bench
