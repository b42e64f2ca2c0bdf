// Matching and point transfer over judged maps and generated sketches:
//   ./run bench matching [--data DIR] [--generated N] [--taps N] [--method structure|ursim|voronoi]
//                        [--regions matching|default] [--every]
// DIR holds folders KTH, E5_on_08, ... with gt/*.json; without it only generated sketches (seeds 1, 2, ...) are used,
// which the confidences were not fitted to (those have seeds from 1000 on). --regions compares ways of splitting free
// space: the one matching uses and the default of `smokemap segment`.
#include <cstdio>
#include <string>

#include "segmentation/constriction.hpp"
#include "segmentation/segment.hpp"
#include "tests/bench/bench_options.hpp"
#include "tests/bench/matching_figures.hpp"

int main(int argc, char** argv) {
  using namespace smokemap;
  std::string data, method = "structure", regions = "matching";
  int generated = 30, only_taps = -1;
  bool every = false;
  bench::BenchOptions("Matching and point transfer over judged maps and generated sketches")
      .text("--data", data, "folder with judged maps")
      .number("--generated", generated, "sketches")
      .number("--taps", only_taps, "of a person before matching; -1: none, one and two")
      .text("--method", method, "structure, ursim or voronoi")
      .text("--regions", regions, "matching or default")
      .flag("--every", every, "a line for each map")
      .read(argc, argv);
  const std::vector<int> taps = only_taps < 0 ? std::vector<int>{0, 1, 2} : std::vector<int>{only_taps};
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
