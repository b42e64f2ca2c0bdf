// The Auto-Complete Graph, white box: ./run bench acg [--seeds N] [--first N] [--rows TEXT] [--data DIR] [--list]
// [--no-published] [--json FILE]. --list names the rows; --rows takes those with TEXT in their name, so that the table
// can be made in pieces (a seed of a row that merges at once takes some 5 s of CPU, online half a minute). What was
// done is told on standard error. Data: simulation (generated buildings, wrong plans of them, a robot's lidar and
// wheels through them), seeds 1..N, the real front end (SLAM) and the real alignment in the loop, no true pose
// anywhere. Median over the seeds, the worst in brackets. Rows with "online" update after every node and measure each
// update (CPU of one thread) and the turn of walls; the others merge the whole run at once. With --data (the folder
// with acg and floor_plans) also the Halmstad maps and the Oerebro pixel pairs. Two threads, one seed each; the same
// figures on one.
#include <atomic>
#include <cstdio>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/acg_data_figures.hpp"
#include "tests/bench/acg_figures.hpp"
#include "tests/bench/bench_options.hpp"

namespace {

using namespace smokemap;
using namespace smokemap::bench;

struct Row {
  AcgScenario scenario;
  AcgMethod method = AcgMethod::kOurs;
};

std::vector<Row> rows(bool with_published) {
  std::vector<Row> all;
  const auto add = [&](const std::string& name, const auto& change) {
    AcgScenario s;
    s.name = name;
    change(s);
    all.push_back({s, AcgMethod::kOurs});
  };
  for (const int percent : {10, 40, 50, 90})
    add("odometry noise " + std::to_string(percent) + " %", [&](AcgScenario& s) { s.noise = 0.01 * percent; });
  add("start 0.8 m, 5 deg off", [](AcgScenario& s) { s.start_m = 0.8, s.start_deg = 5; });
  add("plan stretched 15 %", [](AcgScenario& s) { s.stretch = 0.15; });
  add("30 % missing and false, 50 % spurious", [](AcgScenario& s) {
    s.missing_share = s.phantom_share = 0.30;
    s.spurious_share = 0.5;
  });
  add("online", [](AcgScenario& s) { s.online = true; });
  const std::size_t ours = all.size();
  for (std::size_t i = 0; with_published && i < ours; ++i)
    for (const AcgMethod method : {AcgMethod::k2017, AcgMethod::k2019}) {
      AcgScenario s = all[i].scenario;
      if (s.noise == 0.5 || s.online) continue;
      s.name = (method == AcgMethod::k2017 ? "acg2017: " : "acg2019: ") + s.name;
      all.push_back({s, method});
    }
  return all;
}

struct Column {
  const char* name;
  double AcgScore::*value;
  bool large_is_good;
};

constexpr Column kColumns[] = {
    {"odom m", &AcgScore::pose_before_m, false},   {"pose m", &AcgScore::pose_m, false},
    {"yaw rad", &AcgScore::yaw_rad, false},        {"plan m", &AcgScore::before_m, false},
    {"seen m", &AcgScore::seen_m, false},          {"plan m", &AcgScore::never_before_m, false},
    {"never m", &AcgScore::never_m, false},        {"2sig seen", &AcgScore::within_seen, true},
    {"2sig never", &AcgScore::within_never, true}, {"links P", &AcgScore::links_right, true},
    {"links R", &AcgScore::links_found, true},     {"missing P", &AcgScore::missing_right, true},
    {"missing R", &AcgScore::missing_found, true}, {"new P", &AcgScore::new_right, true},
    {"new R", &AcgScore::new_found, true},         {"fit", &AcgScore::fit, true},
    {"update s", &AcgScore::update_s, false},      {"slowest s", &AcgScore::slowest_s, false},
    {"turned deg", &AcgScore::turned_deg, false},  {"plan deg", &AcgScore::plan_turned_deg, false},
};

void print_row(const std::string& name, const std::vector<AcgScore>& scores, std::ofstream& json) {
  if (scores.empty()) return;
  double success = 0;
  for (const AcgScore& s : scores) success += s.success;
  std::printf("%-46s %3zu %4.2f", name.c_str(), scores.size(), success / static_cast<double>(scores.size()));
  if (json.is_open())
    json << "{\"row\": \"" << name << "\", \"seeds\": " << scores.size() << ", \"success\": " << success;
  for (const Column& c : kColumns) {
    std::vector<double> values;
    for (const AcgScore& s : scores) {
      const bool never =
          c.value == &AcgScore::never_m || c.value == &AcgScore::never_before_m || c.value == &AcgScore::within_never;
      if (!never || s.never > 0) values.push_back(s.*c.value);
    }
    if (values.empty()) {
      std::printf("  %14s", "-");
      continue;
    }
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double worst = c.large_is_good ? *low : *high;
    std::printf("  %6.3f (%5.3f)", median_of(values), worst);
    if (json.is_open()) json << ", \"" << c.name << "\": [" << median_of(values) << ", " << worst << "]";
  }
  std::printf("\n");
  if (json.is_open()) json << "}\n";
  std::fflush(stdout);
}

/// All rows of one seed; rows with the same plan share the run.
void run_seed(const std::vector<Row>& all, std::uint64_t seed, std::vector<std::vector<AcgScore>>& out,
              std::mutex& mutex) {
  std::map<std::pair<double, double>, Result<AcgProblem>> problems;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const AcgScenario& s = all[i].scenario;
    auto problem = problems.find({s.stretch, s.missing_share});
    if (problem == problems.end())
      problem = problems.emplace(std::pair(s.stretch, s.missing_share), make_acg_problem(s, seed)).first;
    const double begin = cpu_now_s();
    const auto score =
        problem->second ? run_acg(s, *problem->second, seed, all[i].method) : Result<AcgScore>(problem->second.error());
    const std::lock_guard lock(mutex);
    if (score) out[i].push_back(*score);
    std::fprintf(stderr, "%s, seed %d: done in %.1f s\n", s.name.c_str(), static_cast<int>(seed), cpu_now_s() - begin);
    if (score && score->turned.layout_wall >= 0)
      std::fprintf(stderr, "%s, seed %d: wall %d (%.1f m, %s) turned most, %.1f deg at node %zu\n", s.name.c_str(),
                   static_cast<int>(seed), score->turned.layout_wall, score->turned.length_m,
                   to_string(score->turned.state), score->turned_deg, score->turned.nodes);
    if (!score)
      std::fprintf(stderr, "%s, seed %d: %s\n", s.name.c_str(), static_cast<int>(seed), score.error().message.c_str());
    if (score && !score->success && all[i].method == AcgMethod::kOurs)
      std::fprintf(stderr, "%s, seed %d fails: pose %.2f m, corners %.2f m\n", s.name.c_str(), static_cast<int>(seed),
                   score->pose_m, score->seen_m);
  }
}

}  // namespace

