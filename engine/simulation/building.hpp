#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "geometry/polygon.hpp"
#include "geometry/segment2.hpp"
#include "simulation/segment_world.hpp"

namespace smokemap {

/// A straight piece of wall between two corners or junctions; its centre line.
struct PlanWall {
  int corner_a = 0;  ///< index into FloorPlan::corners
  int corner_b = 0;
  double thickness_m = 0.15;
  Material material = Material::kBrick;
  bool outer = false;
};

/// A gap in a wall, as shares of its length from corner_a: survives every stretching.
struct PlanDoor {
  int wall = 0;
  double from = 0;
  double to = 0;
  bool hinge_at_to = false;  ///< else at `from`
  bool swings_left = true;   ///< of the direction corner_a -> corner_b
  bool has_leaf = false;     ///< stands in the true world; without one the gap is an open passage
  double open_rad = 0;       ///< how far the leaf stands open in the true world
};

/// Drawn in plans only: a robot's sensors look at the wall below the sill.
struct PlanWindow {
  int wall = 0;
  double from = 0;
  double to = 0;
};

struct PlanRoom {
  std::string name;
  std::vector<int> ring;  ///< corners counter-clockwise, those of junctions along its walls included
  bool corridor = false;
};

/// A storey as a graph of walls, in metres, y up. The same type holds the true building (frame `world`) and a plan of
/// it, right or wrong.
struct FloorPlan {
  std::string title;
  std::vector<Point2> corners;
  std::vector<PlanWall> walls;
  std::vector<PlanDoor> doors;
  std::vector<PlanWindow> windows;
  std::vector<PlanRoom> rooms;
  std::vector<Polygon> furniture;  ///< stands in the true world, never drawn

  Segment2 wall_line(int wall) const;
  Segment2 door_gap(int door) const;
  /// The centre lines of a wall between its doors.
  std::vector<Segment2> wall_pieces(int wall) const;
  Polygon outline(int room) const;
  /// The room that holds the point; -1 = none.
  int room_at(const Point2& p) const;
  /// The two rooms a wall separates; -1 = outside.
  std::pair<int, int> rooms_beside(int wall) const;
};

/// A room to be walled in. Rooms may touch but not overlap.
struct RoomOutline {
  std::string name;
  Polygon outline;  ///< counter-clockwise, on wall centre lines
  bool corridor = false;
};

struct WallStyle {
  double outer_thickness_m = 0.30;
  double inner_thickness_m = 0.14;
  Material outer_material = Material::kBrick;
  Material inner_material = Material::kWood;  ///< plasterboard answers the radar like wood
};

/// Walls around all rooms: shared walls once, cut at every junction; no doors yet.
/// kInvalidArgument for a ring of fewer than three corners or without area.
Result<FloorPlan> wall_in(const std::vector<RoomOutline>& rooms, const WallStyle& style = {});

/// Puts a door of `width_m` into the wall piece that passes through `p` (within 0.05 m); moved along the wall just far
/// enough to keep `jamb_m` from the faces at its ends. kNotFound without such a wall, kDegenerate if it is too short.
Result<Ok> add_door(FloorPlan& plan, const Point2& p, double width_m, double jamb_m = 0.1);
Result<Ok> add_window(FloorPlan& plan, const Point2& p, double width_m);

/// The true world: two faces for every wall, jambs at the doors, leaves, furniture.
/// The faces are the border of the union of all thick walls, so corners and junctions are closed and rays leak nowhere.
SegmentWorld build_world(const FloorPlan& plan);

/// Small fixed buildings for tests. All have their lower left outer corner near (0, 0).
FloorPlan one_room_building();  ///< 6 x 4 m, no door
FloorPlan two_room_building();  ///< two 4 x 4 m rooms, a door between
FloorPlan corridor_building();  ///< a 14 x 2 m corridor, three rooms on either side
FloorPlan slanted_building();   ///< three rooms, walls at 30 degrees to one another: nothing Manhattan

}  // namespace smokemap
