#pragma once

#include <cstdint>
#include <vector>

#include "acg/graph_state.hpp"
#include "acg/scan_pieces.hpp"

namespace smokemap {

/// What all scans together say about walls that run square to one direction: where faces were seen, from which side,
/// and where beams went through. A raster of 5 cm across the walls and 10 cm along them, counted in nodes.
class SensedFaces {
 public:
  /// @param heading_rad  in map, of the direction in which these walls are told apart
  /// Cost: beams x cells on their way, some 25 per metre; no cell that a beam crosses is left out.
  SensedFaces(const std::vector<NodeView>& views, const std::vector<bool>& use_node, const GraphState& state,
              double heading_rad);

  /// -1..1: share of a wall's length on which a face of it was seen, less the share that beams went through.
  /// @param at_m    offset of its centre line along the direction
  /// @param from_m  and to_m: its ends, along the direction's left
  double support(double at_m, double from_m, double to_m, double half_thickness_m) const;

 private:
  using Count = std::uint8_t;
  struct Layer {
    std::vector<Count> nodes;
    std::vector<std::uint32_t> last;  ///< node that counted last, plus 1
  };
  void count(Layer& layer, const Point2& a_map, const Point2& b_map, std::uint32_t node);
  int column(double along_m) const;
  int row(double across_m) const;
  Count seen(const Layer& layer, double across_m, int column) const;

  Point2 across_, along_;
  double low_across_m_ = 0, low_along_m_ = 0;
  int rows_ = 0, columns_ = 0;
  Layer from_above_, from_below_, through_;
};

}  // namespace smokemap
