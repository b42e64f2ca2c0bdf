#include "app/simulate_files.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace smokemap::app {
namespace {

using nlohmann::json;

constexpr int kWellSeen = 8;  ///< echoes in 15 cm of wall, or beams through it

double rounded(double v) { return std::round(v * 1e5) / 1e5; }
json point(const Point2& p) { return {rounded(p.x()), rounded(p.y())}; }

/// Sorts the layout's corners by what they are and by what the robot could know about them.
class CornerJudge {
 public:
  CornerJudge(const DemoScenario& demo, const RecordedRun& run) : demo_(demo), run_(run) {}

  std::string kind(int corner) const {
    bool real = false;
    for (std::size_t i = 0; i < walls().size(); ++i)
      real = real || (touches(i, corner) && demo_.truth.wall_source[i] >= 0);
    if (!real) return "phantom";
    if (static_cast<std::size_t>(corner) >= demo_.plan.drawn.corners.size()) return "jamb";
    return demo_.truth.layout.corners[static_cast<std::size_t>(corner)].degree == 1 ? "end" : "junction";
  }

  /// yes: two wall directions seen within 0.6 m (or the end of the wall that ends there); no: no echo within 1 m.
  std::string seen(int corner) const {
    const Point2& p = demo_.truth.corner_world[static_cast<std::size_t>(corner)];
    std::vector<double> directions;
    int echoes = 0, ends = 0;
    for (std::size_t i = 0; i < walls().size(); ++i) {
      if (demo_.truth.wall_source[i] < 0) continue;
      echoes += run_.witness.echoes_near(static_cast<int>(i), p, 1.0);
      if (!touches(i, corner)) continue;
      ++ends;
      const double heading = demo_.building.wall_line(demo_.truth.wall_source[i]).heading();
      bool known = run_.witness.echoes_near(static_cast<int>(i), p, 0.6) < kWellSeen;
      for (const double other : directions) known = known || line_angle_between(heading, other) < 0.3;
      if (!known) directions.push_back(heading);
    }
    if (echoes == 0) return "no";
    return directions.size() >= 2 || (ends == 1 && directions.size() == 1) ? "yes" : "part";
  }

 private:
  const std::vector<LayoutWall>& walls() const { return demo_.truth.layout.walls; }
  bool touches(std::size_t wall, int corner) const {
    return walls()[wall].corner_a == corner || walls()[wall].corner_b == corner;
  }

  const DemoScenario& demo_;
  const RecordedRun& run_;
};

json wall_truth(const DemoScenario& demo, const RecordedRun& run) {
  json walls = json::array();
  for (std::size_t i = 0; i < demo.truth.layout.walls.size(); ++i) {
    const LayoutWall& wall = demo.truth.layout.walls[i];
    const auto index = static_cast<int>(i);
    const bool exists = demo.truth.wall_source[i] >= 0;
    const auto share = [&](int least) {
      return rounded(exists ? run.witness.seen(index, least) : run.witness.crossed(index, least));
    };
    walls.push_back({{"exists", exists},
                     {"a", point(demo.to_map(demo.truth.corner_world[static_cast<std::size_t>(wall.corner_a)]))},
                     {"b", point(demo.to_map(demo.truth.corner_world[static_cast<std::size_t>(wall.corner_b)]))},
                     {"seen", share(kWellSeen)},
                     {"touched", share(1)},
                     {"parent", demo.truth.wall_source[i]}});
  }
  return walls;
}

json unplanned_truth(const DemoScenario& demo, const RecordedRun& run) {
  json walls = json::array();
  for (std::size_t i = 0; i < run.unplanned.size(); ++i) {
    const auto index = static_cast<int>(demo.truth.layout.walls.size() + i);
    json parts = json::array();
    for (const Segment2& part : run.witness.seen_parts(index, kWellSeen))
      parts.push_back({point(demo.to_map(part.a)), point(demo.to_map(part.b))});
    walls.push_back({{"a", point(demo.to_map(run.unplanned[i].a))},
                     {"b", point(demo.to_map(run.unplanned[i].b))},
                     {"seen", rounded(run.witness.seen(index, kWellSeen))},
                     {"seen_parts", parts}});
  }
  return walls;
}

json point_truth(const DemoScenario& demo, const RecordedRun& run) {
  json points = json::array();
  for (std::size_t i = 0; i < demo.building.rooms.size(); ++i) {
    const Point2 p = centroid(demo.building.outline(static_cast<int>(i)));
    if (demo.building.room_at(p) != static_cast<int>(i)) continue;
    points.push_back({{"layout_px", point(demo.picture.to_pixels(demo.plan.warp(p)))},
                      {"map", point(demo.to_map(p))},
                      {"near_wall", false},
                      {"visited", static_cast<bool>(run.visited[i])},
                      {"room", demo.building.rooms[i].name}});
  }
  return points;
}

json poses_json(const Trajectory& trajectory) {
  json poses = json::array();
  for (const StampedPose& pose : trajectory)
    poses.push_back({to_seconds(pose.stamp), rounded(pose.T_map_robot.x()), rounded(pose.T_map_robot.y()),
                     rounded(pose.T_map_robot.heading())});
  return poses;
}

json start_json(const StartHint& start) {
  return {{"layout_px", point(start.layout_px)}, {"heading_rad", rounded(start.heading_rad)}};
}

void append_ranges(const LaserScan& scan, std::string& text) {
  char number[32];
  for (const float range : scan.ranges_m) {
    const bool hit = std::isfinite(range) && range > 0 && range <= scan.range_max_m;
    std::snprintf(number, sizeof number, " %.3f", hit ? static_cast<double>(range) : scan.range_max_m);
    text += number;
  }
}

}  // namespace

