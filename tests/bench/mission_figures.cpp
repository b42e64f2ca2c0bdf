#include "tests/bench/mission_figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/random.hpp"
#include "layout/read_layout.hpp"
#include "navigation/cost_map.hpp"
#include "simulation/path_driver.hpp"
#include "tests/bench/bench_options.hpp"

namespace smokemap::bench {
namespace {

constexpr double kSmoke = 0.3;     // 1/m: visibility of about 10 m
constexpr double kBesideM = 0.30;  // a cell this near to a wall may be called occupied
constexpr double kGrazeM = 0.10;   // the edge of what is seen is as sharp as this
constexpr double kThereM = 1.0;
constexpr double kFarM = 4.0;  // a goal nearer to the start is none
constexpr double kPictureCellM = 0.025;
constexpr double kSpreadS = 60;
constexpr const char* kNoReason = "(no reason given)";
constexpr double kHoleM = 0.25;  // around a place on a wall
constexpr double kMostlyKnown = 0.6;
constexpr int kOccupied = 60, kFree = 40;

double median_of_all(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

bool is_free(int percent) { return percent >= 0 && percent <= kFree; }

/// Hidden, by more than cells and poses are wrong by, from everywhere that the robot was. A beam that grazes an edge
/// clears cells whose middle lies behind it, and a map that is off by 15 cm shows the edge of a view there.
bool falsely_free(const DemoScenario& demo, const test::MissionResult& r, const Point2& p_world) {
  if (demo.world.walls.clearance_m(p_world, 1.0) < kBesideM) return false;
  const auto seen = [&](const Point2& p) {
    return std::any_of(r.way_world.begin(), r.way_world.end(),
                       [&](const Point2& from) { return demo.world.walls.sees(from, p); });
  };
  if (seen(p_world)) return false;
  const double graze_m = kGrazeM + r.pose_error_m;
  for (int i = 0; i < 8; ++i)
    if (seen(p_world + graze_m * Point2(std::cos(i * kPi / 4), std::sin(i * kPi / 4)))) return false;
  return true;
}

/// All that is known around this place is free.
bool called_free(const OccupancyGrid& sensed, const Point2& p_map) {
  const GridFrame& frame = sensed.frame();
  const Cell center = frame.cell_of(p_map);
  const int reach = static_cast<int>(kHoleM / frame.resolution_m);
  int known = 0, all = 0;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const Cell cell{center.x + dx, center.y + dy};
      if (dx * dx + dy * dy > reach * reach) continue;
      const int percent = frame.contains(cell) ? sensed.at(cell) : -1;
      if (percent > kFree) return false;
      ++all, known += percent >= 0;
    }
  return known > kMostlyKnown * all;
}

double open_wall_m(const DemoScenario& demo, const OccupancyGrid& sensed) {
  constexpr double kStepM = 0.05;
  double sum_m = 0;
  for (const WorldSegment& s : demo.world.walls.segments())
    for (double t = 0.5 * kStepM; t < s.line.length(); t += kStepM)
      if (called_free(sensed, demo.to_map(s.line.a + t * s.line.direction()))) sum_m += kStepM;
  return sum_m;
}

/// The whole building in map frame.
GridFrame picture_frame(const DemoScenario& demo) {
  Point2 low = demo.to_map(demo.building.corners.front()), high = low;
  for (const Point2& p : demo.building.corners)
    low = low.cwiseMin(demo.to_map(p)), high = high.cwiseMax(demo.to_map(p));
  return frame_around(low, high, kPictureCellM, 1.0);
}

/// Draws on the sensed map, and on what the planner makes of the places nobody saw.
class MapPicture {
 public:
  MapPicture(const DemoScenario& demo, const test::MissionParams& params, const test::MissionResult& r)
      : demo_(demo), frame_(picture_frame(demo)), picture_(frame_.height_cells, frame_.width_cells, CV_8UC3) {
    const LayoutMap& layout = params.layout ? *params.layout : demo.truth.layout;
    const auto ground = build_cost_map(*r.merged, *r.sensed, &layout, CostMapParams{});
    for (int y = 0; y < picture_.rows; ++y)
      for (int x = 0; x < picture_.cols; ++x)
        picture_.at<cv::Vec3b>(y, x) =
            colour_at(r, ground ? &*ground : nullptr, frame_.center_of({x, frame_.height_cells - 1 - y}));
  }
  void add_walls(const MergedMap& merged) {
    for (const WorldSegment& s : demo_.world.walls.segments())
      line(demo_.to_map(s.line.a), demo_.to_map(s.line.b), {0, 0, 0}, 1);
    for (const MergedWall& w : merged.walls) line(w.segment_map.a, w.segment_map.b, colour_of(w.state), 2);
  }
  void add_way(const test::MissionResult& r) {
    for (std::size_t i = 1; i < r.way_world.size(); ++i)
      line(demo_.to_map(r.way_world[i - 1]), demo_.to_map(r.way_world[i]), {120, 120, 120}, 1);
    for (const test::Bump& bump : r.bumped)
      cv::drawMarker(picture_, px(demo_.to_map(bump.T_world_robot.translation())), {0, 0, 255}, cv::MARKER_TILTED_CROSS,
                     16, 3);
    cv::circle(picture_, px(demo_.to_map(demo_.p_world_far_room)), 6, {200, 0, 200}, 2);
  }
  void save(const std::string& path) const { cv::imwrite(path, picture_); }

