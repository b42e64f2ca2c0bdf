#include "matching/raster.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace smokemap {
namespace {

constexpr int kMargin_cells = 3;
constexpr int kSmoothing_cells = 3;  ///< aperture in which the direction of walls is measured

/// Mean direction of brightness edges with period 90 degrees.
double wall_direction(const cv::Mat& free_cells) {
  cv::Mat smooth, gx, gy;
  free_cells.convertTo(smooth, CV_32F, 1.0 / 255);
  cv::GaussianBlur(smooth, smooth, cv::Size(kSmoothing_cells, kSmoothing_cells), 0);
  cv::Scharr(smooth, gx, CV_32F, 1, 0);
  cv::Scharr(smooth, gy, CV_32F, 0, 1);
  double sum_cos = 0, sum_sin = 0;
  for (int y = 0; y < smooth.rows; ++y)
    for (int x = 0; x < smooth.cols; ++x) {
      const double dx = gx.at<float>(y, x), dy = gy.at<float>(y, x);
      const double strength = dx * dx + dy * dy;
      if (strength < 1e-9) continue;
      const double angle = 4 * std::atan2(dy, dx);
      sum_cos += strength * std::cos(angle);
      sum_sin += strength * std::sin(angle);
    }
  const double direction = std::atan2(sum_sin, sum_cos) / 4;
  return direction < 0 ? direction + std::numbers::pi / 2 : direction;
}

cv::Mat depth_image(const cv::Mat& free_cells, double slope_cells) {
  cv::Mat inside, outside;
  cv::distanceTransform(free_cells, inside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(255 - free_cells, outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const cv::Mat depth = 1.0 + (inside - outside) / slope_cells;
  return cv::max(0.0, cv::min(2.0, depth));
}

}  // namespace

Eigen::Affine2d pixels_of_cells(const MapRaster& raster) {
  Eigen::Affine2d result = Eigen::Affine2d::Identity();
  result.linear() *= raster.px_per_cell;
  result.translation() = raster.origin_px;
  return result;
}

MapRaster make_raster(const Segmentation& map, int side_cells, double slope_cells) {
  const cv::Rect box = cv::boundingRect(map.labels != 0);
  MapRaster raster;
  raster.px_per_cell = std::max(box.width, box.height) / static_cast<double>(side_cells);
  const int cols = static_cast<int>(std::ceil(box.width / raster.px_per_cell)) + 2 * kMargin_cells;
  const int rows = static_cast<int>(std::ceil(box.height / raster.px_per_cell)) + 2 * kMargin_cells;
  raster.origin_px = Point2(box.x, box.y) + Point2::Constant((0.5 - kMargin_cells) * raster.px_per_cell);
  raster.labels = cv::Mat(rows, cols, CV_16UC1, cv::Scalar(0));
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < cols; ++x) {
      const Point2 p = raster.to_px(Point2(x, y));
      const int px = static_cast<int>(std::lround(p.x())), py = static_cast<int>(std::lround(p.y()));
      if (px >= 0 && py >= 0 && px < map.labels.cols && py < map.labels.rows)
        raster.labels.at<unsigned short>(y, x) = map.labels.at<unsigned short>(py, px);
    }
  const cv::Mat free_cells = raster.labels != 0;
  raster.free_cells = cv::countNonZero(free_cells);
  raster.depth = depth_image(free_cells, slope_cells);
  raster.wall_direction_rad = wall_direction(free_cells);
  return raster;
}

MapRaster halved(const MapRaster& raster) {
  const int cols = raster.depth.cols + raster.depth.cols % 2, rows = raster.depth.rows + raster.depth.rows % 2;
  cv::Mat even(rows, cols, CV_32FC1, cv::Scalar(0));  // what is added lies outside, where depth is nought
  raster.depth.copyTo(even(cv::Rect(0, 0, raster.depth.cols, raster.depth.rows)));
  MapRaster half = raster;
  cv::resize(even, half.depth, cv::Size(cols / 2, rows / 2), 0, 0, cv::INTER_AREA);
  half.labels = cv::Mat(half.depth.size(), CV_16UC1, cv::Scalar(0));
  for (int y = 0; y < half.labels.rows; ++y)
    for (int x = 0; x < half.labels.cols; ++x)
      half.labels.at<unsigned short>(y, x) = raster.labels.at<unsigned short>(std::min(2 * y, raster.labels.rows - 1),
                                                                              std::min(2 * x, raster.labels.cols - 1));
  half.px_per_cell = 2 * raster.px_per_cell;
  half.origin_px = raster.to_px(Point2(0.5, 0.5));
  half.free_cells = cv::countNonZero(half.labels);
  return half;
}

}  // namespace smokemap
