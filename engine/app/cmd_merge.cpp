#include <spdlog/spdlog.h>

#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include "acg/auto_complete_graph.hpp"
#include "acg/published_graph.hpp"
#include "app/commands.hpp"
#include "app/map_picture.hpp"
#include "app/merge_files.hpp"
#include "app/merge_preview.hpp"
#include "localization/localize_nodes.hpp"
#include "recording/file_bytes.hpp"
#include "recording/layout_json.hpp"
#include "recording/map_server.hpp"
#include "recording/sensor_log.hpp"
#include "recording/trajectory_tum.hpp"
#include "slam/render_map.hpp"
#include "slam/slam.hpp"

namespace smokemap::app {
namespace {

/// Loops are looked for this often while the log is read.
constexpr std::size_t kOptimizeEveryScans = 20;

struct MergeArguments {
  std::string layout, log, anchors, points, output, trajectory, map, preview, method = "smokemap";
};

/// What was read and worked out, before anything is written.
struct Merging {
  LayoutMap layout;
  Anchors anchors;
  std::vector<Point2> points_px;
  PoseGraph graph;
  Trajectory slam_trajectory;
  MergedMap merged;
};

Result<std::string> read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file || !text) return fail(Errc::kIo, "cannot read " + path);
  return text.str();
}

Result<Ok> read_plan(const MergeArguments& arguments, Merging& work) {
  const auto text = read_text(arguments.layout);
  if (!text) return text.error();
  auto document = layout_from_json(*text);
  if (!document) return document.error();
  work.layout = std::move(document->layout);
  if (!arguments.anchors.empty()) {
    const auto anchors = read_text(arguments.anchors);
    if (!anchors) return anchors.error();
    auto read = anchors_from_json(*anchors, work.layout);
    if (!read) return read.error();
    work.anchors = std::move(*read);
  }
  if (!arguments.points.empty()) {
    const auto points = read_text(arguments.points);
    if (!points) return points.error();
    auto read = points_from_json(*points);
    if (!read) return read.error();
    work.points_px = std::move(*read);
  }
  return Ok{};
}

Result<Ok> run_robot(const std::string& path, Merging& work) {
  const auto log = read_log(path);
  if (!log) return log.error();
  for (const std::string& warning : log->warnings) spdlog::warn("{}", warning);
  Slam slam;
  std::size_t scans = 0;
  for (const LogItem& item : log->items) {
    if (const auto* odometry = std::get_if<Odometry>(&item)) slam.add_odometry(*odometry);
    // What slam refuses it counts itself; the log goes on.
    if (const auto* scan = std::get_if<LaserScan>(&item)) (void)slam.add_scan(*scan).ok();
    if (const auto* sweep = std::get_if<RadarSweep>(&item)) (void)slam.add_sweep(*sweep).ok();
    if (!std::holds_alternative<Odometry>(item) && ++scans % kOptimizeEveryScans == 0) slam.optimize();
  }
  slam.polish();
  work.graph = slam.graph();
  work.slam_trajectory = slam.trajectory();
  if (work.graph.nodes.empty()) return fail(Errc::kDegenerate, path + ": no scan with enough points to make a map of");
  return Ok{};
}

/// The plan laid down by the given start or pairs, its walls followed by Monte-Carlo localisation: what the published
/// programs had.
Result<Ok> merge_published(PublishedMethod method, Merging& work) {
  PublishedInput input;
  input.plan = work.layout;
  input.graph = work.graph;
  const PixelFrame frame = work.layout.frame();
  if (work.anchors.pairs.size() >= 2) {
    std::vector<PointPair> pairs;
    for (const auto& pair : work.anchors.pairs) pairs.push_back({pair.p_map, frame.to_metres(pair.p_layout_px), 0.1});
    const auto fit = fit_similarity(pairs);
    if (!fit) return fit.error();
    input.map_from_layout = *fit;
  } else if (work.anchors.start) {
    input.map_from_layout =
        Similarity2{1, work.graph.nodes.front().T_map_robot * work.anchors.start->T_layout_robot.inverse()};
  } else {
    return fail(Errc::kInvalidArgument, "the published methods need a start or two pairs with --anchors");
  }
  std::vector<LocalizerWall> walls;
  for (std::size_t w = 0; w < work.layout.walls.size(); ++w) {
    const Segment2 s = work.layout.wall_m(static_cast<int>(w));
    walls.push_back({{input.map_from_layout * s.a, input.map_from_layout * s.b},
                     work.layout.walls[w].thickness_px * frame.metres_per_pixel});
  }
  for (const LocalizerEstimate& e : localize_nodes(walls, work.graph, work.graph.nodes.front().T_map_robot)) {
    input.localized.emplace_back();
    if (!e.lost) input.localized.back() = LocalizedNode{e.T_map_robot, e.covariance.topLeftCorner<2, 2>()};
  }
  auto merged = merge_as_published(method, input);
  if (!merged) return merged.error();
  work.merged = std::move(*merged);
  return Ok{};
}

