#pragma once

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "geometry/segment2.hpp"
#include "maps/layout_map.hpp"

namespace smokemap::testing {

/// A drawn office with its truth: 2 x 3 rooms around a corridor, doors with leaf and arc, text, a sign, all in
/// proportion to `unit` (pixels; 1 gives about 1600 x 1100).
struct DrawnPlan {
  cv::Mat picture;
  std::vector<Segment2> walls;
  std::vector<Segment2> doors;
  int rooms = 7;
  double thickness_px = 0;
};

namespace detail {
inline cv::Point px(const Point2& p) {
  return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}
}  // namespace detail

inline DrawnPlan draw_office(double unit = 1.0, bool clutter = true) {
  DrawnPlan plan;
  plan.picture =
      cv::Mat(static_cast<int>(1100 * unit), static_cast<int>(1600 * unit), CV_8UC3, cv::Scalar(255, 255, 255));
  plan.thickness_px = 12 * unit;
  const int outer = static_cast<int>(std::lround(12 * unit)), inner = static_cast<int>(std::lround(7 * unit));
  const auto wall = [&](double x1, double y1, double x2, double y2, int width) {
    const Segment2 s{unit * Point2(x1, y1), unit * Point2(x2, y2)};
    plan.walls.push_back(s);
    cv::line(plan.picture, detail::px(s.a), detail::px(s.b), cv::Scalar(20, 20, 20), width);
  };
  const auto door = [&](double x1, double x2, double y, double side) {
    const Segment2 s{unit * Point2(x1, y), unit * Point2(x2, y)};
    plan.doors.push_back(s);
    if (!clutter) return;
    const double width = x2 - x1;
    const int thin = std::max(1, static_cast<int>(std::lround(1.2 * unit)));
    cv::line(plan.picture, detail::px(s.a), detail::px(unit * Point2(x1, y + side * width)), cv::Scalar(60, 60, 60),
             thin, cv::LINE_AA);
    cv::ellipse(plan.picture, detail::px(s.a), cv::Size(static_cast<int>(width * unit), static_cast<int>(width * unit)),
                0, side > 0 ? 0 : -90, side > 0 ? 90 : 0, cv::Scalar(60, 60, 60), thin, cv::LINE_AA);
  };
  wall(200, 200, 1400, 200, outer), wall(1400, 200, 1400, 800, outer), wall(1400, 800, 200, 800, outer),
      wall(200, 800, 200, 200, outer);
  for (const double x : {600.0, 1000.0}) wall(x, 200, x, 440, inner), wall(x, 560, x, 800, inner);
  for (const double y : {440.0, 560.0}) {
    double from = 200;
    for (const double x : {300.0, 700.0, 1100.0}) {
      wall(from, y, x, y, inner);
      door(x, x + 70, y, y < 500 ? -1 : 1);
      from = x + 70;
    }
    wall(from, y, 1400, y, inner);
  }
  if (clutter) {
    for (const double x : {360.0, 760.0, 1160.0})
      cv::putText(plan.picture, "Office", detail::px(unit * Point2(x, 330)), cv::FONT_HERSHEY_SIMPLEX, 0.8 * unit,
                  cv::Scalar(0, 0, 0), std::max(1, static_cast<int>(2 * unit)), cv::LINE_AA);
    const Point2 sign = unit * Point2(850, 500);
    cv::rectangle(plan.picture, detail::px(sign), detail::px(sign + unit * Point2(36, 36)), cv::Scalar(80, 145, 0),
                  cv::FILLED);
  }
  return plan;
}

inline std::vector<Segment2> wall_segments(const LayoutMap& map) {
  std::vector<Segment2> walls;
  for (std::size_t w = 0; w < map.walls.size(); ++w) walls.push_back(map.wall_px(static_cast<int>(w)));
  return walls;
}

/// Share of the length of `these` that lies within `tolerance_px` of a wall of like direction among `those`.
inline double covered_by(const std::vector<Segment2>& these, const std::vector<Segment2>& those, double tolerance_px) {
  double covered = 0, all = 0;
  for (const auto& s : these)
    for (double t = 0.5; t < s.length(); t += 1) {
      const Point2 p = s.a + t * s.direction();
      all += 1;
      for (const auto& o : those)
        if (distance(o, p) < tolerance_px && line_angle_between(o.heading(), s.heading()) < radians(10)) {
          covered += 1;
          break;
        }
    }
  return all > 0 ? covered / all : 0;
}

}  // namespace smokemap::testing
