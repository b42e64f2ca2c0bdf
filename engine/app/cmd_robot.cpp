#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <variant>

#include "app/commands.hpp"
#include "recording/sensor_log.hpp"
#include "robots/ros_robot.hpp"

namespace smokemap::app {
namespace {

struct RobotArguments {
  std::string bag;
  int domain = 0;
  double rate = 1;
};

using RobotNodes = std::map<std::string, std::unique_ptr<RosRobotNode>>;

Result<RobotNodes> open_nodes(const SensorLog& log, int domain) {
  RobotNodes nodes;
  for (const LogItem& item : log.items) {
    const std::string name = std::visit([](const auto& data) { return data.robot; }, item);
    if (nodes.contains(name)) continue;
    RosRobotParams params;
    params.robot = name;
    params.domain = domain;
    params.with_radar = log.sweeps() > 0;
    auto node = RosRobotNode::open(params, {});
    if (!node) return node.error();
    nodes.emplace(name, std::move(*node));
  }
  return nodes;
}

/// In the order of the log, at the pace of its stamps; stamps that step back wait for nothing.
void play(const SensorLog& log, const RobotNodes& nodes, double rate) {
  constexpr double kLongestPauseSeconds = 5;  // a robot that was switched off over lunch
  Stamp last = std::visit([](const auto& data) { return data.stamp; }, log.items.front());
  auto due = std::chrono::steady_clock::now();
  for (const LogItem& item : log.items) {
    std::visit(
        [&](const auto& data) {
          if (data.stamp > last) {
            const double pause_s = std::min(to_seconds(data.stamp - last), kLongestPauseSeconds) / rate;
            due +=
                std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(pause_s));
            last = data.stamp;
            std::this_thread::sleep_until(due);
          }
          nodes.at(data.robot)->publish(data);
        },
        item);
  }
}

void run_robot(const RobotArguments& arguments, Outcome& outcome) {
  const auto log = read_log(arguments.bag);
  if (!log) return outcome.no_answer(log.error());
  for (const std::string& warning : log->warnings) spdlog::warn("{}", warning);
  const auto nodes = open_nodes(*log, arguments.domain);
  if (!nodes) return outcome.no_answer(nodes.error());
  for (const auto& [name, node] : *nodes) spdlog::info("playing robot {} in ROS domain {}", name, arguments.domain);
  play(*log, *nodes, arguments.rate);
}

}  // namespace

void add_robot(CLI::App& app, Outcome& outcome) {
  auto arguments = std::make_shared<RobotArguments>();
  CLI::App* command = app.add_subcommand("robot", "play a sensor log as the ROS 2 robots that it came from");
  command->add_option("--bag", arguments->bag, "CARMEN, rosbag2 .db3 or MCAP")->required();
  command->add_option("--domain", arguments->domain, "ROS domain, 0..230")->capture_default_str();
  command->add_option("--rate", arguments->rate, "times real time")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  command->callback([arguments, &outcome] { run_robot(*arguments, outcome); });
}

}  // namespace smokemap::app
