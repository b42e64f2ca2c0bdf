#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "app/commands.hpp"
#include "app/map_picture.hpp"
#include "app/simulate_files.hpp"
#include "core/random.hpp"
#include "recording/file_bytes.hpp"
#include "recording/layout_json.hpp"
#include "recording/sensor_log.hpp"
#include "simulation/simulated_fleet.hpp"

namespace smokemap::app {
namespace {

struct SimulateArguments {
  std::string scenario, output, truth, plan, photo, layout, anchors, points;
  std::uint64_t seed = kDemoSeed;
  double duration_s = 1200;
  bool no_radar = false;
  int robots = 1;
};

struct Scenario {
  DemoParams demo;
  bool smoke_spreads = false;
};

/// The scenario file: every field is optional, unknown ones are refused so that a misspelt one is not silently ignored.
Result<Scenario> read_scenario(const std::string& path) {
  Scenario scenario;
  DemoParams& params = scenario.demo;
  if (path.empty()) return scenario;
  const auto bytes = read_file(path, 1'000'000);
  if (!bytes) return bytes.error();
  const auto document = nlohmann::json::parse(bytes->begin(), bytes->end(), nullptr, false);
  if (!document.is_object()) return fail(Errc::kCorrupt, path + ": the scenario is no JSON object");
  try {
    for (const auto& [key, value] : document.items()) {
      if (key == "length_m")
        params.building.length_m = value;
      else if (key == "depth_m")
        params.building.depth_m = value;
      else if (key == "corridor_m")
        params.building.corridor_m = value;
      else if (key == "furniture")
        params.building.furniture = value;
      else if (key == "leaf_share")
        params.building.leaf_share = value;
      else if (key == "stretch")
        params.distortion.sigma_stretch = value;
      else if (key == "sigma_corner_m")
        params.distortion.sigma_corner_m = value;
      else if (key == "missing_walls")
        params.distortion.missing_walls = value;
      else if (key == "phantom_walls")
        params.distortion.phantom_walls = value;
      else if (key == "turn_deg")
        params.distortion.turn_rad = radians(value);
      else if (key == "fire")
        params.fire = value;
      else if (key == "burning_s")
        params.burning_s = value;
      else if (key == "sigma_start_m")
        params.sigma_start_m = value;
      else if (key == "sigma_start_deg")
        params.sigma_start_rad = radians(value);
      else if (key == "smoke_spreads")
        scenario.smoke_spreads = value;
      else
        return fail(Errc::kInvalidArgument, path + ": unknown field \"" + key + "\"");
    }
  } catch (const nlohmann::json::exception& e) {
    return fail(Errc::kCorrupt, path + ": " + e.what());
  }
  return scenario;
}

Result<Ok> write_run(const std::string& path, RecordedRun& run) {
  if (std::filesystem::path(path).extension() != ".mcap") return write_file(path, carmen_log(run));
  SensorLog log;
  log.format = "mcap";
  log.items = std::move(run.items);
  return write_log(log, path);
}

Result<Ok> write_all(const SimulateArguments& arguments, const DemoParams& params, const DemoScenario& demo,
                     RecordedRun& run) {
  const auto text = [](const std::string& path, const auto& make) -> Result<Ok> {
    return path.empty() ? Result<Ok>(Ok{}) : write_file(path, make());
  };
  if (const auto done = text(arguments.truth, [&] { return truth_json(demo, run); }); !done) return done;
  if (const auto done = text(arguments.anchors, [&] { return anchors_json(demo, params); }); !done) return done;
  if (const auto done = text(arguments.points, [&] { return points_json(demo, run); }); !done) return done;
  if (const auto done = text(arguments.layout,
                             [&] {
                               return to_json(LayoutDocument{demo.truth.layout, {}, {}});
                             });
      !done)
    return done;
  if (!arguments.plan.empty())
    if (const auto done = write_picture(arguments.plan, demo.picture.sheet); !done) return done;
  if (!arguments.photo.empty()) {
    PlanPictureParams photo;
    photo.photo = true;
    auto random = random_stream(demo.seed, 21);
    const auto picture = draw_plan(demo.plan.drawn, photo, random);
    if (!picture) return picture.error();
    if (const auto done = write_picture(arguments.photo, picture->photo); !done) return done;
  }
  return write_run(arguments.output, run);
}

void run_simulate(const SimulateArguments& arguments, Outcome& outcome) {
  const auto scenario = read_scenario(arguments.scenario);
  if (!scenario) return outcome.no_answer(scenario.error());
  const bool is_mcap = std::filesystem::path(arguments.output).extension() == ".mcap";
  if (arguments.robots > 1 && !is_mcap)
    return outcome.no_answer(
        fail(Errc::kInvalidArgument, "a CARMEN log holds one robot only: name the output .mcap for several"));
  const auto demo = make_demo(arguments.seed, scenario->demo);
  if (!demo) return outcome.no_answer(demo.error());
  RunParams how;
  how.max_duration_s = arguments.duration_s;
  how.with_radar = !arguments.no_radar;
  how.skew = is_mcap;  // CARMEN logs cannot tell of it
  how.robots = arguments.robots;
  how.smoke_spreads = scenario->smoke_spreads;
  auto run = record_run(*demo, how);
  if (!run) return outcome.no_answer(run.error());
  const std::size_t scans = run->T_odom_scan.size();
  if (const auto written = write_all(arguments, scenario->demo, *demo, *run); !written)
    return outcome.no_answer(written.error());
  std::cout << demo->building.rooms.size() << " rooms, " << run->duration_s << " s, " << run->way_m << " m, " << scans
            << " scans, " << run->bumps << " bumps\n";
}

}  // namespace

void add_simulate(CLI::App& app, Outcome& outcome) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = app.add_subcommand(
      "simulate", "a two-wing building on fire, a wrong plan of it, and the log of a robot that visits every room");
  command->add_option("scenario", arguments->scenario,
                      "JSON with variations: length_m, depth_m, corridor_m, furniture, leaf_share, "
                      "stretch, sigma_corner_m, missing_walls, phantom_walls, turn_deg, fire, burning_s, "
                      "sigma_start_m, sigma_start_deg, smoke_spreads");
  command->add_option("--seed", arguments->seed, "the same seed gives the same files")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--robots", arguments->robots, "that share the rooms out among them")
      ->check(CLI::Range(1, kMostRobots))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "run.mcap (scans, odometry, radar) or a CARMEN log (.log)")
      ->required();
  command->add_option("--truth", arguments->truth, "JSON: poses, walls, corners, points as they truly are");
  command->add_option("--plan", arguments->plan, "the evacuation plan as a picture");
  command->add_option("--photo", arguments->photo, "the plan as photographed");
  command->add_option("--layout", arguments->layout, "the plan as a perfect reader would read it (JSON)");
  command->add_option("--anchors", arguments->anchors, "the start on the plan as a person would give it, for merge");
  command->add_option("--points", arguments->points, "a place in every room on the plan, for merge");
  command->add_option("--duration", arguments->duration_s, "seconds at most")->capture_default_str();
  command->add_flag("--no-radar", arguments->no_radar, "leave the radar out");
  command->callback([arguments, &outcome] { run_simulate(*arguments, outcome); });
}

}  // namespace smokemap::app
