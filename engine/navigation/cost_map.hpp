#pragma once

#include <cstdint>
#include <vector>

#include "core/result.hpp"
#include "grids/occupancy_grid.hpp"
#include "maps/layout_map.hpp"
#include "maps/merged_map.hpp"

namespace smokemap {

/// What a robot would drive on.
enum class Ground : std::uint8_t {
  kUnknown,  ///< neither seen nor drawn
  kFree,     ///< a sensor saw it free
  kPlanned,  ///< not seen yet, but inside the plan and no wall is drawn there
  kBlocked,  ///< seen occupied (more than a lone echo), or a wall of the merged map that nobody saw through
};

struct CostMapParams {
  double resolution_m = 0.10;
  double robot_radius_m = 0.30;    ///< with what poses may be wrong by: a robot of 0.25 m scraped at jambs
  double soft_clearance_m = 0.40;  ///< beyond the radius: nearer to walls costs more
  double planned_penalty = 1.5;    ///< a metre through rooms nobody saw costs this much more than a metre seen
  double margin_m = 3.0;           ///< around everything known
  Result<Ok> validate() const;
};

/// Where a robot may go, in `map`. Immutable after it was built.
class CostMap {
 public:
  CostMap(const GridFrame& frame, std::vector<Ground> ground, const CostMapParams& params);

  const GridFrame& frame() const { return frame_; }
  const CostMapParams& params() const { return params_; }
  Ground ground(Cell cell) const { return frame_.contains(cell) ? ground_[frame_.index(cell)] : Ground::kUnknown; }
  /// Distance to the nearest blocked cell; 0 in it.
  double clearance_m(Cell cell) const {
    return frame_.contains(cell) ? static_cast<double>(clearance_m_[frame_.index(cell)]) : 0.0;
  }
  /// Seen free or planned, with room for the robot's radius.
  bool drivable(Cell cell) const;
  /// The same with these places blocked too: what a robot met that the map does not show.
  CostMap with_blocked(const std::vector<Point2>& places_map) const;
  /// Cost of a metre here, at least 1.
  double cost_per_metre(Cell cell) const;

 private:
  GridFrame frame_;
  std::vector<Ground> ground_;
  std::vector<float> clearance_m_;
  CostMapParams params_;
};

/// Merges what sensors saw with what the corrected plan says of places nobody saw.
/// @param layout may be null: then there is no planned ground
/// An echo or two alone, as smoke sends them, block nothing.
/// A cell that sensors saw free is free even where an unseen wall is drawn; a wall called missing blocks nothing.
/// kDegenerate if there is neither plan nor anything seen.
/// Cost: O(cells).
Result<CostMap> build_cost_map(const MergedMap& merged, const OccupancyGrid& sensed, const LayoutMap* layout,
                               const CostMapParams& params);

}  // namespace smokemap
