// Goals in smoke: ./run bench smoke [--seeds N] [--first N] [--rooms N] [--pictures FOLDER] [--trace]
// The demo's robot is sent to the rooms with the thickest smoke, while it spreads. Counts what the map says that is
// not so: cells called occupied where nothing stands (by the smoke there), and free where no beam of a lidar that
// passed no wall could have been.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "tests/support/mission.hpp"

namespace {

using namespace smokemap;

constexpr double kSmoke = 0.3;     // 1/m: visibility of about 10 m
constexpr double kBesideM = 0.30;  // a cell this near to a wall may be called occupied
constexpr int kOccupied = 60, kFree = 40;

struct FalseCells {
  int occupied_clear = 0, occupied_smoke = 0, free = 0, seen = 0;
};

FalseCells count_false(const DemoScenario& demo, const test::MissionResult& r) {
  FalseCells count;
  if (!r.sensed || r.sensed->empty()) return count;
  const GridFrame& frame = r.sensed->frame();
  Cell cell;
  for (cell.y = 0; cell.y < frame.height_cells; ++cell.y)
    for (cell.x = 0; cell.x < frame.width_cells; ++cell.x) {
      const int percent = r.sensed->at(cell);
      if (percent < 0) continue;
      ++count.seen;
      const Point2 p = demo.T_world_start * frame.center_of(cell);
      const double clearance = demo.world.walls.clearance_m(p, 1.0);
      if (percent >= kOccupied && clearance > kBesideM)
        ++(r.smoke.extinction_at(p) > kSmoke ? count.occupied_smoke : count.occupied_clear);
      if (percent > kFree || clearance < kBesideM) continue;
      bool sees = false;
      for (std::size_t i = 0; i < r.way_world.size() && !sees; ++i) sees = demo.world.walls.sees(r.way_world[i], p);
      count.free += !sees;
    }
  return count;
}

void draw(const DemoScenario& demo, const test::MissionResult& r, const std::string& path) {
  if (!r.sensed || r.sensed->empty()) return;
  const GridFrame& frame = r.sensed->frame();
  constexpr int kZoom = 2;
  cv::Mat picture(frame.height_cells * kZoom, frame.width_cells * kZoom, CV_8UC3);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      const Cell cell{x / kZoom, frame.height_cells - 1 - y / kZoom};
      const int percent = r.sensed->at(cell);
      const int grey = percent < 0 ? 200 : 255 - percent * 255 / 100;
      const int smoke =
          std::min(120, static_cast<int>(60 * r.smoke.extinction_at(demo.T_world_start * frame.center_of(cell))));
      picture.at<cv::Vec3b>(y, x) = {static_cast<std::uint8_t>(std::max(0, grey - smoke)),
                                     static_cast<std::uint8_t>(std::max(0, grey - smoke / 2)),
                                     static_cast<std::uint8_t>(grey)};
    }
  const auto px = [&](const Point2& p_world) {
    const Point2 p = (demo.to_map(p_world) - frame.origin) / frame.resolution_m;
    return cv::Point2d(kZoom * p.x(), kZoom * (frame.height_cells - p.y()));
  };
  for (const WorldSegment& s : demo.world.walls.segments())
    cv::line(picture, px(s.line.a), px(s.line.b), cv::Scalar(255, 120, 0), 1);
  for (std::size_t i = 1; i < r.way_world.size(); ++i)
    cv::line(picture, px(r.way_world[i - 1]), px(r.way_world[i]), cv::Scalar(0, 150, 0), 1);
  cv::circle(picture, px(demo.p_world_far_room), 6, cv::Scalar(200, 0, 200), 2);
  cv::imwrite(path, picture);
}

/// Rooms that can be reached, thickest smoke first, after the smoke has spread for a while.
std::vector<int> smoky_rooms(const DemoScenario& demo) {
  SmokeField smoke = demo.world.smoke;
  smoke.advance(60);
  std::vector<std::pair<double, int>> rooms;
  for (std::size_t i = 0; i < demo.building.rooms.size(); ++i)
    if (!demo.building.rooms[i].corridor)
      rooms.emplace_back(-smoke.extinction_at(centroid(demo.building.outline(static_cast<int>(i)))),
                         static_cast<int>(i));
  std::sort(rooms.begin(), rooms.end());
  std::vector<int> order;
  for (const auto& [extinction, room] : rooms) order.push_back(room);
  return order;
}

