#include "tests/bench/acg_score_figures.hpp"

#include <algorithm>
#include <cmath>

#include "acg/corner_links.hpp"
#include "acg/plan_model.hpp"
#include "acg/scan_pieces.hpp"
#include "geometry/angle.hpp"

namespace smokemap::bench {
namespace {

constexpr double kJudged_m = 1.5;     ///< walls shorter than this are not judged missing or new
constexpr double kLinked_m = 0.25;    ///< from a crossing to where the plan's corner shows its own
constexpr double kJudgedReach_m = 8;  ///< corners farther from the robot need not be linked

double share_of(double part, double all) { return all > 0 ? std::min(1.0, part / all) : 1; }

bool well_seen(const DemoScenario& demo, const RecordedRun& run, std::size_t corner, double radius_m, int least) {
  int echoes = 0;
  for (std::size_t w = 0; w < demo.truth.layout.walls.size(); ++w)
    if (demo.truth.wall_source[w] >= 0)
      echoes += run.witness.echoes_near(static_cast<int>(w), demo.truth.corner_world[corner], radius_m);
  return echoes >= least;
}

bool of_a_true_wall(const DemoScenario& demo, std::size_t corner) {
  for (std::size_t w = 0; w < demo.truth.layout.walls.size(); ++w) {
    const LayoutWall& wall = demo.truth.layout.walls[w];
    const bool touches = wall.corner_a == static_cast<int>(corner) || wall.corner_b == static_cast<int>(corner);
    if (touches && demo.truth.wall_source[w] >= 0) return true;
  }
  return false;
}

void score_corners(const AcgTruth& truth, const MergedMap& merged, AcgScore& out) {
  const DemoScenario& demo = truth.demo;
  const RecordedRun& run = truth.run;
  const PlanStart& start = truth.start;
  std::vector<double> before, after, never_before, never;
  double within = 0, never_within = 0;
  const PixelFrame frame = demo.truth.layout.frame();
  for (std::size_t i = 0; i < merged.corners.size(); ++i) {
    if (!of_a_true_wall(demo, i)) continue;
    const Point2 p_true = demo.to_map(demo.truth.corner_world[i]);
    const Point2 rigid = start.T_layout_robot.inverse() * frame.to_metres(demo.truth.layout.corners[i].p_px);
    const double error = (merged.corners[i].p_map - p_true).norm();
    const bool inside = error <= 2 * merged.corners[i].sigma_m;
    if (well_seen(demo, run, i, 0.6, 16)) {
      before.push_back((rigid - p_true).norm());
      after.push_back(error);
      within += inside;
    } else if (!well_seen(demo, run, i, 1.0, 1)) {
      never_before.push_back((rigid - p_true).norm());
      never.push_back(error);
      never_within += inside;
    }
  }
  out.before_m = median_of(before), out.seen_m = median_of(after);
  out.never_before_m = median_of(never_before), out.never_m = median_of(never);
  out.never = static_cast<int>(never.size());
  out.within_seen = share_of(within, static_cast<double>(after.size()));
  out.within_never = share_of(never_within, static_cast<double>(never.size()));
}

/// The free sectors of the plan's true corners, where these truly are.
std::vector<CornerSector> true_sectors(const DemoScenario& demo) {
  const auto plan = make_plan_model(demo.truth.layout, {});
  GraphState truth;
  if (!plan) return {};
  for (const Point2& p : demo.truth.corner_world) truth.corners.push_back({demo.to_map(p).x(), demo.to_map(p).y()});
  std::vector<CornerSector> out;
  for (const CornerSector& s : corner_sectors(*plan, truth))
    if (demo.truth.wall_source[static_cast<std::size_t>(s.wall_a)] >= 0 &&
        demo.truth.wall_source[static_cast<std::size_t>(s.wall_b)] >= 0)
      out.push_back(s);
  return out;
}

/// Whether a seen crossing truly is a corner of the plan: there, and as open in the same direction. What a door jamb or
/// a cupboard beside a corner shows is none.
bool is_sector(const CornerSector& sector, const DemoScenario& demo, const Pose2& pose, const Corner& seen) {
  const Point2 corner = demo.to_map(demo.truth.corner_world[static_cast<std::size_t>(sector.corner)]);
  return (corner - sector.offset_map - pose * seen.position).norm() < kLinked_m &&
         std::abs(wrap_angle(sector.orientation_rad - seen.orientation_rad - pose.heading())) < kPi / 4 &&
         std::abs(sector.opening_rad - seen.opening_rad) < kPi / 4;
}

/// A link is right when the corner truly lies behind the seen crossing: within a wall's thickness and some. Found are
/// those of the crossings seen, by the nodes that are asked, that truly are a corner of the plan.
void score_links(const AcgTruth& truth, const MergedMap& merged, AcgScore& out) {
  const DemoScenario& demo = truth.demo;
  const AcgParams params;
  const std::vector<CornerSector> sectors = true_sectors(demo);
  double kept = 0, right = 0, seen = 0, found = 0;
  std::vector<Point2> right_places;
  for (const MapLink& link : merged.links) {
    if (link.state != LinkState::kKept) continue;
    const auto c = static_cast<std::size_t>(link.layout_corner);
    const bool good = of_a_true_wall(demo, c) && (link.p_map - demo.to_map(demo.truth.corner_world[c])).norm() < 0.40;
    ++kept, right += good;
    if (good) right_places.push_back(link.p_map);
  }
  Pose2 asked;
  for (std::size_t i = 0; i < truth.graph.nodes.size(); ++i) {
    const Pose2 pose = merged.trajectory[i].T_map_robot, step = asked.inverse() * pose;
    if (i > 0 && step.translation().norm() < params.node_spacing_m && std::abs(step.heading()) < 0.35) continue;
    asked = pose;
    for (const Corner& c : view_of(truth.graph.nodes[i], params).corners) {
      const Point2 p = pose * c.position;
      if (c.position.norm() > kJudgedReach_m ||
          std::none_of(sectors.begin(), sectors.end(), [&](const auto& s) { return is_sector(s, demo, pose, c); }))
        continue;
      ++seen;
      found +=
          std::any_of(right_places.begin(), right_places.end(), [&](const Point2& q) { return (q - p).norm() < 1e-6; });
    }
  }
  out.links_right = share_of(right, kept), out.links_found = share_of(found, seen);
}

double beside_m(const Segment2& s, const std::vector<Segment2>& others) {
  double near = 0;
  for (double t = 0.05; t < s.length(); t += 0.1) {
    const Point2 p = s.a + t * s.direction();
    near +=
        std::any_of(others.begin(), others.end(), [&](const Segment2& o) { return distance(o, p) < 0.3; }) ? 0.1 : 0;
  }
  return near;
}

void score_walls(const DemoScenario& demo, const RecordedRun& run, const MergedMap& merged, AcgScore& out) {
  double called = 0, right = 0, phantoms = 0, found = 0;
  std::vector<Segment2> new_walls, unplanned;
  for (const MergedWall& w : merged.walls) {
    if (w.state == WallState::kNew) new_walls.push_back(w.segment_map);
    if (!w.layout_wall) continue;
    if (demo.truth.layout.wall_m(*w.layout_wall).length() < kJudged_m) continue;
    const bool phantom = demo.truth.wall_source[static_cast<std::size_t>(*w.layout_wall)] < 0;
    const bool missing = w.state == WallState::kMissing;
    called += missing, right += missing && phantom;
    if (!phantom || run.witness.crossed(*w.layout_wall, 8) < 0.5) continue;
    ++phantoms, found += missing;
  }
  out.missing_right = share_of(right, called), out.missing_found = share_of(found, phantoms);
  double seen = 0, covered = 0, drawn = 0, true_new = 0;
  const int first = static_cast<int>(demo.truth.layout.walls.size());
  for (std::size_t k = 0; k < run.unplanned.size(); ++k)
    unplanned.push_back({demo.to_map(run.unplanned[k].a), demo.to_map(run.unplanned[k].b)});
  for (std::size_t k = 0; k < run.unplanned.size(); ++k)
    for (const Segment2& part : run.witness.seen_parts(first + static_cast<int>(k), 8)) {
      if (part.length() < kJudged_m) continue;
      seen += part.length();
      covered += beside_m({demo.to_map(part.a), demo.to_map(part.b)}, new_walls);
    }
  for (const Segment2& s : new_walls)
    if (s.length() >= kJudged_m) drawn += s.length(), true_new += beside_m(s, unplanned);
  out.new_right = share_of(true_new, drawn), out.new_found = share_of(covered, seen);
}

void score_poses(const PoseGraph& graph, const RecordedRun& run, const MergedMap& merged, AcgScore& out) {
  double square = 0, turn = 0, before = 0;
  const Pose2 T_first = graph.nodes.front().T_odom_robot.inverse();
  std::size_t k = 0, count = 0;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    while (k + 1 < run.truth.size() && run.truth[k].stamp < graph.nodes[i].stamp) ++k;
    const Pose2 error = run.truth[k].T_map_robot.inverse() * merged.trajectory[i].T_map_robot;
    before +=
        (run.truth[k].T_map_robot.translation() - (T_first * graph.nodes[i].T_odom_robot).translation()).squaredNorm();
    square += error.translation().squaredNorm(), turn += error.heading() * error.heading(), ++count;
  }
  const double nodes = std::max(1.0, static_cast<double>(count));
  out.pose_m = std::sqrt(square / nodes);
  out.pose_before_m = std::sqrt(before / nodes);
  out.yaw_rad = std::sqrt(turn / nodes);
}

}  // namespace

