#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "segmentation/cuts.hpp"
#include "segmentation/segment.hpp"

namespace smokemap {

/// A boundary between rooms, and how far it is from being refused.
struct ChosenCut {
  Cut cut;
  bool is_mouth = false;  ///< not a door, but where a narrow place opens into a wider one
  double cost = 0;        ///< 0..1; at 1 it would have been refused
};

struct CutChoice {
  std::vector<ChosenCut> cuts;
  bool has_doors = false;  ///< the map shows doors; where none are, its open boundaries are drawn more freely
};

/// Chooses among `candidates` the boundaries of rooms.
/// @param structure      CV_8UC1, 255 = free, rim not free
/// @param least_area_px  what is smaller is no room
CutChoice choose_cuts(const std::vector<Cut>& candidates, const cv::Mat& structure, double least_area_px,
                      const SegmentationParams& params);

/// A cut as a wall: no 4-connected way leads across.
void draw_cut(const Cut& cut, cv::Mat& mask);

}  // namespace smokemap
