#include "tests/bench/stability_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "core/random.hpp"
#include "segmentation/segment.hpp"
#include "tests/bench/segmentation_figures.hpp"

namespace smokemap::bench {
namespace {

constexpr size_t kMostMaps = 12;
constexpr double kMostMegapixels = 1;
constexpr double kNoise = 0.25;  ///< share of pixels beside a wall that change sides

/// The map changed, and what takes labels of the changed map back.
struct Change {
  cv::Mat map;
  std::function<cv::Mat(const cv::Mat&)> back;
};

Change with_noise(const cv::Mat& map) {
  std::mt19937_64 random(1);
  cv::Mat changed = map.clone(), grown, shrunk;
  cv::dilate(map, grown, cv::Mat());
  cv::erode(map, shrunk, cv::Mat());
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.cols; ++x) {
      const bool at_a_wall = grown.at<uchar>(y, x) != shrunk.at<uchar>(y, x);
      if (at_a_wall && uniform01(random) < kNoise)
        changed.at<uchar>(y, x) = static_cast<uchar>(255 - map.at<uchar>(y, x));
    }
  return {changed, [](const cv::Mat& labels) { return labels; }};
}

Change turned_by_a_quarter(const cv::Mat& map) {
  cv::Mat turned;
  cv::rotate(map, turned, cv::ROTATE_90_CLOCKWISE);
  return {turned, [](const cv::Mat& labels) {
            cv::Mat back;
            cv::rotate(labels, back, cv::ROTATE_90_COUNTERCLOCKWISE);
            return back;
          }};
}

Change turned_aslant(const cv::Mat& map) {
  const int side = static_cast<int>(std::hypot(map.cols, map.rows)) + 2;
  cv::Mat motion =
      cv::getRotationMatrix2D({0.5F * static_cast<float>(map.cols), 0.5F * static_cast<float>(map.rows)}, 7, 1);
  motion.at<double>(0, 2) += 0.5 * (side - map.cols);
  motion.at<double>(1, 2) += 0.5 * (side - map.rows);
  cv::Mat turned;
  cv::warpAffine(map, turned, motion, {side, side}, cv::INTER_NEAREST);
  return {turned, [motion, size = map.size()](const cv::Mat& labels) {
            cv::Mat back;
            cv::warpAffine(labels, back, motion, size, cv::INTER_NEAREST | cv::WARP_INVERSE_MAP);
            return back;
          }};
}

struct StabilitySums {
  double score = 0, worst = 1, before = 0, after = 0;
  int maps = 0;

  void add(const Segmentation& as_is, const Change& change) {
    const auto again = segment(change.map);
    const double same = again ? strict_score(change.back(again->labels), as_is.labels) : 0;
    score += same, worst = std::min(worst, same), maps += 1;
    before += static_cast<double>(as_is.regions.size());
    after += again ? static_cast<double>(again->regions.size()) : 0;
  }
};

}  // namespace

Result<Ok> print_stability(const std::string& folder) {
  using Changer = std::pair<const char*, Change (*)(const cv::Mat&)>;
  const std::array<Changer, 3> changes = {Changer{"a pixel of noise", with_noise},
                                          Changer{"turned by 90 degrees", turned_by_a_quarter},
                                          Changer{"turned by 7 degrees", turned_aslant}};
  std::printf("%-12s %-22s %5s %12s %7s %18s\n", "set", "change", "maps", "strict mean", "worst", "regions");
  for (const char* set : {"robot_maps", "sketches"}) {
    const std::filesystem::path where = std::filesystem::path(folder) / set;
    if (!std::filesystem::is_directory(where)) continue;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(where))
      if (std::filesystem::exists(entry.path() / "map.png")) files.push_back(entry.path() / "map.png");
    std::sort(files.begin(), files.end());
    std::array<StabilitySums, 3> sums;
    for (const auto& file : files) {
      if (static_cast<size_t>(sums[0].maps) >= kMostMaps) break;
      const auto map = free_space_of_picture(cv::imread(file.string(), cv::IMREAD_GRAYSCALE));
      if (!map) return fail(map.error().code, file.string() + ": " + map.error().message);
      if (1e-6 * static_cast<double>(map->total()) > kMostMegapixels) continue;
      const auto as_is = segment(*map);
      if (!as_is) return fail(as_is.error().code, file.string() + ": " + as_is.error().message);
      for (size_t i = 0; i < changes.size(); ++i) sums[i].add(*as_is, changes[i].second(*map));
    }
    for (size_t i = 0; i < changes.size() && sums[i].maps > 0; ++i)
      std::printf("%-12s %-22s %5d %12.3f %7.3f %8.1f -> %6.1f\n", set, changes[i].first, sums[i].maps,
                  sums[i].score / sums[i].maps, sums[i].worst, sums[i].before / sums[i].maps,
                  sums[i].after / sums[i].maps);
  }
  std::fflush(stdout);
  return Ok{};
}

}  // namespace smokemap::bench
