#include "sketch/figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace smokemap {
namespace {

constexpr double kLetterShare = 0.12;   ///< letters are smaller than this share of the drawing
constexpr double kWordShare = 0.4;      ///< and joined-up words than this
constexpr double kLetterWidth = 0.3;    ///< a figure narrower than this share of its height is a stroke
constexpr double kStraightShare = 0.4;  ///< of its longer side; a figure with a longer straight stroke is no word
constexpr std::size_t kWordBranches = 4;

/// Connected ink.
struct Figures {
  cv::Mat labels;               ///< CV_32SC1, 0 = paper
  std::vector<cv::Rect> boxes;  ///< by label; [0] is the paper
  std::size_t largest = 0;

  explicit Figures(const cv::Mat& mask) {
    cv::Mat stats, centroids;
    const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids, 8);
    for (int label = 0; label < count; ++label)
      boxes.emplace_back(stats.at<int>(label, cv::CC_STAT_LEFT), stats.at<int>(label, cv::CC_STAT_TOP),
                         stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT));
    for (std::size_t label = 1; label < boxes.size(); ++label)
      if (largest == 0 || boxes[label].area() > boxes[largest].area()) largest = label;
  }
  double side() const { return std::max(boxes[largest].width, boxes[largest].height); }

  void keep(cv::Mat& mask, const std::vector<uchar>& is_kept) const {
    for (int y = 0; y < mask.rows; ++y)
      for (int x = 0; x < mask.cols; ++x)
        if (const int label = labels.at<int>(y, x); label > 0 && !is_kept[static_cast<std::size_t>(label)])
          mask.at<uchar>(y, x) = 0;
  }
};

/// Beside each other in a row, or one above the other in a column, less than a letter apart.
bool are_neighbours(const cv::Rect& one, const cv::Rect& two) {
  const int tall = std::max(one.height, two.height), small = std::min(one.height, two.height);
  if (2 * small < tall) return false;
  const int between = std::max(one.x, two.x) - std::min(one.x + one.width, two.x + two.width);
  const int shift = std::abs((one.y + one.y + one.height) - (two.y + two.y + two.height)) / 2;
  return between < tall && 2 * shift < tall;
}

/// Longest straight piece of a line.
double longest_piece(const std::vector<cv::Point>& points, double tolerance_px) {
  std::vector<cv::Point> simple;
  cv::approxPolyDP(points, simple, tolerance_px, false);
  double longest = 0;
  for (std::size_t i = 0; i + 1 < simple.size(); ++i) longest = std::max(longest, cv::norm(simple[i + 1] - simple[i]));
  return longest;
}

}  // namespace

void drop_small_figures(cv::Mat& mask, double dot_px, double text_px) {
  const Figures figures(mask);
  if (figures.boxes.size() < 2) return;
  const cv::Rect drawing = figures.boxes[figures.largest];
  std::vector<uchar> keep(figures.boxes.size(), 0);
  for (std::size_t label = 1; label < keep.size(); ++label) {
    const cv::Rect b = figures.boxes[label];
    const double side = std::max(b.width, b.height), small = std::min(b.width, b.height);
    const bool apart = (b & drawing).area() < 0.5 * b.area();
    const bool word = apart && side < 0.45 * std::max(drawing.width, drawing.height);
    const bool letter = side < text_px && small > 0.35 * side;
    keep[label] = label == figures.largest || (side >= dot_px && !word && !letter);
  }
  figures.keep(mask, keep);
}

void drop_rows_of_letters(cv::Mat& mask) {
  const Figures figures(mask);
  if (figures.boxes.size() < 3) return;
  std::vector<std::size_t> letters;
  for (std::size_t label = 1; label < figures.boxes.size(); ++label) {
    const cv::Rect& b = figures.boxes[label];
    const double side = std::max(b.width, b.height), small = std::min(b.width, b.height);
    if (label != figures.largest && side < kLetterShare * figures.side() && small > kLetterWidth * side)
      letters.push_back(label);
  }
  std::vector<uchar> keep(figures.boxes.size(), 1);
  for (const std::size_t one : letters)
    for (const std::size_t two : letters)
      if (one != two && are_neighbours(figures.boxes[one], figures.boxes[two])) keep[one] = keep[two] = 0;
  std::vector<uchar> beside = keep;  // an i, l or 1 in a row of letters
  for (std::size_t label = 1; label < keep.size(); ++label)
    for (const std::size_t letter : letters)
      if (label != figures.largest && !keep[letter] && are_neighbours(figures.boxes[label], figures.boxes[letter]))
        beside[label] = 0;
  figures.keep(mask, beside);
}

std::size_t drop_words(const cv::Mat& mask, std::vector<SkeletonBranch>& branches) {
  const Figures figures(mask);
  if (figures.boxes.size() < 3) return 0;
  std::vector<double> straight(figures.boxes.size(), 0);
  std::vector<std::size_t> count(figures.boxes.size(), 0);
  const auto label_of = [&](const SkeletonBranch& b) {
    return static_cast<std::size_t>(figures.labels.at<int>(b.points[b.points.size() / 2]));
  };
  for (const SkeletonBranch& b : branches) {
    const std::size_t label = label_of(b);
    const double side = std::max(figures.boxes[label].width, figures.boxes[label].height);
    straight[label] = std::max(straight[label], longest_piece(b.points, 0.03 * side));
    ++count[label];
  }
  std::size_t words = 0;
  std::vector<bool> is_word(figures.boxes.size(), false);
  for (std::size_t label = 1; label < figures.boxes.size(); ++label) {
    const double side = std::max(figures.boxes[label].width, figures.boxes[label].height);
    is_word[label] = label != figures.largest && side < kWordShare * figures.side() &&
                     straight[label] < kStraightShare * side && count[label] >= kWordBranches;
    words += is_word[label];
  }
  std::erase_if(branches, [&](const SkeletonBranch& b) { return is_word[label_of(b)]; });
  return words;
}

}  // namespace smokemap
