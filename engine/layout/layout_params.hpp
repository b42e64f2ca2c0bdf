#pragma once

#include "core/result.hpp"

namespace smokemap {

/// One set for all plans. Lengths are relative: to the long side of the picture (`_share`), or to the thickness of the
/// plan's own walls (`_walls`), which is measured first. Nothing here is in pixels.
struct LayoutParams {
  // intake
  double max_megapixels = 40;       ///< larger pictures are refused
  double work_long_side_px = 3400;  ///< larger pictures are read at this size
  double min_long_side_px = 1600;   ///< smaller ones are enlarged (at most twice): thin walls need some pixels across

  // light and colour
  double background_share = 0.035;  ///< radius of what counts as paper around a pixel
  double ink_low = 0.20;            ///< ink is half as dark as the darkest around it, within these limits (1 = black)
  double ink_high = 0.50;
  double solid_share = 0.6;     ///< of the darkness of the walls: lighter figures are tints, not signs
  double colour_chroma = 0.27;  ///< from here on a pixel is coloured: signs, routes, headers

  // walls
  double min_wall_share = 0.008;     ///< shorter pieces are text, furniture or noise
  double max_wall_share = 0.022;     ///< thicker is no wall: frames, blocks of colour
  double thin_ratio = 0.30;          ///< of the main thickness: below are door leaves, treads, furniture
  double merge_angle_deg = 3.0;      ///< collinear pieces become one wall
  double snap_walls = 1.6;           ///< loose ends within this many thicknesses of a crossing are joined to it
  double max_opening_share = 0.075;  ///< of the plan's long side: wider gaps are no doors

  // scale
  double door_width_m = 0.90;      ///< what a median door of a public building measures
  double door_width_sigma = 0.20;  ///< relative error of a scale guessed from doors

  Result<Ok> validate() const;
};

}  // namespace smokemap