void score_merged(const AcgTruth& truth, const MergedMap& merged, AcgScore& out) {
  score_poses(truth.graph, truth.run, merged, out);
  score_corners(truth, merged, out);
  score_links(truth, merged, out);
  score_walls(truth.demo, truth.run, merged, out);
  out.fit = merged.fit.score;
  out.success = out.pose_m < 0.3 && out.seen_m < 0.15;
}

/// A wall of 1.5 m or more that truly is there, by how its direction differs from that of the drawing, laid down
/// rightly.
struct WallTurn {
  const MergedWall* wall;
  double by_drawing_rad, by_truth_rad;
};

TurnedWall most_turned(const DemoScenario& demo, const MergedMap& merged) {
  std::vector<WallTurn> turns;
  std::vector<double> all;
  const auto line_turn = [](double rad) { return 0.5 * wrap_angle(2 * rad); };
  for (const MergedWall& w : merged.walls) {
    if (!w.layout_wall || w.segment_map.length() < 1.5) continue;
    const int source = demo.truth.wall_source[static_cast<std::size_t>(*w.layout_wall)];
    if (source < 0) continue;
    const double heading = w.segment_map.heading();
    const double drawn = demo.truth.layout.wall_m(*w.layout_wall).heading() - demo.true_start.heading_rad;
    const double truth = demo.building.wall_line(source).heading() - demo.T_world_start.heading();
    turns.push_back({&w, line_turn(heading - drawn), line_turn(heading - truth)});
    all.push_back(turns.back().by_drawing_rad);
  }
  TurnedWall worst;
  worst.plan_turned_deg = median_of(all) * 180 / kPi;
  for (const WallTurn& t : turns) {
    // Corners are drawn 5 cm off, which turns a wall of two metres by two degrees already: bent is what lies neither as
    // it truly does nor as it is drawn in the plan as this lies now, nor in between.
    const double by_truth = t.by_truth_rad, by_drawing = t.by_drawing_rad - median_of(all);
    const double bent = by_truth * by_drawing < 0 ? 0 : std::min(std::abs(by_truth), std::abs(by_drawing)) * 180 / kPi;
    if (bent <= worst.turned_deg) continue;
    worst.turned_deg = bent, worst.layout_wall = *t.wall->layout_wall;
    worst.length_m = t.wall->segment_map.length(), worst.state = t.wall->state;
  }
  return worst;
}

}  // namespace smokemap::bench
