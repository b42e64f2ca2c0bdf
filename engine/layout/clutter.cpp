#include "layout/clutter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace smokemap {
namespace {

constexpr double kTallestLetter = 0.06;  ///< of the long side
constexpr double kUsualLetter = 0.018;   ///< larger ones are titles, and stand alone
constexpr int kSmallestLetterPx = 5;
constexpr double kLetterGap = 0.5;      ///< of the letter height: words are wider apart, walls between doors too
constexpr double kLargestBlock = 0.05;  ///< of the long side: signs; larger are headers
constexpr double kLargestHole = 0.02;   ///< of the long side: the white part of a pictogram

struct InkPiece {
  int label = 0;
  cv::Rect box;
  int area = 0;
  bool is_bar = false;
};

class RowFinder {
 public:
  RowFinder(const std::vector<InkPiece>& pieces, const cv::Mat& ink)
      : pieces_(pieces), ink_(ink), row_(pieces.size()) {}

  /// Marks the members of rows along x, or along y.
  void mark(bool along_y, std::vector<bool>& is_letter) {
    std::iota(row_.begin(), row_.end(), std::size_t{0});
    std::vector<std::size_t> order(row_);
    const auto begin = [&](std::size_t i) { return along_y ? pieces_[i].box.y : pieces_[i].box.x; };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return begin(a) < begin(b); });
    int widest = 0;
    for (const auto& p : pieces_) widest = std::max(widest, along_y ? p.box.height : p.box.width);
    for (std::size_t a = 0; a < order.size(); ++a)
      for (std::size_t b = a + 1; b < order.size() && begin(order[b]) - begin(order[a]) < 2 * widest; ++b)
        if (in_one_row(pieces_[order[a]].box, pieces_[order[b]].box, along_y)) join(order[a], order[b]);
    std::vector<Row> rows(pieces_.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      Row& row = rows[root(i)];
      const cv::Rect& box = pieces_[i].box;
      row.members += 1;
      row.shaped += !pieces_[i].is_bar;
      row.area += pieces_[i].area;
      row.height = std::max(row.height, along_y ? box.width : box.height);
      row.box = row.box.empty() ? box : row.box | box;
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (root(i) == i) rows[i].is_text = reads_as_text(rows[i]);
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (rows[root(i)].is_text) is_letter[i] = true;
  }

 private:
  struct Row {
    int members = 0, shaped = 0, area = 0, height = 0;
    cv::Rect box;
    bool is_text = false;
  };

  /// Large rows must stand alone: pieces of walls between doors have leaves and other walls about them.
  bool reads_as_text(const Row& row) const {
    if (row.members < 3 || row.shaped < 2 || 3 * row.shaped < row.members) return false;
    if (row.height <= kUsualLetter * std::max(ink_.rows, ink_.cols)) return true;
    const int margin = static_cast<int>(0.3 * row.height);
    const cv::Rect around =
        cv::Rect(row.box.x - margin, row.box.y - margin, row.box.width + 2 * margin, row.box.height + 2 * margin) &
        cv::Rect(0, 0, ink_.cols, ink_.rows);
    return cv::countNonZero(ink_(around)) < 1.05 * row.area;
  }

