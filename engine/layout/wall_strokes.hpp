#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "layout/ink_stroke.hpp"
#include "layout/layout_params.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// Ink strokes told apart by what they are.
struct WallStrokes {
  std::vector<InkStroke> walls;
  std::vector<InkStroke> thin;  ///< of the plan's region, too thin for its walls: leaves, windows, treads, furniture
  double thickness_px = 0;      ///< of the thickest usual walls
  double thickest_px = 0;       ///< of the thickest long walls
  double thin_limit_px = 0;     ///< below is not wall
  bool hollow = false;          ///< the plan draws its walls as two thin lines
  double hollow_px = 0;         ///< outer thickness of the walls drawn as two lines, 0 = none
  double outline_px = 0;        ///< thickness of those lines
  std::vector<LayoutDrawing> drawings;  ///< parts of the sheet that could be a plan, best first
};

/// Chooses the plan among the drawings on the sheet (most junctions and wall length) and its thickness classes, which
/// it reads from the histogram of thicknesses: the emptiest place below the main class parts walls from thin lines.
/// Where no class stands out, pairs of parallel thin lines are the walls (hollow), else the single lines themselves.
/// @param least_px  walls are at least so thick; 0 = find out
/// @param at        the drawing at this place instead of the best one
WallStrokes select_walls(const std::vector<InkStroke>& strokes, cv::Size picture, const LayoutParams& params,
                         double least_px = 0, const std::optional<Point2>& at = std::nullopt);

/// Pairs of parallel thin lines as one stroke each, as thick as both together. A line with like neighbours on both
/// sides (stairs, hatching, shelves) makes no pair.
std::vector<InkStroke> pair_hollow(const std::vector<InkStroke>& thin, double max_spacing_px);

/// Drops stairs, hatching and shelves: lines with like neighbours on both sides, evenly spaced at most `max_spacing_px`
/// apart, and the outermost lines of such a row.
std::vector<InkStroke> without_ladders(const std::vector<InkStroke>& strokes, double max_spacing_px);

/// Drops small groups of short strokes that run every way and touch nothing else: hobs, basins, round columns.
std::vector<InkStroke> without_discs(const std::vector<InkStroke>& strokes, double thickness_px, double side_px);

/// Drops thick lines of dashes and dots (limits and axes, ISO 128): short pieces between long ones in line, with the
/// same gap on both sides, and what carries them on. Everything is kept unless there are at least five dots.
std::vector<InkStroke> without_dash_dot_lines(const std::vector<InkStroke>& strokes);

/// Which strokes that drops.
std::vector<bool> in_dash_dot_lines(const std::vector<InkStroke>& strokes);
/// Those of a picture.
std::vector<InkStroke> dash_dot_lines(const std::vector<InkStroke>& strokes, cv::Size picture,
                                      const LayoutParams& params);

/// Strokes on one line, overlapping or less than `gap_px` apart, become one.
std::vector<InkStroke> merge_collinear(std::vector<InkStroke> strokes, double angle_deg, double gap_px);

}  // namespace smokemap