int main(int argc, char** argv) {
  int seeds = 10, first = 1;
  bool no_published = false, list = false;
  std::string only, data, json_path;
  BenchOptions("The Auto-Complete Graph, white box: plan and robot map correct each other")
      .number("--seeds", seeds, "how many")
      .number("--first", first, "seed")
      .text("--rows", only, "those with this in their name")
      .flag("--list", list, "names of the rows")
      .flag("--no-published", no_published, "without the published graphs")
      .text("--data", data, "folder with acg and floor_plans")
      .text("--json", json_path, "file for the table")
      .read(argc, argv);
  std::ofstream json;
  if (!json_path.empty()) json.open(json_path);
  std::vector<Row> wanted;
  for (const Row& row : rows(!no_published))
    if (row.scenario.name.find(only) != std::string::npos) wanted.push_back(row);
  if (list) {
    for (const Row& row : wanted) std::printf("%s\n", row.scenario.name.c_str());
    for (const std::string& name : data_rows()) std::printf("%s (with --data)\n", name.c_str());
    return 0;
  }
  std::vector<std::vector<AcgScore>> scores(wanted.size());
  std::mutex mutex;
  std::atomic<int> next{first};
  const auto work = [&] {
    for (int seed = next++; seed < first + seeds && !wanted.empty(); seed = next++)
      run_seed(wanted, static_cast<std::uint64_t>(seed), scores, mutex);
  };
  std::thread other(work);
  work();
  other.join();
  std::printf("%-46s %3s %4s", "median (worst)", "n", "ok");
  for (const Column& c : kColumns) std::printf("  %14s", c.name);
  std::printf("\n");
  for (std::size_t i = 0; i < wanted.size(); ++i) print_row(wanted[i].scenario.name, scores[i], json);
  if (!data.empty()) print_data_rows(data, only);
}
