#include "layout/layout_params.hpp"

#include "core/check.hpp"

namespace smokemap {

Result<Ok> LayoutParams::validate() const {
  return ParamCheck("LayoutParams")
      .in_range("max_megapixels", max_megapixels, 0.01, 400)
      .in_range("work_long_side_px", work_long_side_px, 400, 10000)
      .in_range("min_long_side_px", min_long_side_px, 1, work_long_side_px)
      .in_range("background_share", background_share, 0.005, 0.2)
      .in_range("ink_low", ink_low, 0.05, 0.95)
      .in_range("ink_high", ink_high, ink_low, 0.95)
      .in_range("solid_share", solid_share, 0.1, 1)
      .in_range("colour_chroma", colour_chroma, 0.05, 0.9)
      .in_range("min_wall_share", min_wall_share, 0.001, 0.1)
      .in_range("max_wall_share", max_wall_share, 0.005, 0.2)
      .in_range("thin_ratio", thin_ratio, 0, 0.9)
      .in_range("merge_angle_deg", merge_angle_deg, 0.1, 20)
      .in_range("snap_walls", snap_walls, 0.1, 10)
      .in_range("max_opening_share", max_opening_share, 0.005, 0.5)
      .in_range("door_width_m", door_width_m, 0.3, 5)
      .in_range("door_width_sigma", door_width_sigma, 0.01, 2)
      .result();
}

}  // namespace smokemap
