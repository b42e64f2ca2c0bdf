#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "maps/layout_map.hpp"
#include "simulation/plan_distortion.hpp"
#include "simulation/plan_drafting.hpp"

namespace smokemap {

struct PlanPictureParams {
  int width_px = 1600;    ///< of the sheet; height follows A3 landscape
  int outer_wall_px = 0;  ///< line width; 0 = true thickness, at least 7 px
  int inner_wall_px = 0;  ///< 0 = true thickness, at least 4 px
  WallFill wall_fill = WallFill::kSolid;
  double hatch_spacing = 0.8;  ///< of the thickness of outer walls
  bool dimensions = false;     ///< lengths along all four sides and across the rooms, as in drawings of architects
  PaperRuling ruling = PaperRuling::kNone;
  double ruling_spacing_m = 1.0;  ///< of the drawing
  bool doors = true;              ///< arcs in the gaps
  bool windows = true;
  bool route = true;  ///< green arrows along the corridors
  bool signs = true;  ///< red, green and blue symbols
  bool room_names = true;
  bool sheet = true;  ///< title, legend, frame, text
  std::string title = "Evacuation plan";
  std::optional<Point2> you_are_here;  ///< plan metres

  bool photo = false;        ///< as taken by a hand-held camera
  double tilt = 0.08;        ///< corner shift, share of the width
  double shade = 0.35;       ///< darkest part of the lighting gradient, share taken away
  double sigma_noise = 4.0;  ///< grey levels
  double glare = 0.6;        ///< strength of one bright blob, 0 = none
  Result<Ok> validate() const;
};

/// An evacuation-plan picture in the manner of ISO 23601 and everything that is true about it.
struct PlanPicture {
  cv::Mat sheet;                        ///< BGR, 8 bit: the flat drawing
  cv::Mat photo;                        ///< empty unless asked for
  SheetHomography homography;           ///< photo -> sheet
  double metres_per_pixel = 0;          ///< of the drawing's own metres (mean true scale differs by the distortion)
  Point2 origin_plan = Point2::Zero();  ///< plan metres at pixel (0, 0)
  std::vector<LayoutSign> signs;        ///< of the drawing, without those of the legend; layout_px
  std::optional<Point2> you_are_here_px;

  /// Plan metres (y up) <-> pixels of the sheet (layout_px, y down).
  Point2 to_pixels(const Point2& p_plan) const;
  Point2 to_plan(const Point2& p_px) const;
};

Result<PlanPicture> draw_plan(const FloorPlan& plan, const PlanPictureParams& params, std::mt19937_64& random);

/// What a perfect reader would get out of the picture, with the truth for every part of it.
/// Walls are cut at doors and junctions, so corners are junctions and door jambs.
struct TrueLayout {
  LayoutMap layout;                  ///< layout_px
  std::vector<Point2> corner_world;  ///< per corner: where it truly is
  std::vector<int> wall_source;      ///< per wall: true wall, -1 = phantom
};
TrueLayout true_layout(const DistortedPlan& plan, const PlanPicture& picture);

}  // namespace smokemap
