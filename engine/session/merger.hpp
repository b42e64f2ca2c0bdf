#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "acg/auto_complete_graph.hpp"
#include "core/progress.hpp"
#include "navigation/cost_map.hpp"
#include "session/commands.hpp"
#include "session/graph_union.hpp"
#include "session/snapshot.hpp"
#include "slam/render_map.hpp"

namespace smokemap {

/// Everything the merge needs, as immutable values.
struct MergeInput {
  FloorGraph floor;  ///< of all robots; may be empty
  std::shared_ptr<const LayoutView> layout;
  std::optional<PlanStart> start;
  std::map<std::string, AddAnchor> anchors;
  std::map<int, WallVerdict> wall_verdicts;
  std::map<int, double> wall_lengths_m;
  std::map<int, Point2> corner_pins;
};

struct MergeResult {
  std::shared_ptr<const MergedMap> merged;
  std::shared_ptr<const OccupancyGrid> sensed;
  std::shared_ptr<const CostMap> cost_map;   ///< null when nothing is known yet
  int generation = 0;                        ///< of the graph that this was made from
  std::map<std::string, Pose2> T_map_graph;  ///< per robot: correction of its newest node; what comes after moves along
  std::string complaint;                     ///< the last solve gave no usable answer; the map is the one before
};

/// Plan and pose graph -> merged map, occupancy, ground for navigation. Slow (up to a second): runs beside the engine.
/// Warm-started: keeps the Auto-Complete Graph and the drawn map between calls.
class Merger {
 public:
  MergeResult run(const MergeInput& input, const Progress& progress = {});

 private:
  void start_over();
  void take_plan(const MergeInput& input);
  void take_word_of_people(const MergeInput& input);
  std::shared_ptr<const MergedMap> merge(const MergeInput& input, const Progress& progress, std::string& complaint);

  AutoCompleteGraph acg_;
  MapRenderer renderer_;
  MergeInput known_;
  bool has_plan_ = false;
  std::shared_ptr<const MergedMap> last_ = std::make_shared<const MergedMap>();
  int revision_ = 0;
};

/// The plan before any robot moved: rigid, nothing seen, laid so that the start (if given) is the map's origin.
MergedMap plan_alone(const LayoutMap& layout, const std::optional<PlanStart>& start);

}  // namespace smokemap
