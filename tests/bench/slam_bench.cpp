// slam_bench [--data DIR] [--rows NAME,...] [--seeds N] [--km FIRST,LAST]: what SLAM reaches, beside what it should.
//
// For every log in DIR (CARMEN .log, .log.gz, .clf, rosbag2 .db3, .mcap): relation error where NAME.relations lies
// beside it, over all relations and over those whose stamps mean one place only (trajectory_error.hpp says why); where
// many stamps do not, also over all with the readings that other relations say; error against NAME.ref.txt (a
// trajectory "t x y heading") where that lies there; CPU seconds and how many times faster than the robot that is,
// reading included; peak memory; time of the front end per scan.
// Always: generated logs of a kilometre (with how many of the loops that were kept are wrong), the simulated twin of
// Paper VI, and N random buildings full of smoke with the radar alone. --km chooses the seeds of the generated logs,
// --rows the rows: names of logs in DIR, km, alike, thin, short-turn, crowd (see LongLogKind), twin, smoke. Every log
// runs in a process of its own, so that its memory is its own.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "recording/sensor_log.hpp"
#include "tests/bench/bench_options.hpp"
#include "tests/bench/long_log_figures.hpp"
#include "tests/bench/radar_figures.hpp"
#include "tests/bench/reading_figures.hpp"

namespace smokemap::bench {
namespace {

constexpr std::size_t kOptimizeEveryScans = 20;
constexpr double kLongWay_m = 1200;
constexpr int kLongLogs = 3;
constexpr double kWrong_m = 0.5;   ///< a loop this far from the truth is a wrong one
constexpr double kMissed_m = 1.0;  ///< a place seen again that is this far from itself: the loop was missed

const std::map<std::string, std::string> kGoals{
    {"intel", "0.038 m 1.2 deg, largest 0.45; 200 x real time; 100 MB; p99 10 ms"},
    {"fr079", "0.050 m 0.60 deg, largest 0.30"},
    {"aces", "ATE 0.5 m"},
    {"edmonton", "ATE 0.5 m"},
    {"fhw", "ATE 0.5 m"}};

const std::vector<std::pair<std::string, LongLogKind>> kLongLogKinds{
    {"km", {}},
    {"alike", {.alike = true}},
    {"thin", {.scans_apart_m = 0.85, .scans_apart_rad = 0.5}},
    {"short-turn", {.turn_told = 0.88}},
    {"crowd", {.people = 4}}};

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Rows of at least `least` numbers; empty without such a file.
std::vector<std::vector<double>> numbers_of(const std::filesystem::path& path, std::size_t least) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<double> row;
    for (double value; words >> value;) row.push_back(value);
    if (row.size() >= least) rows.push_back(std::move(row));
  }
  return rows;
}

/// A log fed as the `slam` command does, with the time of every scan.
struct Played {
  Slam slam;
  std::vector<double> scan_ms;
  std::vector<Odometry> odometry;
  std::vector<std::size_t> reading_of_scan;  ///< the newest reading when it came
  double duration_s = 0;
};

template <typename Items>
Played play(const Items& items) {
  Played played;
  Stamp first = 0, last = 0;
  for (const auto& item : items) {
    if (const auto* reading = std::get_if<Odometry>(&item)) {
      played.slam.add_odometry(*reading);
      played.odometry.push_back(*reading);
    }
    const auto* scan = std::get_if<LaserScan>(&item);
    if (!scan) continue;
    const double begin = cpu_s();
    if (!played.slam.add_scan(*scan)) continue;
    played.scan_ms.push_back(1e3 * (cpu_s() - begin));
    played.reading_of_scan.push_back(std::max<std::size_t>(played.odometry.size(), 1) - 1);
    if (played.scan_ms.size() == 1) first = scan->stamp;
    last = std::max(last, scan->stamp);
    if (played.scan_ms.size() % kOptimizeEveryScans == 0) played.slam.optimize();
  }
  played.slam.polish();
  played.duration_s = to_seconds(last - first);
  std::sort(played.scan_ms.begin(), played.scan_ms.end());
  return played;
}

void print_head() {
  std::printf("%-12s %6s | %-23s | %-28s | %7s %7s | %7s %6s %5s | %6s %6s %6s | %s\n", "log", "scans",
              "relations: m deg largest", "clear stamps: m deg largest n", "ATE m", "largest", "CPU s", "x real", "MB",
              "p50 ms", "p99", "most", "loops closed/refused, pieces");
}

