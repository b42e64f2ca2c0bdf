#pragma once

#include <CLI/CLI.hpp>
#include <memory>

#include "core/result.hpp"

namespace smokemap::app {

/// What a subcommand leaves behind. Exit status 0 done, 1 the input has no answer, 2 usage.
struct Outcome {
  int status = 0;
  bool json = false;  ///< --json: errors also as JSON on standard output

  /// Says why there is no answer, in one line (and as JSON), and sets status 1 (2 for an invalid argument).
  void no_answer(const Error& error);
};

// One function a subcommand, each in its own file: adds the options and the callback that does the work.
// Options live as long as the parser: keep them in a shared_ptr captured by the callback.
void add_segment(CLI::App& app, Outcome& outcome);
void add_simulate(CLI::App& app, Outcome& outcome);
void add_match(CLI::App& app, Outcome& outcome);
void add_convert(CLI::App& app, Outcome& outcome);
void add_robot(CLI::App& app, Outcome& outcome);
void add_layout(CLI::App& app, Outcome& outcome);
void add_sketch(CLI::App& app, Outcome& outcome);
void add_merge(CLI::App& app, Outcome& outcome);
void add_serve(CLI::App& app, Outcome& outcome);
void add_slam(CLI::App& app, Outcome& outcome);
void add_evaluate(CLI::App& app, Outcome& outcome);

}  // namespace smokemap::app
