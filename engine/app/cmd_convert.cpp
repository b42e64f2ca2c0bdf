#include <spdlog/spdlog.h>

#include <iostream>
#include <memory>
#include <string>

#include "app/commands.hpp"
#include "recording/sensor_log.hpp"

namespace smokemap::app {
namespace {

struct ConvertArguments {
  std::string log;
  std::string output;
};

void run_convert(const ConvertArguments& arguments, Outcome& outcome) {
  const auto log = read_log(arguments.log);
  if (!log) return outcome.no_answer(log.error());
  for (const std::string& warning : log->warnings) spdlog::warn("{}", warning);
  for (const auto& [reason, count] : log->dropped) spdlog::info("left out {}: {}", count, reason);
  if (const auto written = write_log(*log, arguments.output); !written) return outcome.no_answer(written.error());
  std::cout << log->scans() << " scans, " << log->odometry_readings() << " odometry readings, " << log->sweeps()
            << " radar sweeps\n";
}

}  // namespace

void add_convert(CLI::App& app, Outcome& outcome) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command =
      app.add_subcommand("convert", "sensor log (CARMEN, rosbag2 .db3, MCAP) -> MCAP that ROS 2 tools open");
  command->add_option("log", arguments->log, "the log, or a rosbag2 folder")->required();
  command->add_option("output", arguments->output, "the MCAP file to write")->required();
  command->callback([arguments, &outcome] { run_convert(*arguments, outcome); });
}

}  // namespace smokemap::app