struct Tally {
  int missions = 0, reached = 0, refused = 0, waiting = 0, wrong = 0, bumps = 0, occupied = 0, free = 0;
};

}  // namespace

int main(int argc, char** argv) {
  int seeds = 6, first = 1, rooms = 3;
  bool trace = false;
  std::string pictures, only;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--trace") == 0) trace = true;
    if (std::strcmp(argv[i], "--seeds") == 0 && i + 1 < argc) seeds = std::atoi(argv[++i]);
    if (std::strcmp(argv[i], "--first") == 0 && i + 1 < argc) first = std::atoi(argv[++i]);
    if (std::strcmp(argv[i], "--rooms") == 0 && i + 1 < argc) rooms = std::atoi(argv[++i]);
    if (std::strcmp(argv[i], "--room") == 0 && i + 1 < argc) only = argv[++i];
    if (std::strcmp(argv[i], "--pictures") == 0 && i + 1 < argc) pictures = argv[++i];
  }
  std::printf(
      "seed room      smoke 1/m  goal       after s  error m  pose m  bumps  false wall: clear smoke  false free  CPU "
      "s  "
      "reason\n");
  Tally tally;
  for (int seed = first; seed < first + seeds; ++seed) {
    auto demo = make_demo(static_cast<std::uint64_t>(seed));
    if (!demo) continue;
    const auto order = smoky_rooms(*demo);
    int tried = 0;
    for (const int room : order) {
      const std::string& name = demo->building.rooms[static_cast<std::size_t>(room)].name;
      if (only.empty() ? tried++ >= rooms : name != only) continue;
      demo->p_world_far_room = centroid(demo->building.outline(room));
      demo->far_room_px = demo->picture.to_pixels(demo->plan.warp(demo->p_world_far_room));
      test::MissionParams params;
      params.smoke_spreads = true;
      if (trace)
        params.every_second = [](const SessionCore& core, double t) {
          const Snapshot s = core.snapshot(0);
          if (s.robots.empty()) return;
          const RobotStatus& robot = s.robots.front();
          std::printf("  %5.0f  %6.2f %6.2f  %s  %s | %s\n", t, robot.T_map_robot.x(), robot.T_map_robot.y(),
                      s.goals.empty() ? "-" : to_string(s.goals.front().goal.state),
                      s.goals.empty() ? "" : s.goals.front().goal.reason.c_str(), robot.note.c_str());
        };
      const std::clock_t begin = std::clock();
      const auto r = test::run_mission(*demo, params);
      const double cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      const FalseCells cells = count_false(*demo, r);
      const bool there = r.goal_error_m < 1.0;
      ++tally.missions;
      tally.reached += r.goal == GoalState::kArrived && there;
      tally.wrong += r.goal == GoalState::kArrived && !there;
      tally.refused += r.goal == GoalState::kRefused || r.goal == GoalState::kFailed;
      tally.waiting += !is_final(r.goal);
      tally.bumps += r.bumps;
      tally.occupied += cells.occupied_smoke + cells.occupied_clear;
      tally.free += cells.free;
      std::printf("%4d %-9s %9.2f  %-9s  %7.1f  %7.2f  %6.2f  %5d  %17d %5d  %10d  %5.1f  %s\n", seed, name.c_str(),
                  r.smoke.extinction_at(demo->p_world_far_room), to_string(r.goal), r.time_s, r.goal_error_m,
                  r.pose_error_m, r.bumps, cells.occupied_clear, cells.occupied_smoke, cells.free, cpu_s,
                  r.reason.c_str());
      std::fflush(stdout);
      if (!pictures.empty()) draw(*demo, r, pictures + "/" + std::to_string(seed) + "_" + name + ".png");
    }
  }
  std::printf(
      "of %d missions: reached %d, refused or given up %d, claimed wrongly %d, still waiting %d, bumps %d, false wall "
      "cells %d, false free cells %d\n",
      tally.missions, tally.reached, tally.refused, tally.wrong, tally.waiting, tally.bumps, tally.occupied,
      tally.free);
}
