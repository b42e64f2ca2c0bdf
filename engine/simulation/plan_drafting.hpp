#pragma once

#include <vector>

#include "geometry/polygon.hpp"
#include "geometry/segment2.hpp"
#include "simulation/plan_canvas.hpp"

namespace smokemap {

/// How the body of a wall is drawn between its faces.
enum class WallFill {
  kSolid,
  kHollow,   ///< two thin lines with paper between
  kHatched,  ///< two thin lines, oblique ones between (poché)
};

/// What is printed or punched on the paper before anybody draws on it.
enum class PaperRuling { kNone, kLines, kSquares };

/// The part of a line of this direction through `p` within a convex ring; a point if there is none.
Segment2 clipped_line(const Polygon& convex, const Point2& p, const Point2& direction);

/// The union of rectangles (corners in order), each around a wall, as two faces with hatching or nothing between.
/// @param line_px       width of faces; hatching is a little thinner
/// @param spacing_px    between lines of the hatching, measured across them
void draw_cut_walls(PlanCanvas& canvas, const std::vector<Polygon>& quads, WallFill fill, double line_px,
                    double spacing_px);

/// A chain of dimensions: a thin line with oblique ticks at the places, numbers above it, and lines that lead to the
/// places on the building.
/// @param places   points of the building in order along the chain; at least two
/// @param line     anywhere on the dimension line; it runs from the first place's foot to the last one's
/// @param leads    with lines from the places to the chain
/// @param metres_per_pixel  of the numbers
void draw_dimensions(PlanCanvas& canvas, const std::vector<Point2>& places, const Segment2& line, bool leads,
                     double unit, double metres_per_pixel);

/// Faint even lines over the whole paper.
void rule_paper(PlanCanvas& canvas, PaperRuling ruling, double spacing_px, double line_px);

}  // namespace smokemap
