// Ink: closing the picture by half the distance of hatching lines fills hatched areas and joins nothing else that is as
// wide. What direction the ink inside runs tells hatching from stairs and from writing.
// Strokes: lines that run alike, lie near and overlap form a family; four of them hatch the hull of their ends.
#include "sketch/hatching.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kInkReach = 0.018;       ///< of the picture's side: half the widest distance between lines of ink
constexpr double kLeastWidth = 0.045;     ///< narrower areas are double lines
constexpr double kLargestArea = 0.15;     ///< of the picture
constexpr double kLeastCoherence = 0.35;  ///< of the directions of ink inside: 1 = all one way
constexpr double kRectangular = 0.8;      ///< share of its box from which an area is that box
constexpr double kLeastSlant_rad = 0.3;   ///< against the walls
constexpr double kStrokeSpacing = 0.05;   ///< of the extent
constexpr double kAlike_rad = 0.2;
constexpr std::size_t kFamily = 4;
constexpr int kLines = 8;

/// Mean of directions that repeat after pi / `fold`, weighted by length; 0 coherence if they are all kinds.
struct Directions {
  std::complex<double> sum = 0;
  double weight = 0;
  double fold = 1;

  void add(double heading_rad, double length) {
    sum += length * std::polar(1.0, 2 * fold * heading_rad);
    weight += length;
  }
  double mean_rad() const { return std::arg(sum) / (2 * fold); }
  double coherence() const { return weight > 0 ? std::abs(sum) / weight : 0; }
};

bool is_slanting(double heading_rad, double wall_rad) {
  const double off = line_angle_between(heading_rad, wall_rad);
  return std::min(off, kPi / 2 - off) > kLeastSlant_rad;
}

/// Directions of the edges of ink under `where`, along the line.
Directions ink_directions(const cv::Mat& dx, const cv::Mat& dy, const cv::Mat& where, const cv::Rect& box,
                          double fold) {
  Directions found;
  found.fold = fold;
  for (int y = box.y; y < box.y + box.height; ++y)
    for (int x = box.x; x < box.x + box.width; ++x) {
      const double gx = dx.at<float>(y, x), gy = dy.at<float>(y, x);
      if (where.at<uchar>(y, x) && (gx != 0 || gy != 0)) found.add(std::atan2(gy, gx) + kPi / 2, std::hypot(gx, gy));
    }
  return found;
}

cv::Mat disc(double radius) {
  const int side = 2 * std::max(1, static_cast<int>(std::lround(radius))) + 1;
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side});
}

Polygon outline_of(const std::vector<cv::Point>& contour) {
  Polygon outline;
  const cv::RotatedRect box = cv::minAreaRect(contour);
  if (cv::contourArea(contour) >= kRectangular * box.size.area()) {
    cv::Point2f corners[4];
    box.points(corners);
    for (const cv::Point2f& p : corners) outline.emplace_back(p.x, p.y);
    return outline;
  }
  std::vector<cv::Point> hull;
  cv::convexHull(contour, hull);
  for (const cv::Point& p : hull) outline.emplace_back(p.x, p.y);
  return outline;
}

std::vector<cv::Point> pixels(const Polygon& polygon) {
  std::vector<cv::Point> points;
  for (const Point2& p : polygon)
    points.emplace_back(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  return points;
}

Segment2 chord(const Stroke& stroke) { return {stroke.points_px.front(), stroke.points_px.back()}; }

bool is_straight(const Stroke& stroke) {
  if (stroke.kind == StrokeKind::kDoor || stroke.points_px.size() < 2) return false;
  double length = 0;
  for (std::size_t i = 0; i + 1 < stroke.points_px.size(); ++i)
    length += (stroke.points_px[i + 1] - stroke.points_px[i]).norm();
  return chord(stroke).length() > 0.93 * length && length > 0;
}

bool lie_side_by_side(const Segment2& one, const Segment2& two, double spacing) {
  if (line_angle_between(one.heading(), two.heading()) > kAlike_rad) return false;
  const double apart = std::abs(signed_line_distance(one, two.midpoint()));
  const double shift = std::abs(along(one, two.midpoint()) - 0.5) * one.length();
  return apart > 1 && apart < spacing && shift < 0.6 * (one.length() + two.length());
}

}  // namespace

