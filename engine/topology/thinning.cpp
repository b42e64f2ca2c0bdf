#include "topology/thinning.hpp"

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <queue>
#include <tuple>
#include <vector>

namespace smokemap {
namespace {

/// Around a pixel, counter-clockwise on the screen from the right.
constexpr std::array<std::array<int, 2>, 8> kAround = {
    {{1, 0}, {1, -1}, {0, -1}, {-1, -1}, {-1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
constexpr float kRidgeSlope = 0.9f;  ///< a clearance that rises slower than this marks the middle between walls

struct Ring {
  std::array<bool, 8> set{};
  int count = 0;
};

Ring ring_around(const cv::Mat& image, int x, int y) {
  Ring ring;
  for (size_t k = 0; k < kAround.size(); ++k) {
    const int nx = x + kAround[k][0], ny = y + kAround[k][1];
    const bool inside = nx >= 0 && ny >= 0 && nx < image.cols && ny < image.rows;
    ring.set[k] = inside && image.at<unsigned char>(ny, nx) != 0;
    ring.count += ring.set[k];
  }
  return ring;
}

/// True if taking the middle away neither parts the line (8 neighbours) nor joins or opens a hole (4 neighbours): the
/// number of 4-connected background parts of the ring that touch the middle by a side is one (Yokoi's number).
bool is_simple(const Ring& ring) {
  int crossings = 0;
  for (size_t k = 0; k < 8; k += 2) crossings += !ring.set[k] && (ring.set[(k + 1) % 8] || ring.set[(k + 2) % 8]);
  return crossings == 1;
}

bool on_ridge(const cv::Mat& clearance, int x, int y) {
  const auto at = [&](int px, int py) {
    const bool inside = px >= 0 && py >= 0 && px < clearance.cols && py < clearance.rows;
    return inside ? clearance.at<float>(py, px) : 0.0f;
  };
  const float gx = 0.5f * (at(x + 1, y) - at(x - 1, y)), gy = 0.5f * (at(x, y + 1) - at(x, y - 1));
  return std::hypot(gx, gy) < kRidgeSlope;
}

/// Takes simple pixels away by rising clearance; ridge pixels with at most `end_neighbours` neighbours are ends and
/// stay.
void thin(const cv::Mat& clearance, int end_neighbours, cv::Mat& line) {
  using Entry = std::tuple<float, int, int>;  // clearance, row, column: smallest first
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto consider = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= line.cols || y >= line.rows || line.at<unsigned char>(y, x) == 0) return;
    const Ring ring = ring_around(line, x, y);
    if (ring.count < 8 && is_simple(ring)) queue.emplace(clearance.at<float>(y, x), y, x);
  };
  for (int y = 0; y < line.rows; ++y)
    for (int x = 0; x < line.cols; ++x) consider(x, y);
  while (!queue.empty()) {
    const auto [value, y, x] = queue.top();
    queue.pop();
    if (line.at<unsigned char>(y, x) == 0) continue;
    const Ring ring = ring_around(line, x, y);
    if (!is_simple(ring) || (ring.count <= end_neighbours && on_ridge(clearance, x, y))) continue;
    line.at<unsigned char>(y, x) = 0;
    for (const auto& step : kAround) consider(x + step[0], y + step[1]);
  }
}

}  // namespace

cv::Mat free_clearance(const cv::Mat& free_space) {
  cv::Mat padded, distance;
  cv::copyMakeBorder(free_space == 255, padded, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::distanceTransform(padded, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE, CV_32F);
  return distance(cv::Rect(1, 1, free_space.cols, free_space.rows)).clone();
}

cv::Mat thin_by_clearance(const cv::Mat& clearance) {
  cv::Mat line = clearance > 0;
  // The end of a line two pixels wide, as in an even corridor, has two neighbours once its twin is gone: such ends stay
  // until all lines are one pixel wide.
  thin(clearance, 2, line);
  thin(clearance, 1, line);
  return line;
}

}  // namespace smokemap
