#pragma once

#include <utility>
#include <vector>

#include "layout/ink_stroke.hpp"
#include "layout/layout_params.hpp"

namespace smokemap {

/// The value below which `share` of the weight lies; 0 of nothing.
double weighted_quantile(std::vector<std::pair<double, double>> value_weight, double share);

/// Makes the strokes as thick as they would look from straight ahead: a photograph taken from below or aside shortens
/// one way, and with it the thickness of walls that run the other way.
void straighten_thickness(std::vector<InkStroke>& strokes);

/// How thick the walls of a plan are.
struct ThicknessClasses {
  double usual_px = 0;
  double outer_px = 0;       ///< outer walls may be twice as thick as partitions, whichever of them are more
  double thin_limit_px = 0;  ///< what is thinner is no wall
};
/// Read from the histogram of thicknesses: the emptiest place below the main class parts walls from thin lines.
ThicknessClasses thickness_classes(const std::vector<InkStroke>& plan, const LayoutParams& params);

}  // namespace smokemap
