#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <opencv2/imgcodecs.hpp>

#include "app/commands.hpp"
#include "app/picture_reader.hpp"
#include "app/recording_port.hpp"
#include "app/robot_link.hpp"
#include "app/simulated_site.hpp"
#include "server/app/server.hpp"
#include "server/wire/engine_port.hpp"

namespace smokemap::app {
namespace {

struct ServeArguments {
  std::string data = "data";
  std::string web = "web/dist";
  std::string address = "127.0.0.1";
  int port = 8080;
  int ros_domain = 0;
  bool demo = false;
  std::uint64_t seed = kDemoSeed;
  int robots = 1;
  std::string record;
  std::vector<std::string> host_names;
};

class NoRobots final : public RobotCommands {
 public:
  void drive(const std::string&, double, double) override {}
};

/// An engine of its own for looking back; it never meets a robot.
class PastEngine final : public server::EnginePort {
 public:
  explicit PastEngine(std::shared_ptr<const Clock> clock)
      : engine_({}, std::move(clock), std::make_shared<NoRobots>()), adapter_(engine_) {}
  Result<Ok> apply(const Command& command, Origin origin) override { return adapter_.apply(command, origin); }
  std::shared_ptr<const Snapshot> snapshot() const override { return adapter_.snapshot(); }
  void on_snapshot(Listener listener) override { adapter_.on_snapshot(std::move(listener)); }

 private:
  Engine engine_;
  server::EngineAdapter adapter_;
};

Result<server::Json> command(server::Server& server, const std::string& name, server::Json data) {
  static int count = 0;
  const std::string id = "demo-" + std::to_string(SystemClock().now()) + "-" + std::to_string(++count);
  return server.post("/api/commands",
                     server::Json{{"type", "command"}, {"id", id}, {"name", name}, {"data", std::move(data)}}.dump());
}

/// What a commander does before deployment: uploads the plan, gives its scale, says where the robots stand. Once; after
/// a restart the stored plan is taken, and only the robots' places are said again.
Result<Ok> prepare_demo(server::Server& server, const Engine& engine, const DemoScenario& demo,
                        const std::vector<FleetMember>& members) {
  if (!engine.snapshot()->layout) {
    std::vector<std::uint8_t> png;
    if (!cv::imencode(".png", demo.picture.sheet, png)) return fail(Errc::kIo, "the demo's plan could not be drawn");
    const auto plan = server.post("/api/plans", {png.begin(), png.end()});
    if (!plan) return plan.error();
    const std::string id = (*plan)["plan_id"].get<std::string>();
    const auto layout = server.post("/api/plans/" + id + "/read",
                                    server::Json{{"metres_per_pixel", demo.picture.metres_per_pixel}}.dump());
    if (!layout) return layout.error();
    if (const auto set = command(server, "set_layout", {{"plan_id", id}, {"layout", *layout}}); !set)
      return set.error();
  }
  for (const FleetMember& member : members) {
    const std::string& robot = member.params.name;
    const Point2& px = member.start.layout_px;
    if (const auto set = command(server, "set_start",
                                 {{"robot", robot}, {"px", {px.x(), px.y()}}, {"heading", member.start.heading_rad}});
        !set)
      return set.error();
    if (const auto set = command(server, "set_exploring", {{"robot", robot}, {"exploring", true}}); !set)
      return set.error();
  }
  return Ok{};
}

/// The recording, where one was asked for; null otherwise.
Result<std::unique_ptr<LiveRecorder>> start_recording(const std::string& path) {
  if (path.empty()) return std::unique_ptr<LiveRecorder>();
  return LiveRecorder::start(path, {}, [](const std::string& text) { spdlog::error("{}", text); });
}

Result<std::unique_ptr<SimulatedSite>> start_demo(const ServeArguments& arguments, server::Server& server,
                                                  const Engine& engine) {
  const auto demo = make_demo(arguments.seed);
  if (!demo) return demo.error();
  auto members = demo_fleet(*demo, arguments.robots);
  if (!members) return members.error();
  if (const auto ready = prepare_demo(server, engine, *demo, *members); !ready) return ready.error();
  return SimulatedSite::start(*demo, std::move(*members), arguments.ros_domain);
}

server::ServerOptions server_options(const ServeArguments& arguments, const std::shared_ptr<const Clock>& clock) {
  server::ServerOptions options;
  options.data_dir = arguments.data;
  options.web_root = arguments.web;
  options.address = arguments.address;
  options.port = static_cast<std::uint16_t>(arguments.port);
  options.host_names = arguments.host_names;
  options.pairing.loopback_without_pin = arguments.demo;
  options.make_replay_engine = [clock] { return std::make_unique<PastEngine>(clock); };
  return options;
}

Result<Ok> serve(const ServeArguments& arguments) {
  const auto clock = std::make_shared<SystemClock>();
  const auto robots = std::make_shared<RobotLinkage>();
  Engine engine({}, clock, robots);
  server::EngineAdapter adapter(engine);
  const auto recorder = start_recording(arguments.record);
  if (!recorder) return recorder.error();
  RecordingPort port(adapter, clock, recorder->get());
  PictureReader pictures;
  server::Server server(server_options(arguments, clock), port, pictures, clock);
  if (const auto started = server.start(); !started) return started.error();
  GatewayParams gateway;
  gateway.domain = arguments.ros_domain;
  std::unique_ptr<SimulatedSite> site;
  if (arguments.demo) {
    auto started = start_demo(arguments, server, engine);
    if (!started) return started.error();
    site = std::move(*started);
  }
  if (const auto opened = robots->open(gateway, engine, clock, recorder->get()); !opened) return opened.error();
  (void)server::run_until_signal(server);
  robots->close();
  return *recorder ? (*recorder)->finish() : Result<Ok>(Ok{});
}

}  // namespace

void add_serve(CLI::App& app, Outcome& outcome) {
  const auto arguments = std::make_shared<ServeArguments>();
  CLI::App* sub =
      app.add_subcommand("serve", "the server: HTTP, live map, ROS 2 robots; with --demo a simulated building on fire");
  sub->add_option("--data", arguments->data, "folder for the log and the pictures")->capture_default_str();
  sub->add_option("--web", arguments->web, "folder with the built web app; empty = none")->capture_default_str();
  sub->add_option("--address", arguments->address, "to listen on; 0.0.0.0 = every network (use a trusted one)")
      ->capture_default_str();
  sub->add_option("--port", arguments->port, "0 = any free one")->check(CLI::Range(0, 65535))->capture_default_str();
  sub->add_option("--host-name", arguments->host_names, "further names under which browsers may reach it");
  sub->add_option("--ros-domain", arguments->ros_domain, "ROS_DOMAIN_ID of the robots")
      ->check(CLI::Range(0, 230))
      ->capture_default_str();
  sub->add_flag("--demo", arguments->demo,
                "simulated building, plan and robot; browsers on this machine pair by themselves");
  sub->add_option("--seed", arguments->seed, "of the demo's building")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  sub->add_option("--robots", arguments->robots, "of the demo")
      ->check(CLI::Range(1, kMostRobots))
      ->capture_default_str();
  sub->add_option("--record", arguments->record,
                  "MCAP file for what robots send and people do; `smokemap slam` replays it. Never written over");
  sub->callback([arguments, &outcome] {
    if (const auto done = serve(*arguments); !done) outcome.no_answer(done.error());
  });
}

}  // namespace smokemap::app
