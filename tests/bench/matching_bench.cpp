// Matching and point transfer over judged maps and generated sketches:
//   ./run bench matching [--data DIR] [--generated N] [--taps N] [--method structure|ursim|voronoi]
//                        [--regions matching|default] [--every]
// DIR holds folders KTH, E5_on_08, ... with gt/*.json; without it only generated sketches (seeds 1, 2, ...) are used,
// which the confidences were not fitted to (those have seeds from 1000 on). --regions compares ways of splitting free
// space: the one matching uses and the default of `smokemap segment`.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "segmentation/constriction.hpp"
#include "segmentation/segment.hpp"
#include "tests/bench/matching_figures.hpp"

int main(int argc, char** argv) {
  using namespace smokemap;
  std::string data, method = "structure", regions = "matching";
  int generated = 30;
  std::vector<int> taps = {0, 1, 2};
  bool every = false;
  for (int i = 1; i < argc; ++i) {
    const bool more = i + 1 < argc;
    if (std::strcmp(argv[i], "--every") == 0) every = true;
    if (std::strcmp(argv[i], "--data") == 0 && more) data = argv[++i];
    if (std::strcmp(argv[i], "--method") == 0 && more) method = argv[++i];
    if (std::strcmp(argv[i], "--regions") == 0 && more) regions = argv[++i];
    if (std::strcmp(argv[i], "--generated") == 0 && more) generated = std::atoi(argv[++i]);
    if (std::strcmp(argv[i], "--taps") == 0 && more) taps = {std::atoi(argv[++i])};
  }
  MatchParams params;
  if (method == "ursim") params.method = MatchMethod::kUrsim;
  if (method == "voronoi") params.method = MatchMethod::kVoronoi;
  const bench::Segmenter segmenter = [&](const cv::Mat& free_space) {
    return regions == "default" ? segment(free_space)
                                : segment_by_constrictions(free_space, matching_segmentation_params());
  };
  if (!data.empty()) {
    const auto judged = bench::read_judged_sets(data, segmenter);
    if (!judged) {
      std::printf("%s\n", judged.error().message.c_str());
      return 1;
    }
    bench::print_matching_figures(*judged, taps, params, every);
  }
  if (generated > 0)
    bench::print_matching_figures(bench::generated_pairs(generated, 1, segmenter), taps, params, every);
  return 0;
}
