#include "sketch/sketch_params.hpp"

#include "core/check.hpp"
#include "sketch/read_sketch_photo.hpp"

namespace smokemap {

Result<Ok> SketchParams::validate() const {
  return ParamCheck("SketchParams")
      .in_range("close_gap_share", close_gap_share, 0, 0.5)
      .in_range("report_gap_share", report_gap_share, close_gap_share, 1)
      .in_range("widest_gap_share", widest_gap_share, report_gap_share, 1)
      .in_range("join_share", join_share, 0, 0.2)
      .in_range("max_sheet_megapixels", max_sheet_megapixels, 0.01, 400)
      .in_range("min_wall_px", min_wall_px, 1, 50)
      .result();
}

Result<Ok> SketchPhotoParams::validate() const {
  return ParamCheck("SketchPhotoParams")
      .in_range("work_long_side_px", work_long_side_px, 200, 10000)
      .in_range("background_share", background_share, 0.005, 0.2)
      .in_range("min_stroke_share", min_stroke_share, 0, 0.5)
      .in_range("hair_share", hair_share, 0, 0.5)
      .in_range("text_share", text_share, 0, 0.5)
      .in_range("ruled_turn_deg", ruled_turn_deg, 0.1, 30)
      .in_range("simplify_pens", simplify_pens, 0.05, 10)
      .in_range("max_megapixels", max_megapixels, 0.01, 400)
      .result();
}

}  // namespace smokemap
