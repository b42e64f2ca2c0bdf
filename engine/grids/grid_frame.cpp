#include "grids/grid_frame.hpp"

namespace smokemap {

GridFrame frame_around(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double resolution_m, double margin_m) {
  GridFrame frame;
  frame.resolution_m = resolution_m;
  const Eigen::Vector2d from = ((low.array() - margin_m) / resolution_m).floor();
  const Eigen::Vector2d to = ((high.array() + margin_m) / resolution_m).ceil();
  frame.origin = from * resolution_m;
  frame.width_cells = std::max(1, static_cast<int>(to.x() - from.x()));
  frame.height_cells = std::max(1, static_cast<int>(to.y() - from.y()));
  return frame;
}

}  // namespace smokemap