  static bool in_one_row(const cv::Rect& a, const cv::Rect& b, bool along_y) {
    const auto turned = [&](const cv::Rect& r) { return along_y ? cv::Rect(r.y, r.x, r.height, r.width) : r; };
    const cv::Rect p = turned(a), q = turned(b);
    const double tall = std::max(p.height, q.height), low = std::min(p.height, q.height);
    if (low < 0.45 * tall) return false;
    const double aside = std::abs((p.y + 0.5 * p.height) - (q.y + 0.5 * q.height));
    const double gap = q.x - (p.x + p.width);
    return aside < 0.45 * tall && gap < kLetterGap * tall && gap > -0.4 * tall;
  }
  std::size_t root(std::size_t i) {
    while (row_[i] != i) i = row_[i] = row_[row_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { row_[std::max(root(a), root(b))] = std::min(root(a), root(b)); }

  const std::vector<InkPiece>& pieces_;
  const cv::Mat& ink_;
  std::vector<std::size_t> row_;  ///< parent in the union of rows
};

/// Ink with small enclosed spots of paper filled.
cv::Mat without_holes(const cv::Mat& ink, double largest_px) {
  cv::Mat labels, stats, centroids;
  const cv::Mat paper = ink == 0;
  const int count = cv::connectedComponentsWithStats(paper, labels, stats, centroids, 4, CV_32S);
  std::vector<std::uint8_t> fill(static_cast<std::size_t>(count), 0);
  for (int label = 1; label < count; ++label) {
    const double extent = std::max(stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT));
    fill[static_cast<std::size_t>(label)] = extent <= largest_px;
  }
  cv::Mat filled = ink.clone();
  for (int y = 0; y < ink.rows; ++y)
    for (int x = 0; x < ink.cols; ++x)
      if (fill[static_cast<std::size_t>(labels.at<int>(y, x))]) filled.at<std::uint8_t>(y, x) = 255;
  return filled;
}

}  // namespace

cv::Mat find_text(const cv::Mat& ink) {
  const double side = std::max(ink.rows, ink.cols);
  cv::Mat labels, stats, centroids;
  const int count = cv::connectedComponentsWithStats(ink, labels, stats, centroids, 8, CV_32S);
  std::vector<InkPiece> pieces;
  for (int label = 1; label < count; ++label) {
    const cv::Rect box(stats.at<int>(label, cv::CC_STAT_LEFT), stats.at<int>(label, cv::CC_STAT_TOP),
                       stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT));
    const int large = std::max(box.width, box.height), small = std::min(box.width, box.height);
    if (large < kSmallestLetterPx || large > kTallestLetter * side) continue;
    const int area = stats.at<int>(label, cv::CC_STAT_AREA);
    const double filled = static_cast<double>(area) / box.area();
    pieces.push_back({label, box, area, filled > 0.6 && large > 2 * small});
  }
  std::vector<bool> is_letter(pieces.size(), false);
  RowFinder rows(pieces, ink);
  rows.mark(false, is_letter);
  rows.mark(true, is_letter);
  std::vector<std::uint8_t> erase(static_cast<std::size_t>(count), 0);
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (is_letter[i]) erase[static_cast<std::size_t>(pieces[i].label)] = 255;
  cv::Mat text(ink.size(), CV_8UC1);
  for (int y = 0; y < ink.rows; ++y)
    for (int x = 0; x < ink.cols; ++x)
      text.at<std::uint8_t>(y, x) = erase[static_cast<std::size_t>(labels.at<int>(y, x))];
  return text;
}

cv::Mat find_blocks(const cv::Mat& ink, double wall_px) {
  const double side = std::max(ink.rows, ink.cols);
  const int least = std::max(3, static_cast<int>(std::lround(std::max(1.8 * wall_px, 0.005 * side))));
  const auto box = [](int size) { return cv::getStructuringElement(cv::MORPH_RECT, {size, size}); };
  cv::Mat solid;
  cv::morphologyEx(without_holes(ink, kLargestHole * side), solid, cv::MORPH_OPEN, box(least));
  cv::morphologyEx(solid, solid, cv::MORPH_CLOSE, box(std::max(3, static_cast<int>(0.006 * side))));  // open pictograms
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(solid, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
  cv::Mat blocks = cv::Mat::zeros(ink.size(), CV_8UC1);
  const int rim = 2 + static_cast<int>(0.15 * wall_px);
  for (const auto& outline : outlines) {
    const cv::RotatedRect around = cv::minAreaRect(outline);
    const double large = std::max(around.size.width, around.size.height) + 1,
                 small = std::min(around.size.width, around.size.height) + 1;
    if (large > kLargestBlock * side || large > 3 * small) continue;
    std::vector<cv::Point> hull;
    cv::convexHull(outline, hull);
    cv::fillConvexPoly(blocks, hull, cv::Scalar(255));
    cv::polylines(blocks, std::vector<std::vector<cv::Point>>{hull}, true, cv::Scalar(255), 2 * rim);
  }
  return blocks;
}

}  // namespace smokemap
