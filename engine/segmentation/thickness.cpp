#include "segmentation/thickness.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace smokemap {

cv::Mat clearance_image(const cv::Mat& free_space) {
  cv::Mat padded, distance;
  cv::copyMakeBorder(free_space == 255, padded, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::distanceTransform(padded, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE, CV_32F);
  return distance(cv::Rect(1, 1, free_space.cols, free_space.rows)).clone();
}

namespace {

struct RidgePixel {
  float clearance;
  int x, y;
};

constexpr float kCoverTolerance_px = 0.15f;  ///< a disc may be lost if another one covers all but this much of it

float value_or_zero(const cv::Mat& image, int x, int y) {
  const bool inside = x >= 0 && y >= 0 && x < image.cols && y < image.rows;
  return inside ? image.at<float>(y, x) : 0.0f;
}

float length_of(float x, float y) {
  return static_cast<float>(std::sqrt(static_cast<double>(x) * x + static_cast<double>(y) * y));
}

/// A disc that lies inside that of a pixel farther up the slope of the clearance paints nothing new.
bool covered_from_uphill(const cv::Mat& clearance, int x, int y) {
  const float own = clearance.at<float>(y, x);
  const float gx = value_or_zero(clearance, x + 1, y) - value_or_zero(clearance, x - 1, y);
  const float gy = value_or_zero(clearance, x, y + 1) - value_or_zero(clearance, x, y - 1);
  const float slope = length_of(gx, gy);
  if (slope < 1e-3f) return false;
  for (int reach = 1; reach <= 4; ++reach) {
    const int dx = static_cast<int>(std::lround(static_cast<float>(reach) * gx / slope));
    const int dy = static_cast<int>(std::lround(static_cast<float>(reach) * gy / slope));
    const float step = length_of(static_cast<float>(dx), static_cast<float>(dy));
    if (value_or_zero(clearance, x + dx, y + dy) >= own + step - kCoverTolerance_px) return true;
  }
  return false;
}

std::vector<RidgePixel> ridge_by_falling_clearance(const cv::Mat& clearance) {
  std::vector<RidgePixel> ridge;
  for (int y = 0; y < clearance.rows; ++y)
    for (int x = 0; x < clearance.cols; ++x) {
      const float own = clearance.at<float>(y, x);
      if (own > 0 && !covered_from_uphill(clearance, x, y)) ridge.push_back({own, x, y});
    }
  std::stable_sort(ridge.begin(), ridge.end(),
                   [](const RidgePixel& one, const RidgePixel& two) { return one.clearance > two.clearance; });
  return ridge;
}

/// Paints discs under those that were painted before, touching every pixel but once: each knows where in its row the
/// next bare one is. What is not free stays as it is.
class UnderPainter {
 public:
  /// @param clearance  CV_32FC1; free is what is above zero
  explicit UnderPainter(const cv::Mat& clearance) : next_(clearance.rows, clearance.cols + 1, CV_32SC1) {
    for (int y = 0; y < next_.rows; ++y) {
      int* next = next_.ptr<int>(y);
      const auto* is_free = clearance.ptr<float>(y);
      for (int x = 0; x < clearance.cols; ++x) next[x] = is_free[x] > 0 ? x : x + 1;
      next[clearance.cols] = clearance.cols;
    }
  }

  void paint(cv::Mat& image, const cv::Point& centre, double radius, float value) {
    const int reach = static_cast<int>(radius);
    for (int y = std::max(0, centre.y - reach); y <= std::min(image.rows - 1, centre.y + reach); ++y) {
      const int dy = y - centre.y;
      const int half = static_cast<int>(std::sqrt(std::max(0.0, radius * radius - dy * dy)));
      const int to = std::min(image.cols - 1, centre.x + half);
      int* next = next_.ptr<int>(y);
      float* row = image.ptr<float>(y);
      for (int x = bare_from(next, std::max(0, centre.x - half)); x <= to; x = bare_from(next, x + 1))
        row[x] = value, next[x] = x + 1;
    }
  }

 private:
  static int bare_from(int* next, int x) {
    while (next[x] != x) {
      next[x] = next[next[x]];
      x = next[x];
    }
    return x;
  }

  cv::Mat next_;  ///< CV_32SC1: the pixel itself where bare; one column more than the image
};

}  // namespace

cv::Mat local_thickness(const cv::Mat& clearance) {
  cv::Mat thickness = clearance.clone();
  // The largest disc first. Half a pixel more makes up for the covered discs that were left out and cannot reach beyond
  // a wall.
  UnderPainter painter(clearance);
  for (const RidgePixel& pixel : ridge_by_falling_clearance(clearance))
    painter.paint(thickness, {pixel.x, pixel.y}, pixel.clearance + 0.5, pixel.clearance);
  return thickness;
}

cv::Mat fuzzy_opening(const cv::Mat& clearance) {
  const auto whole = [&](int x, int y) { return std::floor(value_or_zero(clearance, x, y)); };
  std::vector<std::vector<cv::Point>> centres;  // by clearance
  for (int y = 0; y < clearance.rows; ++y)
    for (int x = 0; x < clearance.cols; ++x) {
      const float own = whole(x, y);
      const bool is_covered =
          whole(x - 1, y) > own || whole(x + 1, y) > own || whole(x, y - 1) > own || whole(x, y + 1) > own;
      if (own < 1 || is_covered) continue;
      centres.resize(std::max(centres.size(), static_cast<size_t>(own) + 1));
      centres[static_cast<size_t>(own)].emplace_back(x, y);
    }
  cv::Mat opening(clearance.size(), CV_32FC1, cv::Scalar(0));
  UnderPainter painter(clearance);
  for (size_t radius = centres.size(); radius-- > 1;)
    for (const cv::Point& centre : centres[radius])
      painter.paint(opening, centre, static_cast<double>(radius) - 1, static_cast<float>(radius));
  return opening;
}

cv::Mat without_islands(const cv::Mat& free_space, double max_side_px) {
  cv::Mat result = free_space == 255;
  if (max_side_px < 1) return result;
  cv::Mat solid, labels, stats, centroids;
  cv::copyMakeBorder(free_space != 255, solid, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  const int count = cv::connectedComponentsWithStats(solid, labels, stats, centroids, 8, CV_32S);
  std::vector<unsigned char> is_island(static_cast<size_t>(count), 0);
  for (int label = 1; label < count; ++label) {
    const int side = std::max(stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT));
    is_island[static_cast<size_t>(label)] = side < max_side_px;
  }
  for (int y = 0; y < result.rows; ++y)
    for (int x = 0; x < result.cols; ++x)
      if (is_island[static_cast<size_t>(labels.at<int>(y + 1, x + 1))]) result.at<unsigned char>(y, x) = 255;
  return result;
}

double typical_thickness(const cv::Mat& thickness) {
  std::vector<float> values;
  values.reserve(thickness.total());
  for (int y = 0; y < thickness.rows; ++y)
    for (int x = 0; x < thickness.cols; ++x)
      if (thickness.at<float>(y, x) > 0) values.push_back(thickness.at<float>(y, x));
  if (values.empty()) return 0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 5);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace smokemap
