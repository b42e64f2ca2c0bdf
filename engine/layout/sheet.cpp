#include "layout/sheet.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace smokemap {
namespace {

double turn_at(const Point2& a, const Point2& b, const Point2& c) {
  const Point2 u = b - a, v = c - b;
  return u.x() * v.y() - u.y() * v.x();
}

}  // namespace

Result<RectifiedSheet> rectify_sheet(const cv::Mat& bgr, const SheetCorners& corners_px, double max_megapixels) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (!corners_px[i].allFinite() || corners_px[i].cwiseAbs().maxCoeff() > 1e6)
      return fail(Errc::kInvalidArgument, "a sheet corner is not a number");
    if (turn_at(corners_px[i], corners_px[(i + 1) % 4], corners_px[(i + 2) % 4]) <= 1)
      return fail(Errc::kInvalidArgument,
                  "the sheet corners must make a convex quadrilateral, clockwise from its top left");
  }
  const auto side = [&](std::size_t a, std::size_t b) { return (corners_px[a] - corners_px[b]).norm(); };
  double width = 0.5 * (side(0, 1) + side(3, 2)), height = 0.5 * (side(0, 3) + side(1, 2));
  if (width < 16 || height < 16) return fail(Errc::kInvalidArgument, "the sheet is smaller than 16 px");
  const double ratio = std::max(width, height) / std::min(width, height), a_series = std::sqrt(2.0);
  if (std::abs(ratio / a_series - 1) < 0.10) (width > height ? width : height) = a_series * std::min(width, height);
  const double shrink = std::min(1.0, std::sqrt(max_megapixels * 1e6 / (width * height)));
  const auto columns = static_cast<float>(std::lround(width * shrink)),
             rows = static_cast<float>(std::lround(height * shrink));
  std::array<cv::Point2f, 4> from;
  for (std::size_t i = 0; i < 4; ++i)
    from[i] = {static_cast<float>(corners_px[i].x()), static_cast<float>(corners_px[i].y())};
  const std::array<cv::Point2f, 4> to{cv::Point2f(0, 0), cv::Point2f(columns - 1, 0),
                                      cv::Point2f(columns - 1, rows - 1), cv::Point2f(0, rows - 1)};
  const cv::Mat H = cv::getPerspectiveTransform(from.data(), to.data());
  RectifiedSheet sheet;
  cv::warpPerspective(bgr, sheet.bgr, H, cv::Size(static_cast<int>(columns), static_cast<int>(rows)), cv::INTER_LINEAR,
                      cv::BORDER_CONSTANT, cv::Scalar(255, 255, 255));
  for (int i = 0; i < 9; ++i) sheet.homography.H_layout_photo[static_cast<std::size_t>(i)] = H.at<double>(i / 3, i % 3);
  return sheet;
}

}  // namespace smokemap
