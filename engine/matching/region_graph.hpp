#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/pose2.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

/// What people keep when they draw a building from memory: which rooms touch, how far apart rooms are on foot, and in
/// which direction one lies from the other. Regions by label - 1.
struct RegionGraph {
  std::vector<std::vector<int>> beside;  ///< sorted, each once
  Eigen::MatrixXi hops;                  ///< borders on the way; number of regions if there is no way
  Eigen::MatrixXd walk;                  ///< pixels from anchor to anchor through the middles of borders; without a way
                                         ///< the straight line, half as much again
  double side_px = 0;                    ///< root of the free area
  std::vector<Point2> middles_px;        ///< centroids
  Eigen::VectorXd area;                  ///< share of all free space
  Eigen::VectorXd importance;            ///< sums to 1; half for being a region, half for the root of its area

  int size() const { return static_cast<int>(beside.size()); }
};

/// Cost: O(regions^3).
RegionGraph make_region_graph(const Segmentation& map);

}  // namespace smokemap
