#include "simulation/plan_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr int kBigger = 2;
constexpr int kShift = 6;  ///< binary digits behind the point

}  // namespace

PlanCanvas::PlanCanvas(int width_px, int height_px)
    : width_(width_px),
      height_(height_px),
      big_(height_px * kBigger, width_px * kBigger, CV_8UC3, cv::Scalar::all(255)) {}

cv::Point PlanCanvas::fixed(const Point2& p_px) const {
  const auto digit = [](double v) {
    return static_cast<int>(std::lround(((v + 0.5) * kBigger - 0.5) * (1 << kShift)));
  };
  return {digit(p_px.x()), digit(p_px.y())};
}

void PlanCanvas::fill(const Polygon& ring, const cv::Scalar& bgr) {
  std::vector<std::vector<cv::Point>> points(1);
  for (const Point2& p : ring) points[0].push_back(fixed(p));
  cv::fillPoly(big_, points, bgr, cv::LINE_AA, kShift);
}

void PlanCanvas::box(const Point2& low, const Point2& high, const cv::Scalar& bgr) {
  fill({low, {high.x(), low.y()}, high, {low.x(), high.y()}}, bgr);
}

void PlanCanvas::disc(const Point2& center, double radius_px, const cv::Scalar& bgr) {
  const int radius = static_cast<int>(std::lround(radius_px * kBigger * (1 << kShift)));
  cv::circle(big_, fixed(center), radius, bgr, cv::FILLED, cv::LINE_AA, kShift);
}

void PlanCanvas::line(const Point2& from, const Point2& to, double width_px, const cv::Scalar& bgr) {
  const int width = std::max(1, static_cast<int>(std::lround(width_px * kBigger)));
  cv::line(big_, fixed(from), fixed(to), bgr, width, cv::LINE_AA, kShift);
}

void PlanCanvas::arc(const Point2& center, double radius_px, double from_rad, double to_rad, double width_px,
                     const cv::Scalar& bgr) {
  constexpr int kPieces = 24;
  const auto at = [&](int i) {
    const double angle = from_rad + (to_rad - from_rad) * i / kPieces;
    return Point2(center.x() + radius_px * std::cos(angle), center.y() - radius_px * std::sin(angle));
  };
  for (int i = 0; i < kPieces; ++i) line(at(i), at(i + 1), width_px, bgr);
}

void PlanCanvas::arrow(const Point2& from, const Point2& to, double width_px, const cv::Scalar& bgr) {
  const Point2 way = to - from;
  const double length = way.norm(), head = std::min(3.2 * width_px, 0.6 * length);
  if (length <= 0) return;
  const Point2 u = way / length, side(-u.y(), u.x()), neck = to - head * u;
  const double half = width_px / 2;
  fill({from - half * side, neck - half * side, neck - 0.6 * head * side, to, neck + 0.6 * head * side,
        neck + half * side, from + half * side},
       bgr);
}

void PlanCanvas::text(const std::string& words, const Point2& p, double height_px, const cv::Scalar& bgr, Anchor anchor,
                      bool bold) {
  const int face = bold ? cv::FONT_HERSHEY_DUPLEX : cv::FONT_HERSHEY_SIMPLEX;
  const int width = std::max(1, static_cast<int>(std::lround(height_px * kBigger * (bold ? 0.13 : 0.09))));
  const double scale = cv::getFontScaleFromHeight(face, static_cast<int>(std::lround(height_px * kBigger)), width);
  int below = 0;
  const cv::Size size = cv::getTextSize(words, face, scale, width, &below);
  cv::Point at(static_cast<int>(std::lround((p.x() + 0.5) * kBigger)),
               static_cast<int>(std::lround((p.y() + 0.5) * kBigger)));
  if (anchor == Anchor::kCenter) at.x -= size.width / 2;
  cv::putText(big_, words, at, face, scale, bgr, width, cv::LINE_AA);
}

cv::Mat PlanCanvas::picture() const {
  cv::Mat small;
  cv::resize(big_, small, {width_, height_}, 0, 0, cv::INTER_AREA);
  return small;
}

}  // namespace smokemap
