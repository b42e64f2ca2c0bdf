#include "segmentation/outline.hpp"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/expect.hpp"

namespace smokemap {
namespace {

cv::Mat background(const Segmentation& segmentation, const cv::Mat& picture) {
  cv::Mat base(segmentation.labels.size(), CV_8UC3, cv::Scalar(58, 52, 48));
  if (picture.empty()) return base;
  ENGINE_EXPECT(picture.size() == segmentation.labels.size());
  ENGINE_EXPECT(picture.type() == CV_8UC1 || picture.type() == CV_8UC3);
  if (picture.channels() == 1)
    cv::cvtColor(picture, base, cv::COLOR_GRAY2BGR);
  else
    base = picture.clone();
  return base;
}

void write_number(cv::Mat& canvas, const Region& region) {
  const std::string text = std::to_string(region.label);
  const double scale = std::clamp(region.clearance_px / 28.0, 0.3, 1.2);
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &baseline);
  const cv::Point at(static_cast<int>(region.anchor_px.x()) - size.width / 2,
                     static_cast<int>(region.anchor_px.y()) + size.height / 2);
  cv::putText(canvas, text, at, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar(40, 32, 28), 1, cv::LINE_AA);
}

}  // namespace

Polygon region_outline(const Segmentation& segmentation, int label, double tolerance_px) {
  std::vector<std::vector<cv::Point>> rings;
  cv::findContours(segmentation.labels == label, rings, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  if (label <= 0 || rings.empty()) return {};
  const auto longest = std::max_element(rings.begin(), rings.end(),
                                        [](const auto& one, const auto& two) { return one.size() < two.size(); });
  std::vector<cv::Point> simple;
  cv::approxPolyDP(*longest, simple, tolerance_px, true);
  Polygon outline;
  for (const cv::Point& p : simple) outline.emplace_back(p.x, p.y);
  return outline;
}

cv::Vec3b region_colour(int label) {
  // Hues a golden angle apart never come close for neighbouring numbers; two rings of lightness tell the rest apart.
  const int hue = static_cast<int>(label * 68.754) % 180;
  const int value = label % 2 == 0 ? 235 : 205;
  const cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar(hue, 105, value));
  cv::Mat bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  return bgr.at<cv::Vec3b>(0, 0);
}

cv::Mat draw_segmentation(const Segmentation& segmentation, const cv::Mat& picture) {
  cv::Mat canvas = background(segmentation, picture);
  std::vector<cv::Vec3b> colours(segmentation.regions.size() + 1);
  for (size_t label = 1; label < colours.size(); ++label) colours[label] = region_colour(static_cast<int>(label));
  for (int y = 0; y < canvas.rows; ++y)
    for (int x = 0; x < canvas.cols; ++x)
      if (const auto label = segmentation.labels.at<unsigned short>(y, x); label != 0)
        canvas.at<cv::Vec3b>(y, x) = colours[label];
  for (const RegionBorder& border : segmentation.borders)
    cv::line(canvas, cv::Point2d(border.line_px.a.x(), border.line_px.a.y()),
             cv::Point2d(border.line_px.b.x(), border.line_px.b.y()), cv::Scalar(40, 32, 28), 1, cv::LINE_AA);
  for (const Region& region : segmentation.regions) write_number(canvas, region);
  return canvas;
}

}  // namespace smokemap
