#include "sketch/drawing_lines.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "core/expect.hpp"

namespace smokemap {
namespace {

constexpr double kPrintedShare = 0.8;  ///< printed lines are at most so strong beside the pen
constexpr int kRulingBand_px = 9;
constexpr double kWallPen = 1.35;  ///< a line so much wider than the hatching beside it is none

/// Share of the line through the picture that is ink, and how strong the ink on it is.
struct Ruling {
  Point2 p = Point2::Zero(), u = Point2::Zero();
  double share = 0;
  double strength = 0;  ///< median, 0..255
  double from = 0, to = 0;
};

/// Ink within two pixels of the line, walked through the whole picture.
Ruling look_along(const cv::Mat& mask, const cv::Mat& strength, const Point2& p, const Point2& u) {
  Ruling r;
  r.p = p, r.u = u;
  const double reach = mask.rows + mask.cols;
  const Point2 n(-u.y(), u.x());
  int inside = 0, inked = 0;
  std::vector<uchar> strengths;
  for (double s = -reach; s <= reach; s += 1) {
    const Point2 q = p + s * u;
    const int x = static_cast<int>(std::lround(q.x())), y = static_cast<int>(std::lround(q.y()));
    if (x < 2 || y < 2 || x >= mask.cols - 2 || y >= mask.rows - 2) continue;
    ++inside;
    uchar strongest = 0;
    bool hit = false;
    for (int o = -2; o <= 2; ++o) {
      const Point2 around = q + o * n;
      const int ax = static_cast<int>(std::lround(around.x())), ay = static_cast<int>(std::lround(around.y()));
      if (!mask.at<uchar>(ay, ax)) continue;
      hit = true;
      strongest = std::max(strongest, strength.at<uchar>(ay, ax));
    }
    if (hit) ++inked, strengths.push_back(strongest);
  }
  r.share = inside > 0 ? static_cast<double>(inked) / inside : 0;
  if (!strengths.empty()) {
    const auto nth = strengths.begin() + static_cast<std::ptrdiff_t>(strengths.size() / 2);
    std::nth_element(strengths.begin(), nth, strengths.end());
    r.strength = *nth;
  }
  return r;
}

/// How strong the ink beside the rulings is: its upper quartile. 0 if there is hardly any.
double pen_strength(const cv::Mat& mask, const cv::Mat& strength, const std::vector<Ruling>& rulings) {
  cv::Mat beside = mask.clone();
  const double reach = mask.rows + mask.cols;
  const auto pixel = [](const Point2& p) { return cv::Point(static_cast<int>(p.x()), static_cast<int>(p.y())); };
  for (const auto& r : rulings)
    cv::line(beside, pixel(r.p - reach * r.u), pixel(r.p + reach * r.u), cv::Scalar(0), kRulingBand_px);
  std::vector<uchar> values;
  for (int y = 0; y < beside.rows; ++y)
    for (int x = 0; x < beside.cols; ++x)
      if (beside.at<uchar>(y, x)) values.push_back(strength.at<uchar>(y, x));
  if (values.size() < 100) return 0;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 3 / 4);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace

double polyline_length(const Polyline& line) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) length += (line[i + 1] - line[i]).norm();
  return length;
}

