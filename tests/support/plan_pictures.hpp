#pragma once

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "core/random.hpp"
#include "geometry/pose2.hpp"

namespace smokemap::test {

/// A drawn floor plan and, for every free pixel, which room it belongs to.
struct PlanPicture {
  cv::Mat free_space;           ///< CV_8UC1, 255 = free
  cv::Mat rooms;                ///< CV_16UC1, 0 = wall, 1 = corridor, then rooms
  std::vector<cv::Rect> boxes;  ///< of room 1, 2, ...
  std::vector<cv::Rect> doors;
};

/// A corridor with rooms of different widths and depths on both sides, each behind a door.
inline PlanPicture office_plan(std::mt19937_64& random, int rooms_a_side = 4) {
  const int wall = 4, corridor = 30, door = 12, margin = 20;
  std::vector<cv::Rect> boxes(1);
  std::vector<cv::Rect> doors;
  int right = margin;
  const int top = 150;
  for (const bool is_above : {true, false}) {
    int x = margin;
    for (int room = 0; room < rooms_a_side; ++room) {
      const int width = static_cast<int>(uniform(random, 45, 95)), depth = static_cast<int>(uniform(random, 55, 110));
      const int y = is_above ? top - wall - depth : top + corridor + wall;
      boxes.emplace_back(x, y, width, depth);
      const int door_x = x + static_cast<int>(uniform(random, 4, width - door - 4));
      doors.emplace_back(door_x, is_above ? top - wall : top + corridor, door, wall);
      x += width + wall;
    }
    right = std::max(right, x - wall);
  }
  boxes[0] = cv::Rect(margin, top, right - margin, corridor);
  PlanPicture plan{cv::Mat(330, right + margin, CV_8UC1, cv::Scalar(0)), {}, boxes, doors};
  plan.rooms = cv::Mat(plan.free_space.size(), CV_16UC1, cv::Scalar(0));
  for (const cv::Rect& opening : doors) plan.rooms(opening).setTo(1);
  for (size_t i = 0; i < boxes.size(); ++i) plan.rooms(boxes[i]).setTo(static_cast<int>(i) + 1);
  plan.free_space.setTo(255, plan.rooms != 0);
  return plan;
}

/// A hall with rooms on all four sides, some with a closet behind.
inline PlanPicture hall_plan(std::mt19937_64& random) {
  const int wall = 4, margin = 20, deep = 110, door = 12;
  const int width = static_cast<int>(uniform(random, 160, 280)), height = static_cast<int>(uniform(random, 110, 200));
  PlanPicture plan;
  plan.boxes.emplace_back(margin + deep, margin + deep, width, height);
  const cv::Rect hall = plan.boxes.front();
  const auto add = [&](const cv::Rect& box, const cv::Rect& opening) {
    plan.boxes.push_back(box);
    plan.doors.push_back(opening);
  };
  for (int side = 0; side < 4; ++side) {
    const bool level = side % 2 == 0;  // rooms above and below; else left and right
    int at = level ? hall.x : hall.y;
    const int end = at + (level ? width : height);
    while (end - at > 40) {
      const int along = std::min(end - at, static_cast<int>(uniform(random, 35, 100)));
      const int depth = static_cast<int>(uniform(random, 25, 70));
      const int gap = at + 4 + static_cast<int>(uniform(random, 0, along - door - 8));
      const int low = side == 0   ? hall.y - wall - depth
                      : side == 1 ? hall.x + width + wall
                      : side == 2 ? hall.y + height + wall
                                  : hall.x - wall - depth;
      const int jamb = side == 0 || side == 3 ? low + depth : low - wall;
      if (uniform01(random) < 0.75) {
        add(level ? cv::Rect(at, low, along, depth) : cv::Rect(low, at, depth, along),
            level ? cv::Rect(gap, jamb, door, wall) : cv::Rect(jamb, gap, wall, door));
        const int behind = side == 0 || side == 3 ? low - wall - 22 : low + depth + wall;
        const int jamb_behind = side == 0 || side == 3 ? low - wall : low + depth;
        if (uniform01(random) < 0.35)
          add(level ? cv::Rect(at, behind, along / 2, 22) : cv::Rect(behind, at, 22, along / 2),
              level ? cv::Rect(at + 3, jamb_behind, door, wall) : cv::Rect(jamb_behind, at + 3, wall, door));
      }
      at += along + wall;
    }
  }
  plan.free_space = cv::Mat(height + 2 * (margin + deep), width + 2 * (margin + deep), CV_8UC1, cv::Scalar(0));
  plan.rooms = cv::Mat(plan.free_space.size(), CV_16UC1, cv::Scalar(0));
  for (const cv::Rect& opening : plan.doors) plan.rooms(opening).setTo(1);
  for (size_t i = 0; i < plan.boxes.size(); ++i) plan.rooms(plan.boxes[i]).setTo(static_cast<int>(i) + 1);
  plan.free_space.setTo(255, plan.rooms != 0);
  return plan;
}

/// The true room that most pixels with a label have, and how much the two cover each other (intersection over union).
struct TrueRoom {
  int room = 0;
  double overlap = 0;
};
inline TrueRoom true_room(const cv::Mat& labels, int label, const cv::Mat& rooms) {
  TrueRoom best;
  double largest = 0;
  cv::minMaxLoc(rooms, nullptr, &largest);
  const cv::Mat mine = labels == label;
  int most = 0;
  for (int room = 1; room <= static_cast<int>(largest); ++room) {
    const cv::Mat theirs = rooms == room;
    const int common = cv::countNonZero(mine & theirs);
    if (common <= most) continue;
    most = common;
    best = {room, static_cast<double>(common) / cv::countNonZero(mine | theirs)};
  }
  return best;
}

}  // namespace smokemap::test
