#pragma once

#include <vector>

#include "layout/ink_stroke.hpp"

namespace smokemap {

/// A sheet carries several drawings: floors, wings, an overview, a legend, frames of text. Here strokes are put
/// together to drawings, and drawings are ranked by how much they look like a plan.

/// Strokes that hang together.
struct StrokeRegion {
  std::vector<std::size_t> members;
  double length = 0;
  double longest_line = 0;  ///< pieces of it may belong to other regions
  int junctions = 0;
  Point2 low = Point2::Constant(1e300), high = Point2::Constant(-1e300);
  /// Letters and words have many short strokes in a small space, frames are large and empty.
  double score() const { return members.empty() ? 0 : std::max(0, junctions - 3) * length * (high - low).norm(); }
};

/// Strokes that touch, or continue each other within `bridge_px`, hang together. Best first.
std::vector<StrokeRegion> connected_regions(const std::vector<InkStroke>& strokes, double bridge_px, double side_px);

/// 0 where the two touch or cross.
double gap_between(const Segment2& one, const Segment2& two);

/// Walls of one floor plan.
struct Drawing {
  std::vector<InkStroke> walls;
  Point2 low = Point2::Zero(), high = Point2::Zero();  ///< bounding box
  double score = 0;                                    ///< of its best region
};

/// All drawings that could be a plan, best first: the best region and what belongs to it, then the same with what is
/// left, as long as that has rooms of its own. Corridors, window bands and signs part a building into pieces; a piece
/// belongs if it carries on one of its walls, lies among them, or is a wing with rooms close by.
/// @param reach_px  pieces further apart are other drawings
std::vector<Drawing> rank_drawings(const std::vector<InkStroke>& walls, double thickness_px, double reach_px,
                                   double side_px);

/// Index of the drawing that a person pointed at: the smallest around the place, else the nearest.
std::size_t drawing_at(const std::vector<Drawing>& drawings, const Point2& p);

}  // namespace smokemap
