#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/commands.hpp"
#include "recording/sensor_log.hpp"
#include "recording/trajectory_tum.hpp"
#include "slam/trajectory_error.hpp"

namespace smokemap::app {
namespace {

struct EvaluateOptions {
  std::string trajectory, relations, log, truth;
  std::vector<double> lever{0, 0};
  double longest_gap_s = 0.25;
};

/// Numbers of a text file, a vector a line; lines with # and empty ones left out.
Result<std::vector<std::vector<double>>> read_numbers(const std::string& path, std::size_t least) {
  std::ifstream file(path);
  if (!file) return fail(Errc::kIo, "cannot read " + path);
  std::vector<std::vector<double>> rows;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<double> row;
    for (double value = 0; words >> value;) row.push_back(value);
    if (row.empty() && words.eof()) continue;
    if (row.size() < least || !words.eof())
      return fail(Errc::kCorrupt, path + ":" + std::to_string(number) + ": expected numbers");
    rows.push_back(std::move(row));
  }
  return rows;
}

/// TUM, or "t x y heading" a line.
Result<Trajectory> read_trajectory(const std::string& path) {
  const auto rows = read_numbers(path, 4);
  if (!rows) return rows.error();
  Trajectory poses;
  for (const std::vector<double>& r : *rows) {
    const double heading =
        r.size() >= 8 ? std::atan2(2 * (r[7] * r[6] + r[4] * r[5]), 1 - 2 * (r[5] * r[5] + r[6] * r[6])) : r[3];
    poses.push_back({from_seconds(r[0]), Pose2(r[1], r[2], heading), Eigen::Matrix3d::Zero()});
  }
  return poses;
}

Result<std::vector<PoseRelation>> read_relations(const std::string& path) {
  const auto rows = read_numbers(path, 8);
  if (!rows) return rows.error();
  std::vector<PoseRelation> relations;
  for (const std::vector<double>& r : *rows)
    relations.push_back({from_seconds(r[0]), from_seconds(r[1]), Pose2(r[2], r[3], r[7])});
  return relations;
}

nlohmann::json to_json(const ErrorSpread& spread, double scale) {
  return {{"mean", spread.mean * scale},
          {"std", spread.stddev * scale},
          {"median", spread.median * scale},
          {"max", spread.most * scale}};
}

Result<nlohmann::json> against_relations(const Trajectory& estimate, const EvaluateOptions& options) {
  const auto relations = read_relations(options.relations);
  if (!relations) return relations.error();
  std::vector<Odometry> odometry;
  if (!options.log.empty()) {
    const auto log = read_log(options.log);
    if (!log) return log.error();
    for (const LogItem& item : log->items)
      if (const auto* reading = std::get_if<Odometry>(&item)) odometry.push_back(*reading);
  }
  const auto error = relation_error(estimate, *relations, odometry, options.longest_gap_s);
  if (!error) return error.error();
  if (error->missing > 0 && options.log.empty())
    return fail(Errc::kDegenerate,
                std::to_string(error->missing) + " of " + std::to_string(relations->size()) +
                    " relations have no pose near both of their stamps, so a mean would say nothing; "
                    "give --log: its odometry fills stamps between poses");
  nlohmann::json report{{"relations", error->relations},
                        {"missing", error->missing},
                        {"translation_m", to_json(error->translation_m, 1)},
                        {"rotation_deg", to_json(error->rotation_rad, degrees(1))}};
  if (error->clear > 0)
    report["clear_stamps"] = {{"relations", error->clear},
                              {"translation_m", to_json(error->clear_translation_m, 1)},
                              {"rotation_deg", to_json(error->clear_rotation_rad, degrees(1))}};
  return report;
}

Result<nlohmann::json> against_truth(const Trajectory& estimate, const EvaluateOptions& options) {
  const auto truth = read_trajectory(options.truth);
  if (!truth) return truth.error();
  const auto absolute = absolute_error(estimate, *truth, {options.lever[0], options.lever[1]}, options.longest_gap_s);
  if (!absolute) return absolute.error();
  const auto steps = displacement_error(estimate, *truth);
  if (!steps) return steps.error();
  return nlohmann::json{{"poses", absolute->poses},
                        {"path_m", absolute->path_m},
                        {"ate_rmse_m", absolute->rmse_m},
                        {"ate_mean_m", absolute->mean_m},
                        {"ate_max_m", absolute->most_m},
                        {"rotation_rmse_deg", degrees(absolute->rotation_rmse_rad)},
                        {"displacement_m", to_json(steps->length_m, 1)},
                        {"displacement_deg", to_json(steps->heading_rad, degrees(1))}};
}

Result<Ok> run_evaluate(const EvaluateOptions& options) {
  if (options.relations.empty() && options.truth.empty())
    return fail(Errc::kInvalidArgument, "evaluate: give --relations or --truth");
  const auto estimate = read_trajectory(options.trajectory);
  if (!estimate) return estimate.error();
  nlohmann::json report;
  if (!options.relations.empty()) {
    const auto part = against_relations(*estimate, options);
    if (!part) return part.error();
    report["relation_error"] = *part;
  }
  if (!options.truth.empty()) {
    const auto part = against_truth(*estimate, options);
    if (!part) return part.error();
    report["against_truth"] = *part;
  }
  std::cout << report.dump(1) << '\n';
  return Ok{};
}

}  // namespace

void add_evaluate(CLI::App& app, Outcome& outcome) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* command =
      app.add_subcommand("evaluate", "errors of a trajectory: relations, ATE, displacement (Paper VI); prints JSON");
  command->add_option("trajectory", options->trajectory, "TUM, or 't x y heading' a line")->required();
  command->add_option("--relations", options->relations, "'t1 t2 x y z roll pitch yaw' a line");
  command->add_option("--log", options->log, "the log: its odometry fills stamps between scans");
  command->add_option("--truth", options->truth, "true trajectory, in either form");
  command->add_option("--lever", options->lever, "x,y of the point of the robot whose pose the truth gives, metres")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--max-dt", options->longest_gap_s, "seconds a pose may be away from a stamp")
      ->capture_default_str();
  command->callback([options, &outcome] {
    if (const auto done = run_evaluate(*options); !done) outcome.no_answer(done.error());
  });
}

}  // namespace smokemap::app
