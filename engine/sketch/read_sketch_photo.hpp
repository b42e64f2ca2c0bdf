#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "core/progress.hpp"
#include "core/result.hpp"
#include "maps/sketch_map.hpp"

namespace smokemap {

/// Relative to the long side of the picture, or to the pen's own width (`_pens`), which is measured first.
struct SketchPhotoParams {
  double work_long_side_px = 1600;  ///< larger photographs are read at this size
  double background_share = 0.03;   ///< radius of what counts as paper around a pixel
  double min_stroke_share = 0.02;   ///< shorter figures are dots, letters or noise
  double hair_share = 0.015;        ///< lines with a loose end shorter than this are slips of the pen
  double text_share = 0.04;         ///< compact figures smaller than this are taken for text
  double ruled_turn_deg = 3.0;      ///< ruled lines run parallel within this
  double simplify_pens = 0.6;       ///< how far a polyline may leave the drawn line
  double max_megapixels = 40;
  Result<Ok> validate() const;
};

/// A photographed drawing as wall strokes.
struct SketchPhoto {
  int width_px = 0;  ///< of the photograph: strokes are in its pixels
  int height_px = 0;
  std::vector<Stroke> strokes;        ///< centre lines of walls, then what hatches areas and steps, as notes; ids
                                      ///< "photo-0", "photo-1", ... in reading order
  std::vector<std::string> warnings;  ///< for people, one line each
};

/// Photograph of a drawing (pen on white, squared or ruled paper, shadows) -> centre lines of the walls drawn.
/// The light is divided out, ruled lines (thin, faint, parallel, evenly spaced) are suppressed, letters
/// dropped and hatched areas outlined where recognisable, and the rest is thinned and traced from junction to junction.
///
/// @return kInvalidArgument for an empty picture, kTooLarge over the limit, kDegenerate if nothing was drawn,
/// kCancelled. Cost: about 0.3 s for 2 megapixels. Deterministic.
Result<SketchPhoto> read_sketch_photo(const cv::Mat& picture_bgr, const SketchPhotoParams& params = {},
                                      const Progress& progress = {});

}  // namespace smokemap
