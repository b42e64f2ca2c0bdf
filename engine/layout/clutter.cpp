#include "layout/clutter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "layout/ink_stroke.hpp"

namespace smokemap {
namespace {

constexpr double kTallestLetter = 0.06;  ///< of the long side
constexpr double kUsualLetter = 0.018;   ///< larger ones are titles, and stand alone
constexpr int kSmallestLetterPx = 5;
constexpr double kLetterGap = 0.5;         ///< of the letter height: words are wider apart, walls between doors too
constexpr int kLeastLetters = 3;           ///< light ones on a dark bar
constexpr double kLightLetter = 0.7;       ///< of the bar's darkness: blurred ones are not white
constexpr int kLeastWordStrokes = 5;       ///< of letters that blur has made one piece
constexpr double kStrokesPerHeight = 0.8;  ///< along a word, for each of its height
constexpr double kLargestBlock = 0.05;     ///< of the long side: signs; larger are headers
constexpr double kLargestHole = 0.02;      ///< of the long side: the white part of a pictogram

struct InkPiece {
  int label = 0;
  cv::Rect box;
  int area = 0;
  bool is_bar = false;
  int letters = 1;  ///< more where blur has made one piece of a word
};

/// How often a piece begins along its length, at the busiest of a few lines across it: once for a wall, two or three
/// times for the frame of a window, about twice a letter for a word.
int beginnings(const cv::Mat& piece) {
  const bool upright = piece.rows > piece.cols;
  const int length = upright ? piece.rows : piece.cols, across = upright ? piece.cols : piece.rows;
  int most = 0;
  for (const double share : {0.3, 0.5, 0.7}) {
    const int line = std::min(across - 1, static_cast<int>(share * across));
    int count = 0;
    bool on = false;
    for (int i = 0; i < length; ++i) {
      const bool now = (upright ? piece.at<std::uint8_t>(i, line) : piece.at<std::uint8_t>(line, i)) != 0;
      count += now && !on;
      on = now;
    }
    most = std::max(most, count);
  }
  return most;
}

/// Letters of a word that hang together.
int letters_in(const cv::Mat& piece) {
  const int large = std::max(piece.rows, piece.cols), small = std::min(piece.rows, piece.cols);
  const int strokes = beginnings(piece);
  return strokes >= kLeastWordStrokes && kStrokesPerHeight * large < strokes * small ? (strokes + 1) / 2 : 1;
}

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
      row.members += pieces_[i].letters;
      row.shaped += pieces_[i].is_bar ? 0 : pieces_[i].letters;
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

/// Outlines of all pieces, also of those that others surround: in a photograph what is dark around the sheet.
std::vector<std::vector<cv::Point>> outlines_of(const cv::Mat& mask) {
  std::vector<std::vector<cv::Point>> all, outlines;
  std::vector<cv::Vec4i> tree;
  cv::findContours(mask, all, tree, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (tree[i][3] < 0) outlines.push_back(std::move(all[i]));
  return outlines;
}

/// How many letters at least so large the spots could be. Panes of windows in a thick wall are spots too: oblong and
/// filled.
int letters_among(const cv::Mat& spots, double least_px) {
  int letters = 0;
  for (const auto& outline : outlines_of(spots)) {
    const cv::Rect box = cv::boundingRect(outline);
    if (std::max(box.width, box.height) < least_px) continue;
    const cv::RotatedRect around = cv::minAreaRect(outline);
    const double large = std::max(around.size.width, around.size.height) + 1,
                 small = std::min(around.size.width, around.size.height) + 1;
    const bool pane = large > 2 * small && cv::contourArea(outline) > 0.8 * (large - 1) * (small - 1);
    if (!pane) letters += letters_in(spots(box));
  }
  return letters;
}

/// The usual darkness where the mask is set.
double median_within(const cv::Mat& darkness, const cv::Mat& mask) {
  std::array<int, 256> histogram{};
  int all = 0;
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      if (mask.at<std::uint8_t>(y, x)) ++histogram[darkness.at<std::uint8_t>(y, x)], ++all;
  int value = 0;
  for (int below = histogram[0]; value < 255 && 2 * below < all;) below += histogram[static_cast<std::size_t>(++value)];
  return value;
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
    InkPiece piece{label, box, area, filled > 0.6 && large > 2 * small, 1};
    if (small <= kUsualLetter * side && large > 2 * small) piece.letters = letters_in(labels(box) == label);
    piece.is_bar &= piece.letters == 1;
    pieces.push_back(piece);
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

namespace {

/// Share of the circle that lies on ink.
double inked_share(const cv::Mat& ink, const cv::Point2d& centre, double radius) {
  int inked = 0;
  constexpr int kSteps = 72;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2 * CV_PI * i / kSteps;
    const int x = static_cast<int>(std::lround(centre.x + radius * std::cos(angle))),
              y = static_cast<int>(std::lround(centre.y + radius * std::sin(angle)));
    inked += x >= 0 && y >= 0 && x < ink.cols && y < ink.rows && ink.at<std::uint8_t>(y, x) != 0;
  }
  return static_cast<double>(inked) / kSteps;
}

/// Dots ("you are here"), also those hardly wider than a wall: round, and standing alone as no junction of walls does.
void add_dots(cv::Mat& blocks, const cv::Mat& ink, double wall_px, int rim) {
  const double side = std::max(ink.rows, ink.cols);
  const int least = static_cast<int>(std::lround(std::max(1.5 * wall_px, 0.006 * side)));
  cv::Mat discs, labels, stats, centroids;
  cv::morphologyEx(ink, discs, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_ELLIPSE, {least, least}));
  const int count = cv::connectedComponentsWithStats(discs, labels, stats, centroids, 8, CV_32S);
  for (int label = 1; label < count; ++label) {
    const double width = stats.at<int>(label, cv::CC_STAT_WIDTH), height = stats.at<int>(label, cv::CC_STAT_HEIGHT);
    const double filled = stats.at<int>(label, cv::CC_STAT_AREA) / (width * height);
    if (std::max(width, height) > kLargestBlock * side || std::max(width, height) > 1.2 * std::min(width, height))
      continue;
    if (std::abs(filled - CV_PI / 4) > 0.08) continue;
    const cv::Point2d centre(centroids.at<double>(label, 0), centroids.at<double>(label, 1));
    const double radius = 0.5 * std::max(width, height);
    if (inked_share(ink, centre, radius + rim) > 0.3) continue;
    cv::circle(blocks, centre, static_cast<int>(std::lround(radius)) + rim, cv::Scalar(255), cv::FILLED);
  }
}

}  // namespace

cv::Mat find_headers(const cv::Mat& darkness, const LayoutParams& params) {
  const cv::Mat ink = ink_mask(darkness, params);
  const double side = std::max(ink.rows, ink.cols);
  const int frame = static_cast<int>(std::lround(std::max(3.0, 0.006 * side)));  // thinner lines lead away from it
  cv::Mat bars;
  cv::morphologyEx(without_holes(ink, kTallestLetter * side), bars, cv::MORPH_OPEN,
                   cv::getStructuringElement(cv::MORPH_RECT, {frame, frame}));
  cv::Mat headers = cv::Mat::zeros(ink.size(), CV_8UC1);
  for (const auto& outline : outlines_of(bars)) {
    const cv::RotatedRect around = cv::minAreaRect(outline);
    const double large = std::max(around.size.width, around.size.height) + 1,
                 small = std::min(around.size.width, around.size.height) + 1;
    if (small < 0.008 * side || large < 3 * small) continue;
    if (cv::contourArea(outline) < 0.85 * (large - 1) * (small - 1)) continue;
    const cv::Rect box = cv::boundingRect(outline);
    cv::Mat shape = cv::Mat::zeros(box.size(), CV_8UC1);
    cv::fillPoly(shape, std::vector<std::vector<cv::Point>>{outline}, cv::Scalar(255), cv::LINE_8, 0, -box.tl());
    const int rim = 2 * static_cast<int>(std::lround(0.08 * small)) + 3;  // where frames of windows touch it
    cv::copyMakeBorder(shape, shape, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
    cv::erode(shape, shape, cv::getStructuringElement(cv::MORPH_RECT, {rim, rim}));
    const cv::Mat inner = shape({1, 1, box.width, box.height});
    const cv::Mat letters = inner & (darkness(box) < kLightLetter * median_within(darkness(box), inner));
    const double light = static_cast<double>(cv::countNonZero(letters)) / std::max(1, cv::countNonZero(inner));
    if (light > 0.5 || letters_among(letters, 0.25 * small) < kLeastLetters) continue;
    cv::drawContours(headers, std::vector<std::vector<cv::Point>>{outline}, 0, cv::Scalar(255), cv::FILLED);
  }
  cv::dilate(headers, headers, cv::getStructuringElement(cv::MORPH_RECT, {7, 7}));
  return headers;
}

cv::Mat find_blocks(const cv::Mat& ink, double wall_px) {
  const double side = std::max(ink.rows, ink.cols);
  const int least = std::max(3, static_cast<int>(std::lround(std::max(1.8 * wall_px, 0.005 * side))));
  const auto box = [](int size) { return cv::getStructuringElement(cv::MORPH_RECT, {size, size}); };
  cv::Mat solid;
  cv::morphologyEx(without_holes(ink, kLargestHole * side), solid, cv::MORPH_OPEN, box(least));
  cv::morphologyEx(solid, solid, cv::MORPH_CLOSE, box(std::max(3, static_cast<int>(0.006 * side))));  // open pictograms
  cv::Mat blocks = cv::Mat::zeros(ink.size(), CV_8UC1);
  const int rim = 2 + static_cast<int>(0.15 * wall_px);
  for (const auto& outline : outlines_of(solid)) {
    const cv::RotatedRect around = cv::minAreaRect(outline);
    const double large = std::max(around.size.width, around.size.height) + 1,
                 small = std::min(around.size.width, around.size.height) + 1;
    if (large > kLargestBlock * side || large > 3 * small) continue;
    std::vector<cv::Point> hull;
    cv::convexHull(outline, hull);
    cv::fillConvexPoly(blocks, hull, cv::Scalar(255));
    cv::polylines(blocks, std::vector<std::vector<cv::Point>>{hull}, true, cv::Scalar(255), 2 * rim);
  }
  add_dots(blocks, ink, wall_px, rim);
  return blocks;
}

}  // namespace smokemap