 private:
  static cv::Scalar colour_of(WallState state) {
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
  cv::Vec3b colour_at(const test::MissionResult& r, const CostMap* ground, const Point2& p_map) const {
    const Cell cell = r.sensed->frame().cell_of(p_map);
    const int percent = r.sensed->frame().contains(cell) ? r.sensed->at(cell) : -1;
    const Point2 p_world = demo_.T_world_start * p_map;
    if (is_free(percent) && falsely_free(demo_, r, p_world)) return {255, 0, 255};
    if (percent < 0)
      return ground && ground->ground(ground->frame().cell_of(p_map)) == Ground::kPlanned ? cv::Vec3b(225, 210, 190)
                                                                                          : cv::Vec3b(190, 190, 190);
    const int grey = 255 - percent * 255 / 100;
    const int smoke = std::min(120, static_cast<int>(60 * r.smoke.extinction_at(p_world)));
    return {static_cast<std::uint8_t>(std::max(0, grey - smoke)),
            static_cast<std::uint8_t>(std::max(0, grey - smoke / 2)), static_cast<std::uint8_t>(grey)};
  }
  cv::Point2d px(const Point2& p_map) const {
    const Point2 p = (p_map - frame_.origin) / frame_.resolution_m;
    return {p.x(), frame_.height_cells - p.y()};
  }
  void line(const Point2& a_map, const Point2& b_map, const cv::Scalar& colour, int width) {
    cv::line(picture_, px(a_map), px(b_map), colour, width, cv::LINE_AA);
  }

  const DemoScenario& demo_;
  GridFrame frame_;
  cv::Mat picture_;
};

/// Gives it one, with the thinnest smoke there is, if the chosen one is where the robot starts.
bool has_far_goal(DemoScenario& demo) {
  if ((demo.p_world_far_room - demo.T_world_start.translation()).norm() >= kFarM) return true;
  const std::vector<int> rooms = smoky_rooms(demo);
  return !rooms.empty() && send_to(demo, rooms.back());
}

void print_second(const SessionCore& core, double t_s) {
  const Snapshot s = core.snapshot(0);
  if (s.robots.empty()) return;
  const RobotStatus& robot = s.robots.front();
  std::printf("  %5.0f  %6.2f %6.2f %5.2f  %s  %s | %s\n", t_s, robot.T_map_robot.x(), robot.T_map_robot.y(),
              robot.T_map_robot.heading(), s.goals.empty() ? "-" : to_string(s.goals.front().goal.state),
              s.goals.empty() ? "" : s.goals.front().goal.reason.c_str(), robot.note.c_str());
}

}  // namespace

MissionOptions mission_options(int argc, char** argv, int seeds, const std::string& about) {
  MissionOptions o;
  o.seeds = seeds;
  BenchOptions(about)
      .number("--seeds", o.seeds, "how many")
      .number("--first", o.first, "seed")
      .number("--rooms", o.rooms, "of each building (smoke)")
      .text("--room", o.room, "only this one (smoke)")
      .text("--data", o.data, "folder of data sets (missions)")
      .text("--pictures", o.pictures, "folder for a picture of each mission")
      .flag("--read", o.read, "the plan as the layout reader reads its picture")
      .flag("--trace", o.trace, "a line a second")
      .read(argc, argv);
  return o;
}

std::vector<int> smoky_rooms(const DemoScenario& demo) {
  SmokeField smoke = demo.world.smoke;
  smoke.advance(kSpreadS);
  std::vector<std::pair<double, int>> rooms;
  for (std::size_t i = 0; i < demo.building.rooms.size(); ++i) {
    const Polygon ring = demo.building.outline(static_cast<int>(i));
    if (demo.building.rooms[i].corridor || (centroid(ring) - demo.T_world_start.translation()).norm() < kFarM) continue;
    if (!PathDriver(demo.world.walls).plan(demo.T_world_start.translation(), centroid(ring))) continue;
    rooms.emplace_back(-smoke.extinction_at(centroid(ring)), static_cast<int>(i));
  }
  std::sort(rooms.begin(), rooms.end());
  std::vector<int> order;
  for (const auto& [extinction, room] : rooms) order.push_back(room);
  return order;
}

bool send_to(DemoScenario& demo, int room) {
  const auto way =
      PathDriver(demo.world.walls).plan(demo.T_world_start.translation(), centroid(demo.building.outline(room)));
  if (!way) return false;
  demo.far_room = demo.building.rooms[static_cast<std::size_t>(room)].name;
  demo.p_world_far_room = way->back();
  demo.far_room_px = demo.picture.to_pixels(demo.plan.warp(demo.p_world_far_room));
  return true;
}

Result<DemoScenario> mission_in(const RealPlan& plan, const std::string& data, std::uint64_t seed) {
  const auto layout = read_drawing(data + "/" + plan.file, plan.metres_per_pixel);
  if (!layout) return layout.error();
  const auto building = building_of_plan(*layout, seed);
  if (!building) return building.error();
  auto random = random_stream(seed, 6);
  const std::size_t rooms = building->rooms.size(), first = uniform_index(random, rooms);
  const double heading = uniform(random, -kPi, kPi);
  Result<DemoScenario> clearest = fail(Errc::kDegenerate, "no room of this building leads to another");
  double least_smoke = std::numeric_limits<double>::infinity();
  DemoParams params;
  for (const double burning_s : {240.0, 120.0, 60.0, 30.0})  // a small house is full of smoke sooner
    for (std::size_t k = 0; k < rooms; ++k) {
      const int room = static_cast<int>((first + k) % rooms);
      const Pose2 start(centroid(building->outline(room)), heading);
      params.burning_s = burning_s;
      auto demo = make_demo_in(*building, start, seed, params);
      if (!demo || !has_far_goal(*demo)) continue;
      const double smoke = demo->world.smoke.extinction_at(start.translation());
      if (smoke < kSmoke) return demo;
      if (smoke < least_smoke) least_smoke = smoke, clearest = std::move(demo);
    }
  return clearest;
}

FalseCells count_false(const DemoScenario& demo, const test::MissionResult& r) {
  FalseCells count;
  if (!r.sensed || r.sensed->empty()) return count;
  const GridFrame& frame = r.sensed->frame();
  Cell cell;
  for (cell.y = 0; cell.y < frame.height_cells; ++cell.y)
    for (cell.x = 0; cell.x < frame.width_cells; ++cell.x) {
      const int percent = r.sensed->at(cell);
      if (percent < 0) continue;
      const Point2 p = demo.T_world_start * frame.center_of(cell);
      if (percent >= kOccupied && demo.world.walls.clearance_m(p, 1.0) > kBesideM)
        ++(r.smoke.extinction_at(p) > kSmoke ? count.occupied_smoke : count.occupied_clear);
      count.free += is_free(percent) && falsely_free(demo, r, p);
    }
  count.wall_free_m = open_wall_m(demo, *r.sensed);
  return count;
}

void MissionTable::print_head() const {
  std::printf(
      "mission        room       smoke 1/m  goal       after s  error m  pose m said  bumps  plan corners before -> "
      "after  "
      "false wall: clear smoke  false free  wall free m  CPU s  reason\n");
}

void MissionTable::fly(const std::string& name, const DemoScenario& demo, test::MissionParams params) {
  if (options_.read) {
    LayoutOptions options;
    options.metres_per_pixel = demo.picture.metres_per_pixel;
    auto reading = read_layout(demo.picture.sheet, options);
    if (reading) params.layout = reading->layout;
  }
  if (options_.trace) params.every_second = print_second;
  const std::clock_t begin = std::clock();
  const auto r = test::run_mission(demo, params);
  const double cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const FalseCells cells = count_false(demo, r);
  const bool there = r.goal_error_m < kThereM;
  ++missions_;
  reached_ += r.goal == GoalState::kArrived && there;
  wrong_ += r.goal == GoalState::kArrived && !there;
  refused_ += r.goal == GoalState::kRefused || r.goal == GoalState::kFailed;
  waiting_ += !is_final(r.goal);
  bumps_ += r.bumps;
  false_walls_ += cells.occupied_clear + cells.occupied_smoke;
  false_free_ += cells.free;
  wall_free_m_ += cells.wall_free_m;
  pose_errors_m_.push_back(r.pose_error_m);
  within_two_sigma_ += r.pose_error_m <= 2 * r.pose_sigma_m;
  cpu_s_.push_back(cpu_s);
  if (r.goal != GoalState::kArrived) ++reasons_[r.reason.empty() ? kNoReason : r.reason];
  std::printf(
      "%-14s %-10s %9.2f  %-9s  %7.1f  %7.2f  %6.2f %4.2f  %5d  %17.2f -> %5.2f  %16d %5d  %10d  %11.2f  %5.1f  %s\n",
      name.c_str(), demo.far_room.c_str(), r.smoke.extinction_at(demo.p_world_far_room), to_string(r.goal), r.time_s,
      r.goal_error_m, r.pose_error_m, r.pose_sigma_m, r.bumps, r.before_median_m, r.after_median_m,
      cells.occupied_clear, cells.occupied_smoke, cells.free, cells.wall_free_m, cpu_s, r.reason.c_str());
  for (const test::Bump& bump : r.bumped)
    std::printf("  bump after %.1f s at %.2f %.2f, heading %.2f (world)\n", bump.time_s, bump.T_world_robot.x(),
                bump.T_world_robot.y(), bump.T_world_robot.heading());
  std::fflush(stdout);
  if (options_.pictures.empty() || !r.merged || !r.sensed || r.sensed->empty()) return;
  MapPicture picture(demo, params, r);
  picture.add_walls(*r.merged);
  picture.add_way(r);
  std::string file = name + "_" + demo.far_room;
  std::replace(file.begin(), file.end(), ' ', '_');
  picture.save(options_.pictures + "/" + file + ".png");
}

void MissionTable::print_summary() const {
  std::printf(
      "of %d missions: reached %d (place true within 1 m), refused or given up %d, claimed wrongly %d, still waiting "
      "%d, bumps %d; pose error %.2f m (worst %.2f; %d within 2 of the sigmas said), CPU %.1f s (worst %.1f), false "
      "wall cells %d, false free cells "
      "%d, walls called free %.2f m\n",
      missions_, reached_, refused_, wrong_, waiting_, bumps_, median_of_all(pose_errors_m_),
      pose_errors_m_.empty() ? 0 : *std::max_element(pose_errors_m_.begin(), pose_errors_m_.end()), within_two_sigma_,
      median_of_all(cpu_s_), cpu_s_.empty() ? 0 : *std::max_element(cpu_s_.begin(), cpu_s_.end()), false_walls_,
      false_free_, wall_free_m_);
  for (const auto& [reason, count] : reasons_) std::printf("%4d  %s\n", count, reason.c_str());
}

bool MissionTable::faultless() const {
  return wrong_ == 0 && waiting_ == 0 && bumps_ == 0 && !reasons_.contains(kNoReason);
}

}  // namespace smokemap::bench
