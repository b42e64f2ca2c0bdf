#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"

namespace smokemap::app {

void Outcome::no_answer(const Error& error) {
  status = error.code == Errc::kInvalidArgument ? 2 : 1;
  std::cerr << "smokemap: " << error.message << '\n';
  if (json)
    std::cout << nlohmann::json{{"error", {{"code", to_string(error.code)}, {"message", error.message}}}} << '\n';
}

namespace {

int run(int argc, char** argv) {
  CLI::App app{"Smokemap: one live map for firefighters and robots"};
  app.set_version_flag("--version", "smokemap 0.1.0");
  app.require_subcommand(1);
  app.fallthrough();  // --json is understood after the subcommand too
  Outcome outcome;
  app.add_flag("--json", outcome.json, "also print errors as JSON on standard output");
  add_serve(app, outcome);
  add_segment(app, outcome);
  add_match(app, outcome);
  add_convert(app, outcome);
  add_robot(app, outcome);
  add_layout(app, outcome);
  add_simulate(app, outcome);
  add_sketch(app, outcome);
  add_merge(app, outcome);
  add_slam(app, outcome);
  add_evaluate(app, outcome);
  const auto is_named = [&](const CLI::App* sub) { return sub->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && app.get_subcommands(is_named).empty()) {
    std::cerr << "smokemap: there is no subcommand '" << argv[1] << "'; smokemap --help lists them\n";
    return 2;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  return outcome.status;
}

}  // namespace
}  // namespace smokemap::app

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("smokemap"));
  spdlog::set_pattern("%H:%M:%S.%e %^%l%$ %v");
  try {
    return smokemap::app::run(argc, argv);
  } catch (const std::exception& e) {
    std::cerr << "smokemap: " << e.what() << '\n';
    return 1;
  }
}
