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

/// Clockwise as seen on the screen (y down), starting at the corner nearest the picture's top left.
SheetCorners in_order(const std::vector<cv::Point2f>& quad) {
  SheetCorners corners;
  Point2 middle = Point2::Zero();
  for (std::size_t i = 0; i < 4; ++i) corners[i] = {quad[i].x, quad[i].y}, middle += corners[i] / 4;
  std::sort(corners.begin(), corners.end(), [&](const Point2& a, const Point2& b) {
    return std::atan2(a.y() - middle.y(), a.x() - middle.x()) < std::atan2(b.y() - middle.y(), b.x() - middle.x());
  });
  const auto first = std::min_element(corners.begin(), corners.end(),
                                      [](const Point2& a, const Point2& b) { return a.sum() < b.sum(); });
  std::rotate(corners.begin(), first, corners.end());
  return corners;
}

SheetCorners whole_picture(cv::Size size) {
  const double w = size.width - 1, h = size.height - 1;
  return {Point2(0, 0), Point2(w, 0), Point2(w, h), Point2(0, h)};
}

/// The quadrilateral that hugs a hull: corners are dropped where that adds least, until four are left.
std::vector<cv::Point2f> hugging_quad(const std::vector<cv::Point>& hull) {
  std::vector<cv::Point2f> corners(hull.begin(), hull.end());
  for (double epsilon = 1; corners.size() > 4 && epsilon < 200; epsilon *= 1.3)
    cv::approxPolyDP(corners, corners, epsilon, true);
  return corners;
}

}  // namespace

SheetProposal propose_sheet(const cv::Mat& bgr) {
  SheetProposal proposal{whole_picture(bgr.size()), 0};
  const double shrink = std::max(1.0, std::max(bgr.rows, bgr.cols) / 400.0);
  if (std::min(bgr.rows, bgr.cols) / shrink < 16) return proposal;
  cv::Mat small, gray, bright;
  cv::resize(bgr, small, {}, 1 / shrink, 1 / shrink, cv::INTER_AREA);
  cv::extractChannel(small, gray, 1);
  cv::dilate(gray, gray, cv::Mat(), {-1, -1}, 2);  // drawings on the sheet are paper too
  cv::threshold(gray, bright, 0, 255, cv::THRESH_BINARY | cv::THRESH_OTSU);
  cv::erode(bright, bright, cv::Mat(), {-1, -1}, 2);
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(bright, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  if (outlines.empty()) return proposal;
  const auto& outline = *std::max_element(outlines.begin(), outlines.end(), [](const auto& a, const auto& b) {
    return cv::contourArea(a) < cv::contourArea(b);
  });
  std::vector<cv::Point> hull;
  cv::convexHull(outline, hull);
  const auto quad = hugging_quad(hull);
  if (quad.size() != 4 || !cv::isContourConvex(quad)) return proposal;
  const double area = cv::contourArea(quad), share = area / static_cast<double>(small.total());
  const double fit = std::min(cv::contourArea(hull), area) / std::max(cv::contourArea(hull), area);
  if (share < 0.2 || fit < 0.9) return proposal;
  std::vector<cv::Point2f> full;
  for (const auto& p : quad)
    full.emplace_back(static_cast<float>((p.x + 0.5) * shrink - 0.5), static_cast<float>((p.y + 0.5) * shrink - 0.5));
  proposal.corners_px = in_order(full);
  proposal.confidence = share > 0.97 ? 0 : std::clamp((fit - 0.9) * 10, 0.0, 1.0);
  if (proposal.confidence == 0) proposal.corners_px = whole_picture(bgr.size());
  return proposal;
}

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
