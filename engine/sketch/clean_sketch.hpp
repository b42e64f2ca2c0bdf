#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "maps/sketch_map.hpp"

namespace smokemap {

/// One set for all sketches; relative to the drawing's own extent (longer side of the box around the wall strokes).
struct SketchParams {
  double close_gap_share =
      0.035;  ///< gaps narrower than this are slips of the pen: closed and reported as closed by us
  double report_gap_share = 0.14;  ///< wider ones up to here stay open and are reported: a door, or forgotten
  double join_share = 0.02;        ///< an overshooting or short end this near to another line meets it
  double max_sheet_megapixels = 16;
  int min_wall_px = 3;  ///< walls are drawn at least this thick, so that regions part
  Result<Ok> validate() const;
};

/// A sketch ready for segmentation.
struct CleanSketch {
  cv::Mat free_space;           ///< CV_8UC1, sketch_px, size of the sheet: 255 free inside the outline, 0 elsewhere
  std::vector<SketchGap> gaps;  ///< every opening found: closed by us, or left open
  std::vector<std::string> warnings;  ///< for people, one line each
};

/// Strokes -> raster with closed rooms: walls are drawn, ends that nearly meet are joined, small gaps closed, larger
/// ones left open but reported; a door stroke opens the wall that it crosses or lies on (and shows as an open gap);
/// notes are ignored. Outside is what the border of the sheet reaches once all reported gaps are thought closed.
///
/// @return kDegenerate if there is no wall stroke or no place inside; kTooLarge for a sheet over the limit;
///         kInvalidArgument for non-finite points or an empty sheet.
/// Cost: O(pixels + ends * strokes). Deterministic; the order of strokes does not matter.
Result<CleanSketch> clean_sketch(const SketchMap& sketch, const SketchParams& params = {});

}  // namespace smokemap
