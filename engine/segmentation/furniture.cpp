#include "segmentation/furniture.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "segmentation/thickness.hpp"

namespace smokemap {
namespace {

constexpr double kScalePixels = 2.5e5;  ///< the usual thickness is measured on a picture no larger than this
constexpr int kMostRounds = 3;

double usual_thickness(const cv::Mat& structure) {
  const double scale = std::min(1.0, std::sqrt(kScalePixels / static_cast<double>(structure.total())));
  if (scale == 1) return typical_thickness(local_thickness(clearance_image(structure)));
  cv::Mat small;
  cv::resize(structure, small, {}, scale, scale, cv::INTER_NEAREST);
  return typical_thickness(local_thickness(clearance_image(small))) / scale;
}

}  // namespace

Structure structure_of(const cv::Mat& free_space, double clutter_ratio) {
  Structure structure{without_islands(free_space, 0), 0};
  structure.thickness_px = usual_thickness(structure.free_space);
  for (int round = 0; round < kMostRounds; ++round) {
    cv::Mat cleared = without_islands(free_space, clutter_ratio * structure.thickness_px);
    const bool is_stable = cv::countNonZero(cleared != structure.free_space) == 0;
    structure.free_space = cleared;
    if (is_stable) break;
    structure.thickness_px = usual_thickness(cleared);
  }
  return structure;
}

}  // namespace smokemap
