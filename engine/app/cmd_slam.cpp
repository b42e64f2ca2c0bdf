#include <malloc.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "app/commands.hpp"
#include "recording/file_bytes.hpp"
#include "recording/map_server.hpp"
#include "recording/sensor_log.hpp"
#include "recording/trajectory_tum.hpp"
#include "slam/render_map.hpp"
#include "slam/slam.hpp"

namespace smokemap::app {
namespace {

/// Graph work is due this often: a robot's second or two.
constexpr std::size_t kOptimizeEveryScans = 20;

struct SlamOptions {
  std::string log, trajectory, map, stats;
  std::string sensor = "auto";
  bool clear_air = false;
  double resolution_m = 0.05;
};

void feed(Slam& slam, const LogItem& item, bool lidar, bool radar) {
  if (const auto* odometry = std::get_if<Odometry>(&item)) slam.add_odometry(*odometry);
  // A scan that is refused is counted by Slam itself; the log goes on.
  if (const auto* scan = std::get_if<LaserScan>(&item); scan && lidar) (void)slam.add_scan(*scan).ok();
  if (const auto* sweep = std::get_if<RadarSweep>(&item); sweep && radar) (void)slam.add_sweep(*sweep).ok();
}

nlohmann::json stats_of(const Slam& slam, const SensorLog& log) {
  const SlamCounters& c = slam.counters();
  return {{"format", log.format},
          {"scans", c.scans},
          {"sweeps", c.sweeps},
          {"odometry", c.odometry},
          {"nodes", slam.graph().nodes.size()},
          {"edges", slam.graph().edges.size()},
          {"loops", {{"tried", c.loops_tried}, {"closed", c.loops_closed}, {"rejected", c.loops_rejected}}},
          {"dropped",
           {{"malformed", c.malformed},
            {"duplicates", c.duplicates},
            {"too_few_points", c.too_few_points},
            {"poor_matches", c.poor_matches}}},
          {"dropped_by_reader", log.dropped},
          {"stamps_back", c.stamps_back},
          {"odometry_jumps", c.jumps},
          {"without_odometry", c.without_odometry},
          {"pieces_begun_anew", c.lost},
          {"pieces_found_again", c.relocated},
          {"smoke_beams", c.smoke_beams},
          {"walker_beams", c.walker_beams},
          {"smoke_share", c.smoke_share},
          {"warnings", log.warnings}};
}

/// Blocks of a log and its graph go back to the system when they are freed: a robot's computer has other work too.
void give_memory_back() {
  mallopt(M_MMAP_THRESHOLD, 64 << 10);
  mallopt(M_TOP_PAD, 0);
}

Result<Ok> run_slam(const SlamOptions& options) {
  give_memory_back();
  auto log = read_log(options.log);
  if (!log) return log.error();
  for (const std::string& warning : log->warnings) spdlog::warn("{}", warning);
  const bool radar_only = options.sensor == "radar" || (options.sensor == "auto" && log->scans() == 0);
  const bool lidar_only = options.sensor == "lidar";
  SlamParams params;
  params.beams.no_return_is_free = options.clear_air;
  auto slam = std::make_unique<Slam>(params);
  std::size_t fed = 0;
  for (LogItem& item : log->items) {
    feed(*slam, item, !radar_only, !lidar_only);
    if (!std::holds_alternative<Odometry>(item) && ++fed % kOptimizeEveryScans == 0) slam->optimize();
    item = Odometry();  // a long log and its map need not be held at once
  }
  log->items = {};  // the last solve needs most
  slam->polish();
  const Trajectory trajectory = slam->trajectory();
  const PoseGraph graph = slam->graph();
  const std::string stats = stats_of(*slam, *log).dump(1) + "\n";
  slam.reset();  // its back end is as large as the map that is drawn next
  if (graph.nodes.empty())
    return fail(Errc::kDegenerate, options.log + ": no scan with enough points to make a map of");
  if (const auto written = write_tum(trajectory, options.trajectory); !written) return written;
  if (!options.map.empty()) {
    RenderParams render;
    render.resolution_m = options.resolution_m;
    if (const auto written = write_map(render_map(graph, {}, render), options.map); !written) return written;
  }
  if (!options.stats.empty()) return write_file(options.stats, stats);
  return Ok{};
}

}  // namespace

void add_slam(CLI::App& app, Outcome& outcome) {
  auto options = std::make_shared<SlamOptions>();
  CLI::App* command = app.add_subcommand("slam", "a robot's log -> trajectory and map");
  command->add_option("log", options->log, "CARMEN log (plain or .gz), rosbag2 .db3 or MCAP")->required();
  command->add_option("-o,--output", options->trajectory, "trajectory to write (TUM: t x y z qx qy qz qw)")->required();
  command->add_option("--map", options->map, "also write PREFIX.pgm, .yaml and .png")->type_name("PREFIX");
  command->add_option("--resolution", options->resolution_m, "metres per cell of the map")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  command->add_option("--sensor", options->sensor, "lidar or radar alone; auto uses both")
      ->check(CLI::IsMember({"auto", "lidar", "radar"}))
      ->capture_default_str();
  command->add_flag("--clear-air", options->clear_air,
                    "beams without return are free up to the sensor's reach (never true in smoke)");
  command->add_option("--stats", options->stats, "write what was used, dropped and closed as JSON");
  command->callback([options, &outcome] {
    if (const auto done = run_slam(*options); !done) outcome.no_answer(done.error());
  });
}

}  // namespace smokemap::app
