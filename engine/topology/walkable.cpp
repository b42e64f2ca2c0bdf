#include "topology/walkable.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "topology/thinning.hpp"

namespace smokemap {
namespace {

constexpr float kFlat = 0.7f;      ///< over two pixels, the clearance between opposite walls rises by less
constexpr float kNoise_px = 2.5f;  ///< what is narrower may be the roughness of a wall
constexpr int kClimb_px = 2;       ///< steps over the roughness of the distance image
constexpr double kRay_px = 1.5;    ///< single beams of a laser are at most two pixels wide, whatever is usual
constexpr double kSpeck_px = 4;    ///< and what they leave behind is no wider than this

/// Obstacles inside free space, seen with a rim of obstacle round the picture, which joins all that touch its edge.
struct Islands {
  cv::Mat labels;  ///< CV_32SC1 of the padded picture; 0 = free, 1 = the outside
  cv::Mat boxes;
  int count = 0;
};

Islands find_islands(const cv::Mat& free_space) {
  Islands islands;
  cv::Mat solid, centroids;
  cv::copyMakeBorder(free_space != 255, solid, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  islands.count = cv::connectedComponentsWithStats(solid, islands.labels, islands.boxes, centroids, 8, CV_32S);
  return islands;
}

/// Frees the islands for which `is_gone` is set.
cv::Mat without(const cv::Mat& free_space, const Islands& islands, const std::vector<unsigned char>& is_gone) {
  cv::Mat cleared = free_space == 255;
  for (int y = 0; y < cleared.rows; ++y)
    for (int x = 0; x < cleared.cols; ++x)
      if (is_gone[static_cast<size_t>(islands.labels.at<int>(y + 1, x + 1))]) cleared.at<unsigned char>(y, x) = 255;
  return cleared;
}

/// The clearance uphill from a place: that of the room or corridor it is in.
double clearance_round(const cv::Mat& clearance, cv::Point at) {
  while (true) {
    const cv::Rect near = cv::Rect(at.x - kClimb_px, at.y - kClimb_px, 2 * kClimb_px + 1, 2 * kClimb_px + 1) &
                          cv::Rect(0, 0, clearance.cols, clearance.rows);
    double most = 0;
    cv::Point there;
    cv::minMaxLoc(clearance(near), nullptr, &most, nullptr, &there);
    if (most <= static_cast<double>(clearance.at<float>(at))) return most;
    at = near.tl() + there;
  }
}

cv::Mat without_clutter(const cv::Mat& free_space, double clutter_ratio) {
  const Islands islands = find_islands(free_space);
  if (islands.count < 3 || clutter_ratio <= 0) return free_space == 255;
  std::vector<unsigned char> is_gone(static_cast<size_t>(islands.count), 1);
  is_gone[0] = is_gone[1] = 0;
  const cv::Mat emptied = free_clearance(without(free_space, islands, is_gone));
  for (int label = 2; label < islands.count; ++label) {
    const int* box = islands.boxes.ptr<int>(label);
    const cv::Point middle(box[cv::CC_STAT_LEFT] - 1 + box[cv::CC_STAT_WIDTH] / 2,
                           box[cv::CC_STAT_TOP] - 1 + box[cv::CC_STAT_HEIGHT] / 2);
    is_gone[static_cast<size_t>(label)] =
        std::max(box[cv::CC_STAT_WIDTH], box[cv::CC_STAT_HEIGHT]) < clutter_ratio * clearance_round(emptied, middle);
  }
  return without(free_space, islands, is_gone);
}

}  // namespace

double usual_clearance(const cv::Mat& clearance) {
  std::vector<float> ridge;
  for (int y = 1; y + 1 < clearance.rows; ++y)
    for (int x = 1; x + 1 < clearance.cols; ++x) {
      const float own = clearance.at<float>(y, x);
      if (own < kNoise_px) continue;
      const float gx = clearance.at<float>(y, x + 1) - clearance.at<float>(y, x - 1);
      const float gy = clearance.at<float>(y + 1, x) - clearance.at<float>(y - 1, x);
      if (std::hypot(gx, gy) < kFlat) ridge.push_back(own);
    }
  if (ridge.empty()) return 0;
  const auto quarter = ridge.begin() + static_cast<std::ptrdiff_t>(ridge.size() / 4);
  std::nth_element(ridge.begin(), quarter, ridge.end());
  return static_cast<double>(*quarter);
}

cv::Mat walkable_clearance(const cv::Mat& free_space, const VoronoiParams& params) {
  cv::Mat clearance = free_clearance(without_clutter(free_space, params.clutter_ratio));
  const double usual = usual_clearance(clearance);
  const double narrowest = std::max({params.min_clearance_px, std::min(params.narrow_ratio * usual, kRay_px), 1e-6});
  const double least = std::min(params.part_ratio * usual, kSpeck_px);
  cv::Mat parts;
  const int count = cv::connectedComponents(clearance >= narrowest, parts, 8, CV_32S);
  std::vector<float> widest(static_cast<size_t>(count), 0);
  for (int y = 0; y < parts.rows; ++y)
    for (int x = 0; x < parts.cols; ++x)
      if (const auto part = static_cast<size_t>(parts.at<int>(y, x)); part != 0)
        widest[part] = std::max(widest[part], clearance.at<float>(y, x));
  for (int y = 0; y < parts.rows; ++y)
    for (int x = 0; x < parts.cols; ++x)
      if (static_cast<double>(widest[static_cast<size_t>(parts.at<int>(y, x))]) < least || parts.at<int>(y, x) == 0)
        clearance.at<float>(y, x) = 0;
  return clearance;
}

}  // namespace smokemap
