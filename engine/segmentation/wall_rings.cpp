#include "segmentation/wall_rings.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace smokemap {
namespace {

constexpr double kLeastTurn_rad = 0.35;  ///< a wall that turns less is straight or bent, not cornered

/// Turn of the boundary at `at`, positive where the wall points into free space. Rings are traced with free space on
/// one and the same side.
double turn_at(const cv::Point& before, const cv::Point& at, const cv::Point& after) {
  const cv::Point in = at - before, out = after - at;
  return std::atan2(static_cast<double>(in.cross(out)), static_cast<double>(in.dot(out)));
}

}  // namespace

double WallRing::way_px(double along_a, double along_b) const {
  const double way = std::abs(along_a - along_b);
  return std::min(way, length_px - way);
}

std::vector<WallRing> trace_wall_rings(const cv::Mat& structure, double tolerance_px) {
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(structure, contours, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  std::vector<WallRing> rings;
  for (const std::vector<cv::Point>& contour : contours) {
    std::vector<cv::Point> polygon;
    cv::approxPolyDP(contour, polygon, tolerance_px, true);
    const size_t count = polygon.size();
    if (count < 2) continue;
    WallRing ring;
    for (size_t i = 0; i < count; ++i) {
      const cv::Point& before = polygon[(i + count - 1) % count];
      const cv::Point& after = polygon[(i + 1) % count];
      const double turn = turn_at(before, polygon[i], after);
      ring.corners.push_back({polygon[i], ring.length_px, turn > kLeastTurn_rad});
      ring.length_px += cv::norm(after - polygon[i]);
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

}  // namespace smokemap