std::string truth_json(const DemoScenario& demo, const RecordedRun& run) {
  json corners = json::array(), building = json::array(), doors = json::array(), closed = json::array();
  const CornerJudge judge(demo, run);
  for (std::size_t i = 0; i < demo.truth.corner_world.size(); ++i) {
    const std::string kind = judge.kind(static_cast<int>(i));
    corners.push_back({{"layout_px", point(demo.truth.layout.corners[i].p_px)},
                       {"map", point(demo.to_map(demo.truth.corner_world[i]))},
                       {"kind", kind},
                       {"seen", kind == "phantom" ? "no" : judge.seen(static_cast<int>(i))}});
  }
  for (std::size_t i = 0; i < demo.building.walls.size(); ++i)
    for (const Segment2& piece : demo.building.wall_pieces(static_cast<int>(i)))
      building.push_back(
          {point(demo.to_map(piece.a)), point(demo.to_map(piece.b)), demo.building.walls[i].thickness_m});
  for (std::size_t i = 0; i < demo.building.doors.size(); ++i) {
    const Segment2 gap = demo.building.door_gap(static_cast<int>(i));
    const json line{point(demo.to_map(gap.a)), point(demo.to_map(gap.b))};
    doors.push_back(line);
    if (demo.building.doors[i].has_leaf && demo.building.doors[i].open_rad == 0) closed.push_back(line);
  }
  json document{{"seed", demo.seed},
                {"plan", "two wings"},
                {"poses", poses_json(run.truth)},
                {"walls", wall_truth(demo, run)},
                {"unplanned", unplanned_truth(demo, run)},
                {"building", building},
                {"doors", doors},
                {"closed_doors", closed},
                {"corners", corners},
                {"points", point_truth(demo, run)},
                {"start", start_json(demo.true_start)},
                {"fire", point(demo.to_map(demo.p_world_fire))},
                {"goal",
                 {{"room", demo.far_room},
                  {"layout_px", point(demo.far_room_px)},
                  {"map", point(demo.to_map(demo.p_world_far_room))}}},
                {"run", {{"seconds", run.duration_s}, {"way_m", rounded(run.way_m)}, {"bumps", run.bumps}}}};
  for (const auto& [robot, poses] : run.others) document["other_robots"][robot] = poses_json(poses);
  return document.dump() + "\n";
}

std::string anchors_json(const DemoScenario& demo, const DemoParams& params) {
  json start = start_json(demo.start);
  start["sigma_m"] = params.sigma_start_m;
  start["sigma_rad"] = params.sigma_start_rad;
  return json{{"start", start}}.dump() + "\n";
}

std::string points_json(const DemoScenario& demo, const RecordedRun& run) {
  json points = json::array();
  for (const json& p : point_truth(demo, run)) points.push_back(p["layout_px"]);
  return json{{"points", points}}.dump() + "\n";
}

std::string carmen_log(const RecordedRun& run) {
  std::string text;
  std::size_t scan_index = 0;
  char line[256];
  for (const auto& item : run.items) {
    if (const auto* scan = std::get_if<LaserScan>(&item)) {
      if (scan_index == 0) {
        std::snprintf(line, sizeof line, "PARAM robot_front_laser_max %.2f\nPARAM laser_front_laser_fov %.0f\n",
                      scan->range_max_m,
                      degrees(scan->angle_increment_rad * static_cast<double>(scan->ranges_m.size())));
        text += line;
      }
      const Pose2& pose = run.T_odom_scan[scan_index++];
      std::snprintf(line, sizeof line, " %.5f %.5f %.6f %.5f %.5f %.6f %.6f host %.6f\n", pose.x(), pose.y(),
                    pose.heading(), pose.x(), pose.y(), pose.heading(), to_seconds(scan->stamp),
                    to_seconds(scan->stamp));
      text += "FLASER " + std::to_string(scan->ranges_m.size());
      append_ranges(*scan, text);
      text += line;
    } else if (const auto* odometry = std::get_if<Odometry>(&item)) {
      const Pose2& pose = odometry->T_odom_robot;
      std::snprintf(line, sizeof line, "ODOM %.5f %.5f %.6f %.4f %.4f 0 %.6f host %.6f\n", pose.x(), pose.y(),
                    pose.heading(), odometry->speed_mps, odometry->turn_rate_radps, to_seconds(odometry->stamp),
                    to_seconds(odometry->stamp));
      text += line;
    }
  }
  return text;
}

}  // namespace smokemap::app
