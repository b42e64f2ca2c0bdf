#pragma once

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "core/random.hpp"
#include "simulation/random_building.hpp"
#include "tests/support/plan_pictures.hpp"

namespace smokemap::test {

/// The storey of a simulated building (corridors in two wings, rooms of different size on both sides, some behind
/// others) as a picture with its true rooms. Exits are drawn closed. Doors are not in the order of rooms: habits that
/// open them as wide as the room do not apply.
inline PlanPicture building_plan(std::mt19937_64& random) {
  constexpr double kPxPerMetre = 15, kMargin_px = 20;
  RandomBuildingParams params;
  params.length_m = uniform(random, 18, 42), params.depth_m = uniform(random, 16, 26);
  params.max_room_m = uniform(random, 4.5, 8);
  const FloorPlan building = random_building(params, random).value();
  Point2 low = building.corners.front(), high = low;
  for (const Point2& p : building.corners) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const auto pixel = [&](const Point2& p) {
    return cv::Point(static_cast<int>(std::lround(kMargin_px + kPxPerMetre * (p.x() - low.x()))),
                     static_cast<int>(std::lround(kMargin_px + kPxPerMetre * (high.y() - p.y()))));
  };
  const cv::Point corner = pixel(Point2(high.x(), low.y()));
  PlanPicture plan;
  plan.rooms = cv::Mat(corner.y + static_cast<int>(kMargin_px), corner.x + static_cast<int>(kMargin_px), CV_16UC1,
                       cv::Scalar(0));
  for (size_t room = 0; room < building.rooms.size(); ++room) {
    std::vector<cv::Point> ring;
    for (const int at : building.rooms[room].ring) ring.push_back(pixel(building.corners[static_cast<size_t>(at)]));
    cv::fillPoly(plan.rooms, std::vector<std::vector<cv::Point>>{ring}, cv::Scalar(static_cast<double>(room + 1)));
    const cv::Rect box = cv::boundingRect(ring);
    plan.boxes.emplace_back(box.x + 2, box.y + 2, box.width - 5, box.height - 5);
  }
  for (const PlanWall& wall : building.walls)
    cv::line(plan.rooms, pixel(building.corners[static_cast<size_t>(wall.corner_a)]),
             pixel(building.corners[static_cast<size_t>(wall.corner_b)]), cv::Scalar(0),
             std::max(5, static_cast<int>(std::lround(kPxPerMetre * wall.thickness_m))));
  for (size_t door = 0; door < building.doors.size(); ++door) {
    const auto [one, other] = building.rooms_beside(building.doors[door].wall);
    if (one < 0 || other < 0) continue;
    const Segment2 gap = building.door_gap(static_cast<int>(door));
    cv::line(plan.rooms, pixel(gap.a), pixel(gap.b), cv::Scalar(one + 1), 7);
    plan.doors.push_back(cv::boundingRect(std::vector<cv::Point>{pixel(gap.a), pixel(gap.b)}) + cv::Size(6, 6) -
                         cv::Point(3, 3));
  }
  plan.free_space = plan.rooms != 0;
  return plan;
}

}  // namespace smokemap::test
