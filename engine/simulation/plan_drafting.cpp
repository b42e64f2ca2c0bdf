#include "simulation/plan_drafting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

const cv::Scalar kFaceInk(25, 25, 25), kDraftInk(60, 60, 60), kRulingInk(165, 160, 155), kBlank(255, 255, 255);

constexpr double kHatchAngle = kPi / 4;
constexpr double kTickPx = 6;    ///< half of it, times the sheet's unit
constexpr double kBeyondPx = 7;  ///< how far lines run over each other
constexpr double kNumberPx = 8;  ///< height of digits

/// The rectangle, smaller by `by` on every side; nothing is left of one that is too thin.
Polygon shrunk(const Polygon& quad, double by) {
  const Point2 u = (quad[1] - quad[0]).normalized(), v = (quad[3] - quad[0]).normalized();
  if ((quad[1] - quad[0]).norm() <= 2 * by || (quad[3] - quad[0]).norm() <= 2 * by) return {};
  return {quad[0] + by * (u + v), quad[1] + by * (v - u), quad[2] - by * (u + v), quad[3] + by * (u - v)};
}

void hatch(PlanCanvas& canvas, const Polygon& quad, double spacing_px, double width_px) {
  const Point2 u(std::cos(kHatchAngle), -std::sin(kHatchAngle)), n(-u.y(), u.x());
  double low = 1e300, high = -1e300;
  for (const Point2& p : quad) low = std::min(low, p.dot(n)), high = std::max(high, p.dot(n));
  for (double at = std::ceil(low / spacing_px) * spacing_px; at < high; at += spacing_px) {
    const Segment2 line = clipped_line(quad, at * n, u);
    if (line.length() > width_px) canvas.line(line.a, line.b, width_px, kFaceInk);
  }
}

}  // namespace

Segment2 clipped_line(const Polygon& convex, const Point2& p, const Point2& direction) {
  const Point2 n(-direction.y(), direction.x());
  std::vector<Point2> hits;
  for (std::size_t i = 0; i < convex.size(); ++i) {
    const Point2 &a = convex[i], &b = convex[(i + 1) % convex.size()];
    const double from = (a - p).dot(n), to = (b - p).dot(n);
    if ((from < 0) != (to < 0)) hits.push_back(a + from / (from - to) * (b - a));
  }
  if (hits.size() < 2) return {p, p};
  return {hits[0], hits[1]};
}

void draw_cut_walls(PlanCanvas& canvas, const std::vector<Polygon>& quads, WallFill fill, double line_px,
                    double spacing_px) {
  for (const Polygon& quad : quads) canvas.fill(quad, kFaceInk);
  if (fill == WallFill::kSolid) return;
  std::vector<Polygon> bodies;
  for (const Polygon& quad : quads)
    if (auto body = shrunk(quad, line_px); !body.empty()) bodies.push_back(std::move(body));
  for (const Polygon& body : bodies) canvas.fill(body, kBlank);
  if (fill == WallFill::kHatched)
    for (const Polygon& body : bodies) hatch(canvas, body, spacing_px, 0.8 * line_px);
}

void draw_dimensions(PlanCanvas& canvas, const std::vector<Point2>& places, const Segment2& line, bool leads,
                     double unit, double metres_per_pixel) {
  if (places.size() < 2) return;
  const Point2 u = line.direction(), n = line.normal();
  const auto foot = [&](const Point2& p) { return Point2(line.a + (p - line.a).dot(u) * u); };
  const double beyond = kBeyondPx * unit, thin = 1.1 * unit;
  canvas.line(foot(places.front()) - beyond * u, foot(places.back()) + beyond * u, thin, kDraftInk);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Point2 at = foot(places[i]), tick = kTickPx * unit * (u + n);
    canvas.line(at - tick, at + tick, 1.6 * unit, kFaceInk);
    const Point2 away = (at - places[i]).normalized();
    if (leads) canvas.line(places[i] + beyond * away, at + beyond * away, thin, kDraftInk);
    if (i == 0) continue;
    const double length = (at - foot(places[i - 1])).norm();
    std::array<char, 16> number{};
    std::snprintf(number.data(), number.size(), "%.2f", length * metres_per_pixel);
    if (length > 4.5 * kNumberPx * unit)
      canvas.text(number.data(), 0.5 * (at + foot(places[i - 1])) - Point2(0, 4 * unit), kNumberPx * unit, kDraftInk,
                  PlanCanvas::Anchor::kCenter);
  }
}

void rule_paper(PlanCanvas& canvas, PaperRuling ruling, double spacing_px, double line_px) {
  if (ruling == PaperRuling::kNone) return;
  const double width = canvas.width_px(), height = canvas.height_px();
  for (double y = 0.5 * spacing_px; y < height; y += spacing_px) canvas.line({0, y}, {width, y}, line_px, kRulingInk);
  if (ruling == PaperRuling::kSquares)
    for (double x = 0.5 * spacing_px; x < width; x += spacing_px) canvas.line({x, 0}, {x, height}, line_px, kRulingInk);
}

}  // namespace smokemap
