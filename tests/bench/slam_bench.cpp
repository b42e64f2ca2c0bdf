// slam_bench [LOG...]: one line a log: scans, CPU seconds of the parts, time per scan, nodes, loops.
// Without arguments nothing is read and nothing printed but the head: the scores come from `smokemap evaluate`.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <variant>
#include <vector>

#include "recording/sensor_log.hpp"
#include "slam/slam.hpp"

namespace {

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void run(const char* path) {
  const auto log = smokemap::read_log(path);
  if (!log) {
    std::printf("%s: %s\n", path, log.error().message.c_str());
    return;
  }
  smokemap::Slam slam;
  std::vector<double> scan_ms;
  double graph_s = 0;
  for (const smokemap::LogItem& item : log->items) {
    if (const auto* odometry = std::get_if<smokemap::Odometry>(&item)) slam.add_odometry(*odometry);
    const auto* scan = std::get_if<smokemap::LaserScan>(&item);
    if (!scan) continue;
    const double begin = cpu_s();
    if (!slam.add_scan(*scan)) continue;
    scan_ms.push_back(1e3 * (cpu_s() - begin));
    if (scan_ms.size() % 20 != 0) continue;
    const double solve_begin = cpu_s();
    slam.optimize();
    graph_s += cpu_s() - solve_begin;
  }
  const double polish_begin = cpu_s();
  slam.polish();
  const double polish_s = cpu_s() - polish_begin;
  if (scan_ms.empty()) return;
  std::sort(scan_ms.begin(), scan_ms.end());
  double front_s = 0;
  for (const double ms : scan_ms) front_s += ms / 1e3;
  std::printf("%-40s %6zu %8.2f %8.2f %8.2f %8.2f %8.2f %6zu %4lld/%lld\n", path, scan_ms.size(), front_s, graph_s,
              polish_s, scan_ms[scan_ms.size() / 2], scan_ms[scan_ms.size() * 99 / 100], slam.graph().nodes.size(),
              static_cast<long long>(slam.counters().loops_closed),
              static_cast<long long>(slam.counters().loops_rejected));
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("%-40s %6s %8s %8s %8s %8s %8s %6s %s\n", "log", "scans", "front s", "graph s", "polish s", "p50 ms",
              "p99 ms", "nodes", "loops closed/refused");
  for (int i = 1; i < argc; ++i) run(argv[i]);
}