std::vector<Hatching> find_hatched_ink(const cv::Mat& mask) {
  const double side = std::max(mask.rows, mask.cols);
  const int margin = static_cast<int>(0.05 * side);  // else closing runs into the picture's edge
  cv::Mat ink, filled, smooth, dx, dy;
  cv::copyMakeBorder(mask, ink, margin, margin, margin, margin, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::morphologyEx(ink, filled, cv::MORPH_CLOSE, disc(kInkReach * side));
  cv::morphologyEx(filled, filled, cv::MORPH_OPEN, disc(0.5 * kLeastWidth * side));
  cv::GaussianBlur(ink, smooth, {0, 0}, 2);
  cv::Sobel(smooth, dx, CV_32F, 1, 0);
  cv::Sobel(smooth, dy, CV_32F, 0, 1);
  const double wall_rad = ink_directions(dx, dy, filled == 0, {{}, ink.size()}, 2).mean_rad();
  cv::Mat inner;
  cv::erode(filled, inner, disc(0.3 * kInkReach * side));
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(filled, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  std::vector<Hatching> found;
  for (const std::vector<cv::Point>& contour : contours) {
    if (cv::contourArea(contour) > kLargestArea * static_cast<double>(mask.total())) continue;
    const Directions inside = ink_directions(dx, dy, inner, cv::boundingRect(contour), 1);
    if (inside.coherence() < kLeastCoherence || !is_slanting(inside.mean_rad(), wall_rad)) continue;
    Hatching area{outline_of(contour), inside.mean_rad()};
    for (Point2& p : area.outline_px) p -= Point2(margin, margin);
    found.push_back(std::move(area));
  }
  return found;
}

void outline_hatched_ink(const std::vector<Hatching>& areas, int pen_px, cv::Mat& mask) {
  for (const Hatching& area : areas) {
    const std::vector<std::vector<cv::Point>> outline = {pixels(area.outline_px)};
    cv::fillPoly(mask, outline, cv::Scalar(0));
    cv::polylines(mask, outline, true, cv::Scalar(0), 2 * pen_px + 1);  // ends of lines that stick out
    cv::polylines(mask, outline, true, cv::Scalar(255), pen_px);
  }
}

std::vector<Segment2> hatching_lines(const Hatching& area) {
  const Point2 along_lines(std::cos(area.heading_rad), std::sin(area.heading_rad));
  const Point2 across(-along_lines.y(), along_lines.x());
  double low = 1e18, high = -1e18;
  for (const Point2& p : area.outline_px) low = std::min(low, across.dot(p)), high = std::max(high, across.dot(p));
  std::vector<Segment2> lines;
  for (int i = 0; i < kLines; ++i) {
    const double level = low + (high - low) * (i + 0.5) / kLines;
    std::vector<double> cuts;
    for (std::size_t k = 0; k < area.outline_px.size(); ++k) {
      const Point2 &a = area.outline_px[k], &b = area.outline_px[(k + 1) % area.outline_px.size()];
      const double at_a = across.dot(a) - level, at_b = across.dot(b) - level;
      if ((at_a < 0) != (at_b < 0)) cuts.push_back(along_lines.dot(a + (b - a) * (at_a / (at_a - at_b))));
    }
    if (cuts.size() < 2) continue;
    const auto [from, to] = std::minmax_element(cuts.begin(), cuts.end());
    lines.push_back({*from * along_lines + level * across, *to * along_lines + level * across});
  }
  return lines;
}

HatchedStrokes find_hatched_strokes(const std::vector<Stroke>& strokes, double extent) {
  HatchedStrokes found;
  found.is_hatching.assign(strokes.size(), false);
  Directions walls;
  walls.fold = 2;
  for (const Stroke& stroke : strokes)
    for (std::size_t i = 0; stroke.kind == StrokeKind::kWall && i + 1 < stroke.points_px.size(); ++i) {
      const Segment2 piece{stroke.points_px[i], stroke.points_px[i + 1]};
      if (piece.length() > 0) walls.add(piece.heading(), piece.length() * piece.length());  // long ones are walls
    }
  std::vector<std::size_t> family(strokes.size());
  std::iota(family.begin(), family.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (family[i] != i) i = family[i];
    return i;
  };
  std::vector<std::size_t> slanting;
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (is_straight(strokes[i]) && is_slanting(chord(strokes[i]).heading(), walls.mean_rad())) slanting.push_back(i);
  for (std::size_t n = 0; n < slanting.size(); ++n)
    for (std::size_t m = n + 1; m < slanting.size(); ++m)
      if (lie_side_by_side(chord(strokes[slanting[n]]), chord(strokes[slanting[m]]), kStrokeSpacing * extent)) {
        const std::size_t one = root(slanting[n]), two = root(slanting[m]);
        family[std::max(one, two)] = std::min(one, two);
      }
  for (const std::size_t head : slanting) {
    std::vector<std::size_t> members;
    for (const std::size_t i : slanting)
      if (root(i) == head) members.push_back(i);
    if (members.size() < kFamily) continue;
    std::vector<cv::Point2f> ends, hull;
    Directions lines;
    for (const std::size_t i : members) {
      found.is_hatching[i] = true;
      lines.add(chord(strokes[i]).heading(), chord(strokes[i]).length());
      for (const Point2& p : {strokes[i].points_px.front(), strokes[i].points_px.back()})
        ends.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    }
    cv::convexHull(ends, hull);
    Hatching area;
    area.heading_rad = lines.mean_rad();
    for (const cv::Point2f& p : hull) area.outline_px.emplace_back(p.x, p.y);
    found.areas.push_back(std::move(area));
  }
  return found;
}

}  // namespace smokemap
