#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>
#include <vector>

#include "core/random.hpp"
#include "geometry/pose2.hpp"
#include "tests/support/plan_pictures.hpp"

namespace smokemap::test {

/// What people do to a plan when they draw it from memory. All lengths in pixels of the plan.
struct SketchHabits {
  int quarter_turns = 0;
  bool mirrored = false;
  double scale = 1.2;
  double stretch = 1.0;  ///< along the corridor over across it
  double bend_px = 6;    ///< how far long walls wander
  double pen_px = 0;     ///< how far the pen shakes
  double tilt_rad = 0.03;
  int rooms_left_out = 0;
  int doors_forgotten = 0;
  int walls_forgotten = 0;  ///< between neighbours, which become one
  double open_doors = 0;    ///< share of doors drawn as an opening as wide as the room
  double uneven = 0;        ///< standard deviation of the logarithm of the scale, drawn anew every 60 px and on
                            ///< either side of the building: long corridors get short, small rooms large
  double seen = 1;          ///< share of the plan's width that is drawn: a robot's map of a part
};

/// The habits of somebody met at random.
inline SketchHabits random_habits(std::mt19937_64& random) {
  SketchHabits habits;
  habits.quarter_turns = static_cast<int>(uniform_index(random, 4));
  habits.scale = uniform(random, 0.7, 1.6), habits.stretch = uniform(random, 0.75, 1.3);
  habits.tilt_rad = normal(random, 0.08), habits.bend_px = uniform(random, 2, 10),
  habits.pen_px = uniform(random, 0, 2);
  habits.rooms_left_out = static_cast<int>(uniform_index(random, 4));
  habits.doors_forgotten = static_cast<int>(uniform_index(random, 3));
  habits.walls_forgotten = static_cast<int>(uniform_index(random, 3));
  habits.open_doors = uniform01(random) < 0.5 ? uniform(random, 0, 1) : 0;
  habits.uneven = uniform(random, 0.1, 0.6);
  habits.seen = uniform01(random) < 0.3 ? uniform(random, 0.5, 0.9) : 1;
  return habits;
}

/// The drawing, the true rooms in it, and where every point of it lies on the plan.
struct PlanSketch {
  PlanPicture picture;
  cv::Mat to_plan;  ///< CV_32FC2, plan pixel of every sketch pixel
  std::set<int> left_out;

  Point2 on_plan(const Point2& p_sketch) const {
    const cv::Vec2f p =
        to_plan.at<cv::Vec2f>(static_cast<int>(std::lround(p_sketch.y())), static_cast<int>(std::lround(p_sketch.x())));
    return {p[0], p[1]};
  }
};

/// Where a drawn length ends when the scale changes on the way: monotone, about the identity.
class UnevenScale {
 public:
  UnevenScale(double sigma, int length, std::mt19937_64& random) {
    double at = 0;
    for (int knot = 0; knot <= length / kStep + 2; ++knot) {
      ends_.push_back(at);
      at += kStep * (sigma > 0 ? std::exp(normal(random, sigma)) : 1.0);
    }
    middle_ = 0.5 * (length - at * length / (kStep * static_cast<double>(ends_.size())));
  }
  double operator()(double x) const {
    const double place = std::clamp(x / kStep, 0.0, static_cast<double>(ends_.size()) - 1.001);
    const auto knot = static_cast<size_t>(place);
    return middle_ + ends_[knot] + (place - static_cast<double>(knot)) * (ends_[knot + 1] - ends_[knot]) +
           (x < 0 ? x : 0);
  }

 private:
  static constexpr int kStep = 60;
  std::vector<double> ends_;
  double middle_ = 0;
};

/// The scale changes differently on both sides of the building, and by and by in the middle third between them.
class TwoSidedScale {
 public:
  TwoSidedScale(double sigma, int length, int across, std::mt19937_64& random)
      : one_(sigma, length, random), other_(sigma, length, random), across_(across) {}
  double operator()(double x, double y) const {
    const double t = std::clamp(3 * y / across_ - 1, 0.0, 1.0), share = t * t * (3 - 2 * t);
    return (1 - share) * one_(x) + share * other_(x);
  }

