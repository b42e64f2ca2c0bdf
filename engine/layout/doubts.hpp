#pragma once

#include <vector>

#include "layout/ink_stroke.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// What speaks against a reading as a whole.
struct ReadingDoubts {
  bool no_rooms = false;   ///< the edges of the sheet, glare, or a plan drawn in a way that is not understood
  bool part_read = false;  ///< lines of the drawing are neither wall nor opening, or many walls close no room
  bool tangled = false;    ///< lines cross one another at all angles, as they do in no building
  bool crowded = false;    ///< many walls are doubtful each for itself
};

/// How much of a drawing its reading explains.
struct Completeness {
  double bordering = 1;  ///< share of the walls' length that bounds a room
  double unread = 0;  ///< length of long lines that hang together with the walls, lie in no room and are neither wall
                      ///< nor opening, by the length of the walls
};
Completeness completeness_of(const LayoutMap& map, const std::vector<InkStroke>& strokes);

/// Share of the places where walls meet that are crossings of two lines askew to each other or to the plan.
double tangle_of(const LayoutMap& map);

/// Lowers the confidences of walls and corners where the reading as a whole is doubtful: then no wall is sure. What a
/// person drew stays as it is.
/// @param strokes   all that was traced in the picture, in the map's pixels
/// @param fragment  the reader knows that only a part was read
ReadingDoubts doubt_reading(LayoutMap& map, const std::vector<InkStroke>& strokes, bool fragment);

/// Says in words what is doubtful, and how the scale is known.
/// @param bar  the scale comes from a scale bar
void add_warnings(LayoutMap& map, const ReadingDoubts& doubts, bool bar);

}  // namespace smokemap
