// All figures of reading maps in one run: rooms, pairs of rooms, points carried over, how sure, how long, how much
// memory.
//   ./run bench interpretation [--data DIR] [--generated N] [--every]
// DIR may hold segmentation/ (see segmentation_figures.hpp) and sketch_matching/ (see judged_pairs.hpp); without it all
// maps are generated. One thread's CPU time.
#include <sys/resource.h>

#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "segmentation/constriction.hpp"
#include "tests/bench/bench_options.hpp"
#include "tests/bench/foreign_figures.hpp"
#include "tests/bench/matching_figures.hpp"
#include "tests/bench/segmentation_figures.hpp"
#include "tests/bench/stability_figures.hpp"

namespace {

using namespace smokemap;

const std::vector<int> kTaps = {0, 1, 2};

Result<Segmentation> segment_for_matching(const cv::Mat& free_space) {
  return segment_by_constrictions(free_space, matching_segmentation_params());
}

void print_methods(const std::vector<bench::JudgedPair>& pairs, bool every) {
  bench::print_matching_figures(pairs, kTaps, {}, every);
  std::printf("  tapped where matching asks\n");
  bench::print_matching_figures(pairs, {1, 2}, {}, false, bench::Taps::kAsked);
  for (const auto& [name, method] : {std::pair("ursim", MatchMethod::kUrsim), {"voronoi", MatchMethod::kVoronoi}}) {
    std::printf("  as published: %s\n", name);
    MatchParams published;
    published.method = method;
    bench::print_matching_figures(pairs, {0}, published, false);
  }
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

Result<Ok> print_judged(const std::filesystem::path& data, bool every) {
  if (std::filesystem::is_directory(data / "segmentation")) {
    std::printf("\nRooms on judged maps\n");
    const Result<Ok> done = bench::print_judged_segmentation((data / "segmentation").string(), every);
    if (!done) return done;
    std::printf("\nThe same rooms on a map that is a little different\n");
    const Result<Ok> same = bench::print_stability((data / "segmentation").string());
    if (!same) return same;
  }
  if (!std::filesystem::is_directory(data / "sketch_matching")) return Ok{};
  std::printf("\nPairs and points on judged maps\n");
  const auto judged = bench::read_judged_sets((data / "sketch_matching").string(), segment_for_matching);
  if (!judged) return judged.error();
  print_methods(*judged, every);
  std::printf("\nIs the sketch of this building at all?\n");
  std::vector<Segmentation> others;
  if (std::filesystem::is_directory(data / "segmentation" / "robot_maps")) {
    auto maps = bench::read_robot_maps((data / "segmentation").string(), segment_for_matching);
    if (!maps) return maps.error();
    others = std::move(*maps);
  }
  bench::print_foreign_figures(*judged, others);
  return Ok{};
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  std::string data;
  int generated = 40;
  bool every = false;
  bench::BenchOptions("All figures of reading maps: rooms, pairs of rooms, points carried over, how sure, how long")
      .text("--data", data, "folder with segmentation and sketch_matching")
      .number("--generated", generated, "sketches")
      .flag("--every", every, "a line for each map")
      .read(argc, argv);
  std::printf("Rooms on generated plans\n");
  bench::print_generated_segmentation();
  std::printf("\nPairs and points on generated sketches (seeds 1 to %d and on)\n", generated);
  const auto sketches = bench::generated_pairs(generated, 1, segment_for_matching);
  print_methods(sketches, every);
  std::printf("\nIs the sketch of this building at all?\n");
  bench::print_foreign_figures(sketches, {});
  std::printf("\nThe same with stubs of walls in both maps, which split rooms\n");
  const auto stubs = bench::generated_pairs(generated, 1, segment_for_matching, bench::Wear::kStubs);
  bench::print_matching_figures(stubs, kTaps, {}, false);
  bench::print_foreign_figures(stubs, {});
  const Result<Ok> done = data.empty() ? Result<Ok>(Ok{}) : print_judged(data, every);
  if (!done) std::printf("%s\n", done.error().message.c_str());
  std::printf("\npeak memory of all this %.0f MB\n", peak_mb());
  return done ? 0 : 1;
}
