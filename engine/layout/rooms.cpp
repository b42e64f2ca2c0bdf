#include "layout/rooms.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "layout/doors.hpp"

namespace smokemap {

namespace {

constexpr double kLeastRoom = 0.5;  ///< of the square of a door's width

/// Lines that close what the reader left open: from a loose end without an opening to the nearest wall or corner ahead.
std::vector<Segment2> shutters(const LayoutMap& map, double reach_px) {
  std::vector<Segment2> lines;
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const Segment2 wall = map.wall_px(static_cast<int>(w));
    for (const bool at_b : {false, true}) {
      const Point2 end = at_b ? wall.b : wall.a, outward = at_b ? wall.direction() : Point2(-wall.direction());
      const auto corner = static_cast<std::size_t>(at_b ? map.walls[w].corner_b : map.walls[w].corner_a);
      const bool met = map.corners[corner].degree > 1 ||
                       std::any_of(map.openings.begin(), map.openings.end(), [&](const LayoutOpening& o) {
                         return (o.gap_px.a - end).norm() < 1.5 || (o.gap_px.b - end).norm() < 1.5;
                       });
      if (met) continue;
      double best = reach_px;
      Point2 target = end;
      for (std::size_t j = 0; j < map.walls.size(); ++j) {
        if (j == w) continue;
        const Point2 p = closest_point(map.wall_px(static_cast<int>(j)), end);
        const double d = (p - end).norm();
        if (d > 1e-9 && d < best && (p - end).dot(outward) > 0.35 * d) best = d, target = p;
      }
      if (best < reach_px) lines.push_back({end, target});
    }
  }
  return lines;
}

/// Nobody goes into a space that much smaller than the square of a door: a shaft, a pillar, a slip.
double least_room_area(const LayoutMap& map) {
  const auto door = usual_door_width(door_widths(map));
  return door ? kLeastRoom * *door * *door : 0;
}

}  // namespace

std::vector<Polygon> find_rooms(const LayoutMap& map) {
  if (map.walls.empty()) return {};
  Point2 low = map.corners.front().p_px, high = low;
  for (const auto& c : map.corners) low = low.cwiseMin(c.p_px), high = high.cwiseMax(c.p_px);
  const double extent = std::max(1.0, (high - low).maxCoeff());
  const double scale = 1400 / extent;  // fine enough for a closet, and the same work for every plan
  const int border = 8;
  const auto to_raster = [&](const Point2& p) {
    const Point2 q = scale * (p - low);
    return cv::Point(static_cast<int>(std::lround(q.x())) + border, static_cast<int>(std::lround(q.y())) + border);
  };
  cv::Mat closed(static_cast<int>((high - low).y() * scale) + 2 * border + 2,
                 static_cast<int>((high - low).x() * scale) + 2 * border + 2, CV_8UC1, cv::Scalar(255));
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const Segment2 s = map.wall_px(static_cast<int>(w));
    cv::line(closed, to_raster(s.a), to_raster(s.b), cv::Scalar(0), 3);
  }
  for (const auto& o : map.openings) cv::line(closed, to_raster(o.gap_px.a), to_raster(o.gap_px.b), cv::Scalar(0), 3);
  for (const auto& line : shutters(map, 0.05 * extent))
    cv::line(closed, to_raster(line.a), to_raster(line.b), cv::Scalar(0), 3);
  cv::floodFill(closed, {0, 0}, cv::Scalar(0));
  cv::Mat labels, stats, centroids;
  const int count = cv::connectedComponentsWithStats(closed, labels, stats, centroids, 4);
  const double least_area = std::max(0.0005 * 1400 * 1400, least_room_area(map) * scale * scale);
  std::vector<std::pair<int, Polygon>> rooms;
  for (int label = 1; label < count; ++label) {
    const int area = stats.at<int>(label, cv::CC_STAT_AREA);
    if (area < least_area) continue;
    const cv::Rect box(stats.at<int>(label, cv::CC_STAT_LEFT), stats.at<int>(label, cv::CC_STAT_TOP),
                       stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT));
    const cv::Rect wide =
        cv::Rect(box.x - 2, box.y - 2, box.width + 4, box.height + 4) & cv::Rect(0, 0, closed.cols, closed.rows);
    cv::Mat mask = labels(wide) == label;
    cv::dilate(mask, mask, cv::Mat());
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(mask, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
    const auto& outline = *std::max_element(outlines.begin(), outlines.end(), [](const auto& a, const auto& b) {
      return cv::contourArea(a) < cv::contourArea(b);
    });
    std::vector<cv::Point> simple;
    cv::approxPolyDP(outline, simple, 2.5, true);
    if (simple.size() < 3) continue;
    Polygon room;
    for (const auto& p : simple) room.push_back(low + Point2(p.x + wide.x - border, p.y + wide.y - border) / scale);
    rooms.emplace_back(area, std::move(room));
  }
  std::stable_sort(rooms.begin(), rooms.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Polygon> out;
  for (auto& [area, room] : rooms) out.push_back(std::move(room));
  return out;
}

}  // namespace smokemap
