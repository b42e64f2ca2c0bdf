#pragma once

#include <vector>

#include "acg/graph_state.hpp"
#include "acg/scan_pieces.hpp"

namespace smokemap {

/// What beams say about a wall, in bins of 10 cm along it, counted in nodes.
struct WallEvidence {
  std::vector<int> hit;      ///< nodes with an echo from a face there
  std::vector<int> through;  ///< nodes with a beam through it
  double bin_m = 0.1;

  double hit_m() const;      ///< length on which echoes outweigh beams through
  double through_m() const;  ///< length that beams of two nodes or more went through, with hardly an echo
  double length_m() const { return bin_m * static_cast<double>(hit.size()); }
};

/// Also finds the ends of walls that stand free in the plan (door jambs): a beam hits the face, its neighbour outwards
/// passes.
struct BeamReading {
  std::vector<WallEvidence> walls;  ///< one per wall of the plan
  std::vector<EndLink> ends;
};

/// @param end_gate_m per wall: an end farther from where the plan has it is not its end
/// Cost: for each node and wall in reach the beams in its sector.
BeamReading read_beams(const std::vector<NodeView>& views, const std::vector<bool>& use_node, const PlanModel& plan,
                       const GraphState& state, const std::vector<double>& end_gate_m);

}  // namespace smokemap
