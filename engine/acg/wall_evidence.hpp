#pragma once

#include <memory>
#include <vector>

#include "acg/graph_state.hpp"
#include "acg/scan_pieces.hpp"
#include "acg/wall_sight.hpp"

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

/// Asks the beams of all nodes about all walls, and remembers the answers: what is asked again is only what moved
/// against the robot by two centimetres or more. Copies share what they remember. Forget it (make a new one) with the
/// plan.
class BeamMemory {
 public:
  /// @param end_gate_m per wall: an end farther from where the plan has it is not its end
  /// Cost: nodes x walls in reach, and for what moved the beams in the wall's sector. Deterministic.
  BeamReading read(const std::vector<NodeView>& views, const std::vector<bool>& use_node, const PlanModel& plan,
                   const GraphState& state, const std::vector<double>& end_gate_m);

 private:
  std::shared_ptr<const WallSight> recall(std::size_t node, int wall, const Segment2& wall_robot) const;

  std::vector<std::vector<std::shared_ptr<const WallSight>>> sights_;  ///< per node, ascending wall
};

}  // namespace smokemap
