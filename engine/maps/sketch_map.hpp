#pragma once

#include <string>
#include <vector>

#include "core/time.hpp"
#include "geometry/segment2.hpp"

namespace smokemap {

enum class StrokeKind { kWall, kDoor, kNote };

/// One movement of the pen, as drawn. Immutable once committed; erasing and undoing are events of their own.
struct Stroke {
  std::string id;  ///< made by the client
  std::string author;
  StrokeKind kind = StrokeKind::kWall;
  double width_px = 3;
  std::vector<Point2> points_px;  ///< sketch_px: y down
};

/// What somebody drew: strokes on a sheet without scale.
struct SketchMap {
  int width_px = 1024;
  int height_px = 768;
  std::vector<Stroke> strokes;
};

/// A place where a room is not closed, shown back to the person with a "close gap" tap.
struct SketchGap {
  Segment2 gap_px;
  bool closed_by_us = false;  ///< small enough that we closed it ourselves
};

}  // namespace smokemap
