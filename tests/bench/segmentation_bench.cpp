// How well and how fast free space is split into rooms: ./run bench segmentation [--data DIR] [--every]
// Random office plans with known rooms (seeds 1 to 12), clean, with chairs, with rough walls, and turned; with --data
// also the maps of DIR/{robot_maps, robot_maps_survey, sketches}. Ours beside MAORIS. One thread's CPU time.
#include <cstdio>
#include <opencv2/core.hpp>
#include <string>

#include "tests/bench/bench_options.hpp"
#include "tests/bench/segmentation_figures.hpp"

int main(int argc, char** argv) {
  using namespace smokemap;
  cv::setNumThreads(1);
  std::string data;
  bool every = false;
  bench::BenchOptions("How well and how fast free space is split into rooms")
      .text("--data", data, "folder with robot_maps, robot_maps_survey, sketches")
      .flag("--every", every, "a line for each map")
      .read(argc, argv);
  bench::print_generated_segmentation();
  if (data.empty()) return 0;
  const Result<Ok> done = bench::print_judged_segmentation(data, every);
  if (!done) std::printf("%s\n", done.error().message.c_str());
  return done ? 0 : 1;
}