int erase_ruled_lines(cv::Mat& mask, const cv::Mat& strength, double turn_deg) {
  const double side = std::max(mask.rows, mask.cols);
  std::vector<cv::Vec4i> pieces;
  cv::RNG seed(1);
  cv::theRNG() = seed;  // the probabilistic transform draws from here: same picture, same lines
  cv::HoughLinesP(mask, pieces, 1, CV_PI / 360, static_cast<int>(0.12 * side), 0.2 * side, 0.03 * side);
  std::vector<Ruling> rulings;
  for (const auto& piece : pieces) {
    const Point2 a(piece[0], piece[1]), b(piece[2], piece[3]);
    const Ruling r = look_along(mask, strength, a, (b - a).normalized());
    if (r.share < 0.55) continue;
    const bool known = std::any_of(rulings.begin(), rulings.end(), [&](const Ruling& o) {
      const Segment2 line{o.p, o.p + o.u};
      return std::abs(signed_line_distance(line, a)) < 0.006 * side &&
             std::abs(signed_line_distance(line, b)) < 0.006 * side;
    });
    if (!known) rulings.push_back(r);
  }
  // A family of at least three: one long line is a wall.
  std::vector<Ruling> best;
  for (const auto& lead : rulings) {
    std::vector<Ruling> family;
    for (const auto& r : rulings)
      if (line_angle_between(std::atan2(lead.u.y(), lead.u.x()), std::atan2(r.u.y(), r.u.x())) < radians(2 * turn_deg))
        family.push_back(r);
    if (family.size() > best.size()) best = family;
  }
  if (best.size() < 3) return 0;
  std::vector<double> strengths;
  for (const auto& r : best) strengths.push_back(r.strength);
  std::sort(strengths.begin(), strengths.end());
  const double printed = strengths[strengths.size() / 2];
  if (printed > kPrintedShare * pen_strength(mask, strength, best)) return 0;  // long walls of one pen
  const double pen = 1.35 * printed;  // stronger ink on a ruling was drawn over it
  const double reach = mask.rows + mask.cols;
  for (const auto& r : best) {
    const Point2 n(-r.u.y(), r.u.x());
    for (double s = -reach; s <= reach; s += 0.5)
      for (double o = -3; o <= 3; o += 0.5) {
        const Point2 q = r.p + s * r.u + o * n;
        const int x = static_cast<int>(std::lround(q.x())), y = static_cast<int>(std::lround(q.y()));
        if (x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && strength.at<uchar>(y, x) < pen)
          mask.at<uchar>(y, x) = 0;
      }
  }
  return static_cast<int>(best.size());
}

std::vector<Polyline> straightened(const std::vector<SkeletonBranch>& branches, double tolerance_px) {
  std::vector<Polyline> lines;
  for (const auto& b : branches) {
    std::vector<cv::Point> simple;
    cv::approxPolyDP(b.points, simple, tolerance_px, false);
    Polyline line;
    for (const auto& p : simple) line.emplace_back(p.x, p.y);
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<Polyline> without_hatching(std::vector<Polyline> lines, const std::vector<double>& widths,
                                       double spacing_px, std::vector<Polyline>* left_out) {
  ENGINE_EXPECT(widths.size() == lines.size());
  std::vector<std::size_t> family(lines.size());
  std::iota(family.begin(), family.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (family[i] != i) i = family[i];
    return i;
  };
  const auto chord = [&](std::size_t i) { return Segment2{lines[i].front(), lines[i].back()}; };
  const auto straight = [&](std::size_t i) {
    return chord(i).length() > 0.93 * polyline_length(lines[i]) && chord(i).length() > 0;
  };
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      if (!straight(i) || !straight(j)) continue;
      const Segment2 one = chord(i), two = chord(j);
      const double ratio = one.length() / two.length();
      if (ratio < 0.4 || ratio > 2.5 || line_angle_between(one.heading(), two.heading()) > radians(10)) continue;
      const double apart = std::abs(signed_line_distance(one, two.midpoint()));
      const double shift = std::abs(along(one, two.midpoint()) - 0.5) * one.length();
      if (apart < 2 || apart > spacing_px || apart > 0.8 * std::max(one.length(), two.length()) ||
          shift > 0.6 * (one.length() + two.length()))
        continue;
      const std::size_t low = std::min(root(i), root(j)), high = std::max(root(i), root(j));
      family[high] = low;
    }
  std::vector<std::vector<double>> widths_of(lines.size());  // by family
  for (std::size_t i = 0; i < lines.size(); ++i) widths_of[root(i)].push_back(widths[i]);
  for (auto& family_widths : widths_of) std::sort(family_widths.begin(), family_widths.end());
  std::vector<Polyline> kept;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::vector<double>& others = widths_of[root(i)];
    // A wall beside steps runs like them, but people draw it stronger.
    const bool is_wall = widths[i] > kWallPen * others[others.size() / 2];
    if (others.size() < 4 || is_wall)
      kept.push_back(std::move(lines[i]));
    else if (left_out != nullptr)
      left_out->push_back(std::move(lines[i]));
  }
  return kept;
}

}  // namespace smokemap