/// @param spent_s  CPU seconds this log is to be charged with
void print_row(const std::string& name, const Played& played, const std::vector<PoseRelation>& relations,
               const Trajectory& reference, double spent_s) {
  const Trajectory poses = played.slam.trajectory();
  const auto related = relation_error(poses, relations, played.odometry);
  const auto absolute = absolute_error(poses, reference);
  char all[64] = "-", clear[96] = "-";
  if (related)
    std::snprintf(all, sizeof all, "%.4f %6.3f %8.3f", related->translation_m.mean, degrees(related->rotation_rad.mean),
                  related->translation_m.most);
  if (related && related->clear > 0)
    std::snprintf(clear, sizeof clear, "%.4f %6.3f %8.3f %5zu", related->clear_translation_m.mean,
                  degrees(related->clear_rotation_rad.mean), related->clear_translation_m.most, related->clear);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const std::size_t count = played.scan_ms.size();
  const SlamCounters& c = played.slam.counters();
  std::printf("%-12s %6zu | %-23s | %-28s | %7.3f %7.3f | %7.2f %6.0f %5ld | %6.2f %6.2f %6.2f | %lld/%lld %lld\n",
              name.c_str(), count, all, clear, absolute ? absolute->rmse_m : -1, absolute ? absolute->most_m : -1,
              spent_s, played.duration_s / spent_s, usage.ru_maxrss / 1024, played.scan_ms[count / 2],
              played.scan_ms[count * 99 / 100], played.scan_ms.back(), static_cast<long long>(c.loops_closed),
              static_cast<long long>(c.loops_rejected), static_cast<long long>(c.lost));
}

void recorded_log(const std::filesystem::path& path, const std::string& name) {
  const double begin = cpu_s();
  auto log = read_log(path);
  if (!log || log->scans() == 0) {
    std::printf("%-12s %s\n", name.c_str(), log ? "no scans" : log.error().message.c_str());
    return;
  }
  const Played played = play(log->items);
  const double spent_s = cpu_s() - begin;
  if (played.scan_ms.empty()) return;
  std::vector<PoseRelation> relations;
  for (const auto& r : numbers_of(path.parent_path() / (name + ".relations"), 8))
    relations.push_back({from_seconds(r[0]), from_seconds(r[1]), Pose2(r[2], r[3], r[7])});
  Trajectory reference;
  for (const auto& r : numbers_of(path.parent_path() / (name + ".ref.txt"), 4))
    reference.push_back({from_seconds(r[0]), Pose2(r[1], r[2], r[3]), Eigen::Matrix3d::Zero()});
  print_row(name, played, relations, reference, spent_s);
  const ReadingFigures told =
      told_by_relations(played.slam.trajectory(), played.reading_of_scan, played.odometry, relations);
  if (20 * told.ambiguous > told.stamps)
    std::printf(
        "%12s   %zu of %zu stamps of relations may mean several readings. Each taken for the one that the other "
        "relations (four fifths) say: %.4f m %.3f deg, largest %.3f; that all say: %.4f m %.3f deg, largest %.3f\n",
        "", told.ambiguous, told.stamps, told.mean_m, degrees(told.mean_rad), told.most_m, told.best_mean_m,
        degrees(told.best_mean_rad), told.best_most_m);
  if (const auto goal = kGoals.find(name); goal != kGoals.end())
    std::printf("%12s   to reach: %s\n", "", goal->second.c_str());
}

/// Kept loops that tie together what does not belong together, and the worst of them.
std::pair<std::size_t, double> wrong_loops(const PoseGraph& graph, const Trajectory& truth) {
  std::map<Stamp, Pose2> T_world_robot;
  for (const StampedPose& pose : truth) T_world_robot.emplace(pose.stamp, pose.T_map_robot);
  const auto node_truth = [&](int node) { return T_world_robot.at(graph.nodes[static_cast<std::size_t>(node)].stamp); };
  std::pair<std::size_t, double> wrong{0, 0};
  for (const PoseEdge& edge : graph.edges) {
    if (edge.kind != EdgeKind::kLoop || edge.state == LinkState::kRejected) continue;
    const Pose2 T_from_to = node_truth(edge.from).inverse() * node_truth(edge.to);
    const double off_m = (T_from_to.translation() - edge.T_from_to.translation()).norm();
    wrong.first += off_m > kWrong_m;
    wrong.second = std::max(wrong.second, off_m);
  }
  return wrong;
}

