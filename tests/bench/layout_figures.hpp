#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "maps/layout_map.hpp"

namespace smokemap::bench {

/// What is true about a picture of a plan; all in its pixels.
struct PlanTruth {
  std::vector<Segment2> walls, openings;  ///< openings cost nothing, whatever is read there
  std::vector<Point2> corners;
  std::vector<Polygon> rooms;
  std::vector<LayoutSign> signs;
};

struct F1 {
  double precision = 0, recall = 0;
  double value() const { return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0; }
};

/// Unit: a thousandth of the long side of the true walls' box. Walls by length, within 5 units and 10 degrees; corners
/// one to one within 10; rooms one to one from an overlap (IoU) of a half.
struct PlanFigures {
  F1 walls, corners, rooms;
  int rooms_off = 0;                                     ///< difference in number
  int signs_true = 0, signs_found = 0, signs_wrong = 0;  ///< by class of colour, around the plan
  int taps = 0;                                          ///< one for a false wall, one drag for a missing one
  std::vector<std::pair<double, bool>> said_walls;       ///< confidence, and whether it is a wall
  std::vector<std::pair<double, bool>> said_corners;
};
PlanFigures measure_plan(const LayoutMap& read, const PlanTruth& truth);

/// The truth of a file beside a picture: walls, doors, corners, rooms. Empty walls if it cannot be read.
PlanTruth read_truth(const std::string& path, std::string* image = nullptr);

/// Row by row what happens to files that mean harm, or are odd: name, answer, seconds of processor time, peak memory.
void print_hostile_files();

}  // namespace smokemap::bench
