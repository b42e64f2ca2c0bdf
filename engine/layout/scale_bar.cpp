// Idea: along a scale bar the ink of its columns goes up and down at even distances: boxes filled in turns, or ticks on
// a line. Nothing else that stands alone on a sheet and is that slim does.
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "layout/scale.hpp"

namespace smokemap {
namespace {

constexpr double kShortestBar = 0.03, kLongestBar = 0.35;  ///< of the long side
constexpr double kThickestBar = 0.02;
constexpr double kSlim = 5;          ///< times as long as thick
constexpr double kAlike = 0.08;      ///< divisions differ by less, relative
constexpr double kTickWidth = 0.25;  ///< of a division: narrower is a tick, wider a box

/// Ink of every column of a component, over that of its fullest ones.
std::vector<double> column_profile(const cv::Mat& labels, int label, const cv::Rect& box, bool along_y) {
  const int length = along_y ? box.height : box.width, across = along_y ? box.width : box.height;
  std::vector<double> ink(static_cast<std::size_t>(length), 0.0);
  for (int c = 0; c < length; ++c)
    for (int r = 0; r < across; ++r)
      ink[static_cast<std::size_t>(c)] += labels.at<int>(box.y + (along_y ? c : r), box.x + (along_y ? r : c)) == label;
  std::vector<double> sorted = ink;
  std::sort(sorted.begin(), sorted.end());
  const double full = std::max(1.0, sorted[sorted.size() * 97 / 100]);
  for (double& value : ink) value = std::min(1.0, value / full);
  return ink;
}

struct Run {
  int begin = 0, end = 0;
  int length() const { return end - begin; }
};

std::vector<Run> full_runs(const std::vector<double>& profile) {
  std::vector<Run> runs;
  for (int c = 0; c < static_cast<int>(profile.size()); ++c) {
    if (profile[static_cast<std::size_t>(c)] < 0.7) continue;
    if (!runs.empty() && runs.back().end == c)
      runs.back().end = c + 1;
    else
      runs.push_back({c, c + 1});
  }
  return runs;
}

/// The distance that all neighbours have; three at least.
std::optional<double> even_distance(const std::vector<double>& places) {
  if (places.size() < 4) return std::nullopt;
  const double mean = (places.back() - places.front()) / static_cast<double>(places.size() - 1);
  for (std::size_t i = 1; i < places.size(); ++i)
    if (std::abs(places[i] - places[i - 1] - mean) > kAlike * mean + 1.5) return std::nullopt;
  return mean;
}

std::optional<double> division_of(const std::vector<double>& profile) {
  const auto runs = full_runs(profile);
  if (runs.size() < 2) return std::nullopt;
  const double length = static_cast<double>(profile.size());
  int widest = 0;
  for (const auto& run : runs) widest = std::max(widest, run.length());
  std::vector<double> places;
  if (widest < kTickWidth * length / static_cast<double>(runs.size())) {  // ticks
    for (const auto& run : runs) places.push_back(0.5 * (run.begin + run.end));
    if (places.front() > 0.1 * length || places.back() < 0.9 * length) return std::nullopt;
    return even_distance(places);
  }
  const double rim = std::max(3.0, 0.02 * length);  // the outline of an empty box at either end is no box
  places.push_back(0);
  for (const auto& run : runs) {
    if (run.length() <= rim && (run.begin < rim || run.end > length - rim)) continue;
    if (run.begin > rim) places.push_back(run.begin);
    if (run.end < length - rim) places.push_back(run.end);
  }
  places.push_back(length);
  return even_distance(places);
}

}  // namespace

std::optional<double> find_scale_bar(const cv::Mat& ink) {
  const double side = std::max(ink.rows, ink.cols);
  cv::Mat labels, stats, centroids;
  const int count = cv::connectedComponentsWithStats(ink, labels, stats, centroids, 8, CV_32S);
  std::optional<double> division;
  int longest = 0;
  for (int label = 1; label < count; ++label) {
    const cv::Rect box(stats.at<int>(label, cv::CC_STAT_LEFT), stats.at<int>(label, cv::CC_STAT_TOP),
                       stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT));
    const int large = std::max(box.width, box.height), small = std::min(box.width, box.height);
    if (large < kShortestBar * side || large > kLongestBar * side || small < 3 || small > kThickestBar * side ||
        large < kSlim * small || large <= longest)
      continue;
    if (const auto found = division_of(column_profile(labels, label, box, box.height > box.width)))
      division = found, longest = large;
  }
  return division;
}

}  // namespace smokemap