void generated_log(int seed, const std::string& name, const LongLogKind& kind) {
  const LongLog log = long_log(static_cast<std::uint64_t>(seed), kLongWay_m, kind);
  const double begin = cpu_s();
  const Played played = play(log.items);
  print_row(name + " " + std::to_string(seed), played, log.relations, log.truth, cpu_s() - begin);
  std::size_t missed = 0;
  for (const PoseRelation& revisit : log.revisits) {
    const auto error = relation_error(played.slam.trajectory(), {revisit});
    missed += !error || error->translation_m.most > kMissed_m;
  }
  const auto [wrong, worst_m] = wrong_loops(played.slam.graph(), log.truth);
  std::printf(
      "%12s   to reach: 0.050 m, largest 1 m, no missed loop; %zu of %zu places seen again missed, %zu loops wrong "
      "(the worst by %.2f m), %.0f m driven\n",
      "", missed, log.revisits.size(), wrong, worst_m, log.way_m);
}

template <typename Work>
void in_own_process(Work&& work) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    work();
    std::fflush(stdout);
    _exit(0);
  }
  int status = 0;
  if (child > 0) waitpid(child, &status, 0);
  if (child < 0 || status != 0) std::printf("a log ended with status %d\n", status);
}

/// The files of a folder that look like logs, by name.
std::vector<std::pair<std::string, std::filesystem::path>> logs_in(const std::string& folder) {
  std::vector<std::pair<std::string, std::filesystem::path>> logs;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string file = entry.path().filename();
    for (const std::string ending : {".log", ".log.gz", ".clf", ".db3", ".mcap"})
      if (file.ends_with(ending)) logs.emplace_back(file.substr(0, file.size() - ending.size()), entry.path());
  }
  std::sort(logs.begin(), logs.end());
  return logs;
}

void twin() {
  std::printf("\ntwin of Paper VI   sensor  ATE m    step m   deg     paper's measure m\n");
  for (const TwinFigures& f : paper_twin())
    std::printf("%-18s %-6s %7.4f %8.4f %6.3f %10.4f\n", f.run.c_str(), f.sensor == Use::kLidar ? "lidar" : "radar",
                f.whole.rmse_m, f.step.translation_m.mean, degrees(f.step.rotation_rad.mean), f.paper.length_m.mean);
  std::printf("   to reach: lidar ATE 0.007 m; radar ATE 0.10 m, step 0.025 m 0.5 deg\n");
}

void smoke(int seeds) {
  int runs = 0, closed = 0, within = 0;
  double worst_m = 0, worst_end_m = 0, sum_m = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto run = building_run(seed, false);
    if (!run) continue;
    const RunFigures f = judged(*run, Use::kRadar);
    ++runs;
    closed += f.counters.loops_closed > 0 && f.end_m >= 0 && f.end_m < 0.5;
    within += f.whole.rmse_m <= 0.15;
    worst_m = std::max(worst_m, f.whole.rmse_m);
    worst_end_m = std::max(worst_end_m, f.end_m);
    sum_m += f.whole.rmse_m;
  }
  if (runs == 0) return;
  std::printf(
      "\nradar only, dense smoke, %d buildings: %d closed their loop; ATE mean %.3f m, worst %.3f m, %d within "
      "0.15 m; worst error of the end seen from the start %.3f m\n   to reach: all close, ATE 0.15 m\n",
      runs, closed, sum_m / runs, worst_m, within, worst_end_m);
}

}  // namespace
}  // namespace smokemap::bench

namespace {

struct Options {
  std::string data, rows;
  int seeds = 20, first_km = 1, last_km = smokemap::bench::kLongLogs;
  bool wants(const std::string& row) const {
    return rows.empty() || ("," + rows + ",").find("," + row + ",") != std::string::npos;
  }
};

Options read_options(int argc, char** argv) {
  Options options;
  std::string km;
  smokemap::bench::BenchOptions("What SLAM reaches, beside what it should")
      .text("--data", options.data, "folder with logs")
      .text("--rows", options.rows, "only these: names of logs, km, alike, thin, short-turn, crowd, twin, smoke")
      .number("--seeds", options.seeds, "buildings full of smoke")
      .text("--km", km, "FIRST,LAST seed of the generated logs")
      .read(argc, argv);
  if (!km.empty()) (void)std::sscanf(km.c_str(), "%d,%d", &options.first_km, &options.last_km);
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace smokemap::bench;
  const Options options = read_options(argc, argv);
  print_head();
  if (!options.data.empty())
    for (const auto& [name, path] : logs_in(options.data))
      if (options.wants(name)) in_own_process([&name = name, &path = path] { recorded_log(path, name); });
  for (const auto& [name, kind] : kLongLogKinds)
    for (int seed = options.first_km; seed <= options.last_km && options.wants(name); ++seed)
      in_own_process([&, seed] { generated_log(seed, name, kind); });
  if (options.wants("twin")) in_own_process(twin);
  if (options.wants("smoke")) in_own_process([&] { smoke(options.seeds); });
}
