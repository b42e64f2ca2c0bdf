#pragma once

#include "core/result.hpp"

namespace smokemap {

/// One set for all sketches; relative to the drawing's own extent (longer side of the box around the wall strokes).
struct SketchParams {
  double close_gap_share =
      0.035;  ///< gaps narrower than this are slips of the pen: closed and reported as closed by us
  double report_gap_share = 0.14;  ///< wider ones up to here stay open and are reported: a door, or forgotten
  double widest_gap_share = 0.30;  ///< an outline open wider than this has no inside
  double join_share = 0.02;        ///< an overshooting or short end this near to another line meets it
  double max_sheet_megapixels = 16;
  int min_wall_px = 3;  ///< walls are drawn at least this thick, so that regions part
  Result<Ok> validate() const;
};

}  // namespace smokemap
