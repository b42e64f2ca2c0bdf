#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/polygon.hpp"
#include "geometry/segment2.hpp"
#include "grids/grid_frame.hpp"

namespace smokemap {

/// Everything here is in layout_px: pixels of the rectified picture, column and row, y down.

struct LayoutCorner {
  Point2 p_px = Point2::Zero();
  int degree = 0;         ///< walls that meet here
  double confidence = 1;  ///< 0..1
};

struct LayoutWall {
  int corner_a = 0;  ///< index into corners
  int corner_b = 0;
  double thickness_px = 0;
  double confidence = 1;   ///< 0..1: how sure the reader is that this stroke is a wall
  bool by_person = false;  ///< drawn, or switched on, by somebody
};

enum class OpeningKind { kDoor, kWindow, kPassage };
struct LayoutOpening {
  Segment2 gap_px;
  OpeningKind kind = OpeningKind::kDoor;
  double confidence = 1;
};

struct LayoutSign {
  Point2 p_px = Point2::Zero();
  double radius_px = 0;
  std::string colour;  ///< "green", "red", "blue", "yellow"; "grey" on a copy without colours
  double confidence = 1;
};

struct LayoutScale {
  double metres_per_pixel = 0;
  double relative_sigma = 0;  ///< 0.1 = ten percent
  bool by_person = false;     ///< measured by somebody, not guessed from doors or sheet size
};

/// One of the drawings on a sheet: a floor, a wing, an overview.
struct LayoutDrawing {
  Point2 low_px = Point2::Zero();  ///< bounding box of its walls
  Point2 high_px = Point2::Zero();
  double score = 1;     ///< 0..1, how much it looks like a plan compared with the best one
  bool chosen = false;  ///< the walls are this one's
};

/// An evacuation plan as a graph of walls.
struct LayoutMap {
  int width_px = 0;
  int height_px = 0;
  std::vector<LayoutCorner> corners;
  std::vector<LayoutWall> walls;
  std::vector<LayoutOpening> openings;
  std::vector<Polygon> rooms_px;
  std::vector<LayoutSign> signs;
  std::vector<LayoutDrawing> drawings;  ///< of the sheet, best first; several: a person should say which one is meant
  std::optional<Point2> you_are_here_px;
  std::optional<LayoutScale> scale;
  std::vector<std::string> warnings;  ///< for people, one line each

  Segment2 wall_px(int wall) const {
    const auto& w = walls[static_cast<std::size_t>(wall)];
    return {corners[static_cast<std::size_t>(w.corner_a)].p_px, corners[static_cast<std::size_t>(w.corner_b)].p_px};
  }
  /// layout_px <-> layout (metres, y up). Needs a scale.
  PixelFrame frame() const { return {height_px, scale ? scale->metres_per_pixel : 1.0}; }
  Segment2 wall_m(int wall) const {
    const Segment2 px = wall_px(wall);
    return {frame().to_metres(px.a), frame().to_metres(px.b)};
  }
};

/// Corners in the picture as taken -> the rectified sheet. Row-major 3x3.
struct SheetHomography {
  std::array<double, 9> H_layout_photo{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

}  // namespace smokemap
