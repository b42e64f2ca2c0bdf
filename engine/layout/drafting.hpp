#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "layout/ink_stroke.hpp"

namespace smokemap {

/// What draughtsmen draw that stands for something else than a wall along each line.

/// A stretch of wall that is cut and therefore hatched: two parallel faces, oblique lines from one to the other.
struct HatchedBand {
  Segment2 axis;
  double thickness_px = 0;  ///< over both faces
  double cell_px = 0;       ///< of paper between two lines of its hatching
  int lines = 0;            ///< of hatching that were seen
};

/// Faces with at least three like oblique lines between them; then, as wide and hatched in the same direction as those,
/// also short stretches with fewer: piers. Treads run square to their stringers and make no band.
/// @param max_thickness_px  of a wall
std::vector<HatchedBand> find_hatching(const std::vector<InkStroke>& strokes, double max_thickness_px);

/// Dense hatching filled: small spots of paper among many others, all enclosed. Unchanged if there are few.
/// @param ink  CV_8UC1, 255 = ink
cv::Mat with_cells_filled(const cv::Mat& darkness, const cv::Mat& ink);

/// Bands filled as if they were drawn solid; and where lines are dense, all that is as narrow as the paper between
/// them: thinner walls, hatched alike.
/// @param darkness CV_8UC1, 0 paper .. 255 black
cv::Mat with_bands_filled(const cv::Mat& darkness, const std::vector<HatchedBand>& bands);

/// Of the bands' length, what walls were read along: 0..1, 1 without bands.
double share_read(const std::vector<HatchedBand>& bands, const std::vector<InkStroke>& walls);

/// Drops dimension lines, their ticks and the lines that lead from them to the building. A dimension line is known by
/// like oblique ticks that cross it, at both its ends at least (ISO 129).
/// @param ink     CV_8UC1, 255 = ink
/// @param hidden  CV_8UC1, 255 where arrows and signs lie over the drawing; empty: nowhere
std::vector<InkStroke> without_dimensions(const std::vector<InkStroke>& strokes, const cv::Mat& ink,
                                          const cv::Mat& hidden = {});

/// Which strokes are leaves of doors, or lie on the arcs that their tips go along.
/// @param ink     CV_8UC1, 255 = ink
/// @param hidden  CV_8UC1, 255 where arrows and signs lie over the drawing
std::vector<bool> door_leaves(const std::vector<InkStroke>& strokes, const cv::Mat& ink, const cv::Mat& hidden);

/// Drops lines that the paper was ruled with: even distances, reaching over most of the picture. What is drawn over
/// them more heavily stays.
std::vector<InkStroke> without_ruling(const std::vector<InkStroke>& strokes, cv::Size picture);

}  // namespace smokemap
