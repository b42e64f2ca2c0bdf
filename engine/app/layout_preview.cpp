#include "app/layout_preview.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace smokemap::app {
namespace {

cv::Point pixel(const Point2& p) {
  return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}

cv::Scalar opening_colour(OpeningKind kind) {
  switch (kind) {
    case OpeningKind::kDoor:
      return {255, 80, 0};
    case OpeningKind::kWindow:
      return {255, 200, 80};
    case OpeningKind::kPassage:
      return {60, 180, 0};
  }
  return {};
}

}  // namespace

cv::Mat draw_layout(const cv::Mat& rectified_bgr, const LayoutMap& layout) {
  cv::Mat faint, tint = rectified_bgr.clone();
  int hue = 0;
  for (const auto& room : layout.rooms_px) {
    std::vector<cv::Point> outline;
    for (const auto& p : room) outline.push_back(pixel(p));
    hue = (hue + 47) % 180;
    cv::Mat colour(1, 1, CV_8UC3, cv::Scalar(hue, 70, 255));
    cv::cvtColor(colour, colour, cv::COLOR_HSV2BGR);
    cv::fillPoly(tint, std::vector<std::vector<cv::Point>>{outline}, cv::Scalar(colour.at<cv::Vec3b>(0, 0)),
                 cv::LINE_AA);
  }
  cv::addWeighted(rectified_bgr, 0.5, tint, 0.5, 0, faint);
  const int pen = std::max(1, static_cast<int>(std::lround(std::max(faint.rows, faint.cols) / 900.0)));
  for (std::size_t w = 0; w < layout.walls.size(); ++w) {
    const Segment2 s = layout.wall_px(static_cast<int>(w));
    const bool sure = layout.walls[w].confidence >= 0.6;
    cv::line(faint, pixel(s.a), pixel(s.b), sure ? cv::Scalar(0, 0, 230) : cv::Scalar(0, 140, 255), 2 * pen,
             cv::LINE_AA);
  }
  for (const auto& o : layout.openings)
    cv::line(faint, pixel(o.gap_px.a), pixel(o.gap_px.b), opening_colour(o.kind), 2 * pen, cv::LINE_AA);
  for (const auto& s : layout.signs)
    cv::circle(faint, pixel(s.p_px), static_cast<int>(s.radius_px * 1.2), cv::Scalar(200, 0, 200), pen, cv::LINE_AA);
  if (layout.you_are_here_px)
    cv::circle(faint, pixel(*layout.you_are_here_px), 12 * pen, cv::Scalar(255, 0, 0), 2 * pen, cv::LINE_AA);
  for (const auto& c : layout.corners)
    cv::circle(faint, pixel(c.p_px), 2 * pen, cv::Scalar(0, 0, 0), cv::FILLED, cv::LINE_AA);
  return faint;
}

}  // namespace smokemap::app