Result<Ok> merge(Merging& work) {
  AutoCompleteGraph acg;
  if (const auto set = acg.set_plan(work.layout, work.anchors.start); !set) return set;
  for (std::size_t i = 0; i < work.anchors.pairs.size(); ++i)
    acg.add_anchor(std::to_string(i), work.anchors.pairs[i].p_layout_px, work.anchors.pairs[i].p_map);
  auto merged = acg.update(work.graph);
  if (!merged) return merged.error();
  if (merged->corners.empty())
    return fail(Errc::kDegenerate,
                "the plan could not be laid on what the robot saw; give a start or two pairs with --anchors");
  work.merged = std::move(*merged);
  return Ok{};
}

std::vector<Pose2> node_poses(const MergedMap& merged) {
  std::vector<Pose2> poses;
  for (const StampedPose& p : merged.trajectory) poses.push_back(p.T_map_robot);
  return poses;
}

Result<Ok> write_answers(const MergeArguments& arguments, const Merging& work) {
  const std::string document = merged_to_json(work.merged, work.layout, work.points_px) + "\n";
  if (const auto written = write_file(arguments.output, document); !written) return written;
  if (!arguments.trajectory.empty()) {
    Trajectory corrected = work.slam_trajectory;
    const std::string robot = work.graph.nodes.empty() ? "" : work.graph.nodes.front().robot;  // a log is of one
    for (StampedPose& p : corrected)
      p.T_map_robot = corrected_pose(work.graph, work.merged, robot, p.stamp, p.T_map_robot);
    if (const auto written = write_tum(corrected, arguments.trajectory); !written) return written;
  }
  if (!arguments.map.empty())
    if (const auto written = write_map(render_map(work.graph, node_poses(work.merged)), arguments.map); !written)
      return written;
  if (arguments.preview.empty()) return Ok{};
  return write_picture(arguments.preview, draw_merged(work.merged, work.graph));
}

Result<Ok> run_merge(const MergeArguments& arguments) {
  Merging work;
  if (const auto read = read_plan(arguments, work); !read) return read;
  if (const auto driven = run_robot(arguments.log, work); !driven) return driven;
  const auto merged = arguments.method == "acg2017"   ? merge_published(PublishedMethod::kAcg2017, work)
                      : arguments.method == "acg2019" ? merge_published(PublishedMethod::kAcg2019, work)
                                                      : merge(work);
  if (!merged) return merged;
  return write_answers(arguments, work);
}

}  // namespace

void add_merge(CLI::App& app, Outcome& outcome) {
  auto arguments = std::make_shared<MergeArguments>();
  CLI::App* command = app.add_subcommand("merge", "Correct an evacuation plan and a robot's map with each other");
  command->add_option("--layout", arguments->layout, "layout.json, as `smokemap layout` writes it")->required();
  command->add_option("--log", arguments->log, "the robot's log: CARMEN, rosbag2 or MCAP")->required();
  command->add_option("--anchors", arguments->anchors,
                      "where the robot started on the plan, or pairs of places (JSON)");
  command->add_option("--points", arguments->points, "points on the plan to carry over (JSON)");
  command
      ->add_option("-o,--output", arguments->output, "merged.json: walls, corners, points, fit; frame map = first pose")
      ->required();
  command->add_option("--trajectory", arguments->trajectory, "corrected poses, one per scan (TUM)");
  command->add_option("--map", arguments->map, "also write PREFIX.pgm, .yaml and .png of what was sensed")
      ->type_name("PREFIX");
  command->add_option("--preview", arguments->preview, "PNG of the merged map");
  command
      ->add_option("--method", arguments->method,
                   "smokemap; for comparison: acg2017, acg2019 (the Auto-Complete Graph as published)")
      ->check(CLI::IsMember({"smokemap", "acg2017", "acg2019"}));
  command->callback([arguments, &outcome] {
    if (const auto done = run_merge(*arguments); !done) outcome.no_answer(done.error());
  });
}

}  // namespace smokemap::app