 private:
  UnevenScale one_, other_;
  double across_;
};

/// Fills the wall between two boxes that lie side by side.
inline void forget_wall(const PlanPicture& plan, size_t one, size_t two, cv::Mat& rooms) {
  const cv::Rect a = plan.boxes[one], b = plan.boxes[two];
  const cv::Rect both = a | b;
  const int left = std::max(a.x, b.x), right = std::min(a.br().x, b.br().x);
  const int top = std::max(a.y, b.y), bottom = std::min(a.br().y, b.br().y);
  const cv::Rect gap = left >= right ? cv::Rect(right, top, left - right, bottom - top)
                                     : cv::Rect(left, bottom, right - left, top - bottom);
  if (gap.width > 0 && gap.height > 0 && std::min(gap.width, gap.height) <= 6 && both.contains(gap.tl()))
    rooms(gap).setTo(static_cast<int>(one) + 1);
}

/// The rooms as somebody remembers them, still in their places.
inline cv::Mat remembered_rooms(const PlanPicture& plan, const SketchHabits& habits, std::set<int>& left_out,
                                std::mt19937_64& random) {
  cv::Mat rooms = plan.rooms.clone();
  const auto count = static_cast<std::uint64_t>(plan.boxes.size());
  while (static_cast<int>(left_out.size()) < std::min(habits.rooms_left_out, static_cast<int>(count) - 2))
    left_out.insert(2 + static_cast<int>(uniform_index(random, count - 1)));
  for (size_t k = 0; k < plan.doors.size() && habits.open_doors > 0; ++k) {
    cv::Rect opening = plan.doors[k];
    const cv::Rect box = plan.boxes[k + 1];
    if (uniform01(random) >= habits.open_doors) continue;
    if (opening.width > opening.height)
      opening.x = box.x + 2, opening.width = box.width - 4;
    else
      opening.y = box.y + 2, opening.height = box.height - 4;
    rooms(opening).setTo(1);
  }
  for (int i = 0; i < habits.walls_forgotten && count > 3; ++i) {
    const size_t one = 1 + uniform_index(random, count - 2);
    forget_wall(plan, one, one + 1, rooms);
  }
  for (const int room : left_out) rooms.setTo(0, plan.rooms == room);
  for (int i = 0; i < habits.doors_forgotten && !plan.doors.empty(); ++i)
    rooms(plan.doors[uniform_index(random, plan.doors.size())]).setTo(0);
  if (habits.seen < 1) {
    const int kept = static_cast<int>(habits.seen * rooms.cols);
    const int begin = static_cast<int>(uniform_index(random, static_cast<std::uint64_t>(rooms.cols - kept) + 1));
    rooms.colRange(0, begin).setTo(0), rooms.colRange(begin + kept, rooms.cols).setTo(0);
  }
  return rooms;
}

/// The building with stubs of walls, pillars and cupboards that reach into rooms and corridors: what makes anybody who
/// reads the map split a room that people call one.
inline PlanPicture with_stubs(PlanPicture plan, int count, std::mt19937_64& random) {
  for (int i = 0; i < count; ++i) {
    const cv::Rect box = plan.boxes[uniform01(random) < 0.4 ? 0 : uniform_index(random, plan.boxes.size())];
    const auto side = uniform_index(random, 4);
    const bool is_level = side % 2 == 0;  // from the wall above or below; else from the left or the right
    const int across = is_level ? box.height : box.width, along = is_level ? box.width : box.height;
    const int deep = static_cast<int>(across * uniform(random, 0.2, 0.65));
    const int at = static_cast<int>(uniform(random, 6, along - 9));
    const int thick = 3 + static_cast<int>(uniform_index(random, 6));
    const cv::Rect stub = is_level ? cv::Rect(box.x + at, side == 0 ? box.y : box.y + box.height - deep, thick, deep)
                                   : cv::Rect(side == 1 ? box.x : box.x + box.width - deep, box.y + at, deep, thick);
    plan.rooms(stub & box).setTo(0), plan.free_space(stub & box).setTo(0);
  }
  return plan;
}

/// Smooth random moves of `sigma` pixels, changing every ten.
inline cv::Mat pen_shake(const cv::Size& size, double sigma, std::mt19937_64& random) {
  cv::Mat knots(size.height / 10 + 2, size.width / 10 + 2, CV_32FC2), shake;
  for (int y = 0; y < knots.rows; ++y)
    for (int x = 0; x < knots.cols; ++x)
      knots.at<cv::Vec2f>(y, x) = {static_cast<float>(normal(random, sigma)),
                                   static_cast<float>(normal(random, sigma))};
  cv::resize(knots, shake, size, 0, 0, cv::INTER_LINEAR);
  return shake;
}

inline PlanSketch sketch_of(const PlanPicture& plan, const SketchHabits& habits, std::mt19937_64& random) {
  PlanSketch sketch;
  const cv::Mat rooms = remembered_rooms(plan, habits, sketch.left_out, random);
  const TwoSidedScale uneven_x(habits.uneven, rooms.cols, rooms.rows, random),
      uneven_y(habits.uneven, rooms.rows, rooms.cols, random);
  const double side = (habits.uneven > 0 ? 1.6 : 1.25) * habits.scale * std::max(rooms.cols, rooms.rows) *
                      std::max(1.0, habits.stretch);
  const cv::Size size(static_cast<int>(side), static_cast<int>(side));
  const double angle = habits.tilt_rad + habits.quarter_turns * std::numbers::pi / 2;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const double phase_x = uniform(random, 0, 6), phase_y = uniform(random, 0, 6);
  sketch.to_plan = cv::Mat(size, CV_32FC2);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const double dx = (habits.mirrored ? -1 : 1) * (x - 0.5 * size.width), dy = y - 0.5 * size.height;
      const double u = (cosine * dx - sine * dy) / (habits.scale * habits.stretch);
      const double v = (sine * dx + cosine * dy) / habits.scale;
      const double px = 0.5 * rooms.cols + u + habits.bend_px * std::sin(v / 55 + phase_x);
      const double py = 0.5 * rooms.rows + v + habits.bend_px * std::sin(u / 70 + phase_y);
      const bool even = habits.uneven <= 0;
      sketch.to_plan.at<cv::Vec2f>(y, x) = {static_cast<float>(even ? px : uneven_x(px, py)),
                                            static_cast<float>(even ? py : uneven_y(py, px))};
    }
  if (habits.pen_px > 0) sketch.to_plan += pen_shake(size, habits.pen_px, random);
  cv::remap(rooms, sketch.picture.rooms, sketch.to_plan, cv::noArray(), cv::INTER_NEAREST, cv::BORDER_CONSTANT, 0);
  sketch.picture.free_space = sketch.picture.rooms != 0;
  return sketch;
}

}  // namespace smokemap::test
