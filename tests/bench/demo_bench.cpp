// Missions in simulated time: ./run bench demo [--seeds N] [--first N] [--read] [--data DIR] [--pictures FOLDER]
// The demo's mission over many seeds: the robot explores, then gets a goal on the plan in a room that it never saw.
// --read takes the plan from the picture by the layout reader, as the server does; without it a perfect reader is used.
// --data (the folder with acg/layouts) drives the missions in the buildings that the real plans of the published
// experiments show (Hannover, Dortmund, Oerebro in turn), with a fire, lidar and radar. --pictures draws each merged
// map (confirmed and moved green, unseen blue, missing red, new orange) over the true walls (grey) and the way (thin).
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "core/random.hpp"
#include "layout/read_layout.hpp"
#include "tests/bench/plan_building_figures.hpp"
#include "tests/support/mission.hpp"

namespace {

using namespace smokemap;

/// The robot starts in the middle of some room from which others can be reached.
Result<DemoScenario> mission_in(const bench::RealPlan& plan, const std::string& data, std::uint64_t seed) {
  const auto layout = bench::read_drawing(data + "/" + plan.file, plan.metres_per_pixel);
  if (!layout) return layout.error();
  const auto building = bench::building_of_plan(*layout, seed);
  if (!building) return building.error();
  auto random = random_stream(seed, 6);
  const std::size_t rooms = building->rooms.size(), first = uniform_index(random, rooms);
  for (std::size_t k = 0; k < rooms; ++k) {
    const int room = static_cast<int>((first + k) % rooms);
    const Pose2 start(centroid(building->outline(room)), uniform(random, -kPi, kPi));
    auto demo = make_demo_in(*building, start, seed);
    if (demo) return demo;
  }
  return fail(Errc::kDegenerate, "no room of this building leads to another");
}

cv::Scalar colour_of(WallState state) {
  switch (state) {
    case WallState::kUnseen:
      return {220, 120, 30};
    case WallState::kMissing:
      return {40, 40, 220};
    case WallState::kNew:
      return {0, 140, 255};
    default:
      return {60, 160, 40};
  }
}

void draw(const DemoScenario& demo, const MergedMap& merged, const std::string& path) {
  constexpr double kPixelsPerMetre = 25;
  std::vector<Point2> corners;
  for (const Point2& p : demo.building.corners) corners.push_back(demo.to_map(p));
  Point2 low = corners.front(), high = low;
  for (const Point2& p : corners) low = low.cwiseMin(p), high = high.cwiseMax(p);
  low.array() -= 2, high.array() += 2;
  const auto px = [&](const Point2& p) {
    return cv::Point2d(kPixelsPerMetre * (p.x() - low.x()), kPixelsPerMetre * (high.y() - p.y()));
  };
  const auto size = px({high.x(), low.y()});
  cv::Mat picture(static_cast<int>(size.y), static_cast<int>(size.x), CV_8UC3, cv::Scalar(255, 255, 255));
  for (std::size_t w = 0; w < demo.building.walls.size(); ++w)
    for (const Segment2& s : demo.building.wall_pieces(static_cast<int>(w)))
      cv::line(picture, px(demo.to_map(s.a)), px(demo.to_map(s.b)), cv::Scalar(205, 205, 205), 8);
  for (const MergedWall& w : merged.walls)
    cv::line(picture, px(w.segment_map.a), px(w.segment_map.b), colour_of(w.state), 2, cv::LINE_AA);
  for (std::size_t i = 1; i < merged.trajectory.size(); ++i)
    cv::line(picture, px(merged.trajectory[i - 1].T_map_robot.translation()),
             px(merged.trajectory[i].T_map_robot.translation()), cv::Scalar(120, 120, 120), 1, cv::LINE_AA);
  cv::imwrite(path, picture);
}

struct Tally {
  int missions = 0, reached = 0, refused = 0, wrong = 0, bumps = 0;
};

void fly(const std::string& name, const DemoScenario& demo, const test::MissionParams& params,
         const std::string& pictures, Tally& tally) {
  const std::clock_t begin = std::clock();
  const auto r = test::run_mission(demo, params);
  const bool there = r.goal_error_m < 1.0;
  if (!pictures.empty() && r.merged) draw(demo, *r.merged, pictures + "/" + name + ".png");
  ++tally.missions;
  tally.reached += r.goal == GoalState::kArrived && there;
  tally.wrong += r.goal == GoalState::kArrived && !there;
  tally.refused += r.goal == GoalState::kRefused || r.goal == GoalState::kFailed;
  tally.bumps += r.bumps;
  std::printf("%-14s %-9s  %7.1f  %7.2f  %6.2f -> %.2f m (%.2f, %d of %d)  %19.2f  %5d  %5.1f  %s\n", name.c_str(),
              to_string(r.goal), r.time_s, r.goal_error_m, r.before_median_m, r.after_median_m, r.after_seen_median_m,
              r.seen, r.corners, r.pose_error_m, r.bumps, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC,
              r.reason.c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  int seeds = 20, first = 1;
  bool read = false;
  std::string data, pictures;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--read") == 0) read = true;
    if (std::strcmp(argv[i], "--seeds") == 0 && i + 1 < argc) seeds = std::atoi(argv[++i]);
    if (std::strcmp(argv[i], "--first") == 0 && i + 1 < argc) first = std::atoi(argv[++i]);
    if (std::strcmp(argv[i], "--data") == 0 && i + 1 < argc) data = argv[++i];
    if (std::strcmp(argv[i], "--pictures") == 0 && i + 1 < argc) pictures = argv[++i];
  }
  std::printf(
      "seed           goal       after s  error m  plan corners before -> after (seen, count)   pose m  bumps  CPU s  "
      "reason\n");
  Tally tally;
  for (int seed = first; seed < first + seeds; ++seed) {
    const auto number = static_cast<std::uint64_t>(seed);
    const auto& plans = bench::real_plans();
    const bench::RealPlan& plan = plans[static_cast<std::size_t>(seed) % plans.size()];
    const auto demo = data.empty() ? make_demo(number) : mission_in(plan, data, number);
    const std::string name = (data.empty() ? "" : plan.name + " ") + std::to_string(seed);
    if (!demo) {
      std::printf("%-14s no scenario: %s\n", name.c_str(), demo.error().message.c_str());
      continue;
    }
    test::MissionParams params;
    if (read) {
      LayoutOptions options;
      options.metres_per_pixel = demo->picture.metres_per_pixel;
      auto reading = read_layout(demo->picture.sheet, options);
      if (reading) params.layout = reading->layout;
    }
    fly(name, *demo, params, pictures, tally);
  }
  std::printf(
      "of %d missions: reached %d (place true within 1 m), refused or given up %d, claimed wrongly %d, bumps %d\n",
      tally.missions, tally.reached, tally.refused, tally.wrong, tally.bumps);
}
