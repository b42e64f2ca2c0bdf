#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "maps/correspondence.hpp"
#include "maps/goal.hpp"
#include "maps/layout_map.hpp"
#include "maps/point_of_interest.hpp"
#include "maps/sketch_map.hpp"

namespace smokemap {

/// What people do, as values. The server stores a command before the engine gets it; replaying the log rebuilds the
/// state. Every command is idempotent: the same one twice changes nothing the second time.

/// Makes this the plan of the floor. Replaces an earlier one; `plan_id` is the content hash of its picture.
struct SetLayout {
  std::string plan_id;
  LayoutMap layout;
};
/// "The robot stands here on the plan, looking there."
struct SetStart {
  std::string robot;
  Point2 p_layout_px = Point2::Zero();
  double heading_rad = 0;  ///< counter-clockwise from the picture's +x
};
struct AddAnchor {
  std::string id;
  Point2 p_layout_px = Point2::Zero();
  Point2 p_map = Point2::Zero();
};
struct RemoveAnchor {
  std::string id;
};
enum class WallVerdict { kNone, kGone, kThere };
struct JudgeWall {
  int layout_wall = 0;
  WallVerdict verdict = WallVerdict::kNone;
};
/// "This wall is 4.2 m long", measured by a person; no length takes an earlier one back.
struct MeasureWall {
  int layout_wall = 0;
  std::optional<double> length_m;
};
/// "This corner of the plan is here"; no place takes the pin out.
struct PinCorner {
  int layout_corner = 0;
  std::optional<Point2> p_map;
};
struct AddStroke {
  Stroke stroke;
};
/// Erase and undo; `restore` brings a stroke back (redo).
struct EraseStroke {
  std::string stroke_id;
  bool restore = false;
};
struct ClearSketch {};
/// A photographed sketch: its walls become strokes of this sheet.
struct SetSketchSheet {
  int width_px = 1024;
  int height_px = 768;
};
/// Regions are renumbered whenever the drawing changes, so a verdict is kept by the two places that were tapped.
struct JudgePair {
  Point2 p_sketch_px = Point2::Zero();    ///< inside the region of the sketch
  Point2 p_layout_px = Point2::Zero();    ///< inside the region of the plan
  Verdict verdict = Verdict::kConfirmed;  ///< kProposed takes an earlier verdict on these two regions back
};
/// Adds the point, or moves and relabels the one with this id.
struct PlacePoi {
  PointOfInterest poi;
};
struct RemovePoi {
  std::string id;
};
struct SetGoal {
  Goal goal;
};
struct CancelGoal {
  std::string id;
};
/// Stops every robot (or one) and keeps it stopped until released.
struct EmergencyStop {
  std::string robot;  ///< empty = all
  bool engaged = true;
};
struct SetExploring {
  std::string robot;
  bool exploring = true;
};

using Command = std::variant<SetLayout, SetStart, AddAnchor, RemoveAnchor, JudgeWall, MeasureWall, PinCorner, AddStroke,
                             EraseStroke, ClearSketch, SetSketchSheet, JudgePair, PlacePoi, RemovePoi, SetGoal,
                             CancelGoal, EmergencyStop, SetExploring>;

}  // namespace smokemap
