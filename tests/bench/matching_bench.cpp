// Matching and point transfer over judged maps and generated sketches: ./run bench matching [--data DIR] [--generated
// N]
// [--taps N] [--method structure|ursim|voronoi] [--every]
// DIR holds folders KTH, E5_on_08, ... with gt/*.json; without it only generated sketches (seeds 1, 2, ...) are used,
// which the confidences were not fitted to (those have seeds from 1000 on).
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "tests/bench/matching_figures.hpp"

int main(int argc, char** argv) {
  using namespace smokemap;
  std::string data, method = "structure";
  int generated = 30;
  std::vector<int> taps = {0, 1, 2};
  bool every = false;
  for (int i = 1; i < argc; ++i) {
    const bool more = i + 1 < argc;
    if (std::strcmp(argv[i], "--every") == 0) every = true;
    if (std::strcmp(argv[i], "--data") == 0 && more) data = argv[++i];
    if (std::strcmp(argv[i], "--method") == 0 && more) method = argv[++i];
    if (std::strcmp(argv[i], "--generated") == 0 && more) generated = std::atoi(argv[++i]);
    if (std::strcmp(argv[i], "--taps") == 0 && more) taps = {std::atoi(argv[++i])};
  }
  MatchParams params;
  if (method == "ursim") params.method = MatchMethod::kUrsim;
  if (method == "voronoi") params.method = MatchMethod::kVoronoi;
  const ConstrictionParams segmentation = matching_segmentation_params();
  if (!data.empty()) {
    std::vector<bench::JudgedPair> judged;
    for (const char* set : {"KTH", "E5_on_08", "E5_on_10"}) {
      if (!std::filesystem::is_directory(std::filesystem::path(data) / set)) continue;
      auto pairs = bench::read_judged_pairs(data, set, segmentation);
      if (!pairs) {
        std::printf("%s\n", pairs.error().message.c_str());
        return 1;
      }
      judged.insert(judged.end(), pairs->begin(), pairs->end());
    }
    if (!judged.empty()) bench::print_matching_figures(judged, taps, params, every);
  }
  if (generated > 0)
    bench::print_matching_figures(bench::generated_pairs(generated, 1, segmentation), taps, params, every);
  return 0;
}
