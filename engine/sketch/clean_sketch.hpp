#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "maps/sketch_map.hpp"
#include "sketch/sketch_params.hpp"

namespace smokemap {

/// A sketch ready for segmentation.
struct CleanSketch {
  cv::Mat free_space;           ///< CV_8UC1, sketch_px, size of the sheet: 255 free inside the outline, 0 elsewhere
  std::vector<SketchGap> gaps;  ///< every opening found: closed by us, or left open
  std::vector<Stroke> marks;    ///< drawn among the walls but none: the leaves and arcs of doors
  std::vector<std::string> warnings;  ///< for people, one line each
};

/// Strokes -> raster with closed rooms: walls are drawn, ends that nearly meet are joined, small gaps closed, larger
/// ones left open but reported; a door stroke opens the wall that it crosses or lies on (and shows as an open gap), and
/// so does a door drawn as a leaf with its arc among the walls; notes are ignored. What four or more near and slanting
/// lines hatch, walls or notes, is filled, and the lines are no walls. Outside is what the border of the sheet reaches
/// once all reported gaps are thought closed; where walls would be lost to it, the openings of the outline that let it
/// in are closed, too, and reported.
///
/// @return kDegenerate if there is no wall stroke or no place inside; kTooLarge for a sheet over the limit;
///         kInvalidArgument for non-finite points or an empty sheet.
/// Cost: O(pixels + ends * strokes). Deterministic; the order of strokes does not matter.
Result<CleanSketch> clean_sketch(const SketchMap& sketch, const SketchParams& params = {});

}  // namespace smokemap
