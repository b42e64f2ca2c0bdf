// How well and how fast free space is split into rooms: ./run bench segmentation [--data DIR] [--every]
// Random office plans with known rooms (seeds 1 to 12), clean, with chairs, with rough walls, and turned; with --data
// also the maps of DIR/{robot_maps, robot_maps_survey, sketches}. Ours beside MAORIS. One thread's CPU time.
#include <cstdio>
#include <cstring>
#include <opencv2/core.hpp>
#include <string>

#include "tests/bench/segmentation_figures.hpp"

int main(int argc, char** argv) {
  using namespace smokemap;
  cv::setNumThreads(1);
  std::string data;
  bool every = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--every") == 0) every = true;
    if (std::strcmp(argv[i], "--data") == 0 && i + 1 < argc) data = argv[++i];
  }
  bench::print_generated_segmentation();
  if (data.empty()) return 0;
  const Result<Ok> done = bench::print_judged_segmentation(data, every);
  if (!done) std::printf("%s\n", done.error().message.c_str());
  return done ? 0 : 1;
}
