// Idea: an edge knows where a wall is and how it runs; the ink behind it knows how thick it is and how far it goes.
// Edges come from the line segment detector. From each, rays into the dark side give the width, which places the centre
// line; the centre line is then walked, pixel by pixel, while the ink's cross-section stays what it was. A map of
// claimed pixels keeps the second edge of the same wall from making a second stroke.
#include "layout/ink_stroke.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "layout/median.hpp"

namespace smokemap {
namespace {

constexpr double kSampleStep = 2;  // px along an edge
constexpr double kLeastRunPx = 8;  // shorter stretches of another width are crossings and blots
constexpr double kLeastBreakPx = 8, kLeastBreakWidths = 2;

struct Ink {
  const cv::Mat& darkness;
  cv::Mat mask;        ///< CV_8UC1, 255 = ink
  double cap_px = 0;   ///< widest cross-section that is looked at
  double black = 255;  ///< darkness of a stroke that blur has not thinned

  int at(const Point2& p) const {
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    if (x < 0 || y < 0 || x >= darkness.cols || y >= darkness.rows) return 0;
    return darkness.at<uchar>(y, x);
  }
  bool inked(const Point2& p) const {
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    return x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && mask.at<uchar>(y, x) != 0;
  }
};

struct CrossSection {
  double middle = 0;  ///< offset of the ink's middle along the normal
  double width = 0;
};

/// The run of ink across the point, which may lie up to `slack` beside it.
std::optional<CrossSection> cross_section(const Ink& ink, const Point2& p, const Point2& normal, double slack) {
  double start = 0;
  bool found = ink.inked(p);
  for (double s = 1; !found && s <= slack; s += 1) {
    for (const double sign : {1.0, -1.0})
      if (!found && ink.inked(p + sign * s * normal)) found = true, start = sign * s;
  }
  if (!found) return std::nullopt;
  double low = start, high = start;
  while (high - start < ink.cap_px && ink.inked(p + (high + 1) * normal)) high += 1;
  while (start - low < ink.cap_px && ink.inked(p + (low - 1) * normal)) low -= 1;
  return CrossSection{0.5 * (low + high), high - low + 1};
}

struct Seed {
  Segment2 axis;
  double width = 0;
};

/// The ink behind one sample of an edge.
struct EdgeSample {
  double s = 0;  ///< along the edge
  double middle = 0, width = 0;
};

/// Unit normal of the edge that points into the dark side.
Point2 dark_side(const Ink& ink, const Segment2& edge) {
  const Point2 u = edge.direction(), n = edge.normal();
  double left = 0, right = 0;
  for (double s = 0.5; s < edge.length(); s += kSampleStep) {
    const Point2 p = edge.a + s * u;
    left += ink.at(p + 2 * n);
    right += ink.at(p - 2 * n);
  }
  return right > left ? Point2(-n) : n;
}

std::vector<EdgeSample> samples_behind(const Ink& ink, const Segment2& edge, const Point2& n) {
  std::vector<EdgeSample> samples;
  for (double s = 0.5; s < edge.length(); s += kSampleStep) {
    const Point2 p = edge.a + s * edge.direction();
    double begin = -2;
    while (begin <= 3 && !ink.inked(p + begin * n)) begin += 1;
    if (begin > 3) continue;
    double end = begin;
    while (end - begin <= ink.cap_px && ink.inked(p + (end + 1) * n)) end += 1;
    if (end - begin > ink.cap_px) continue;
    samples.push_back({s, 0.5 * (begin + end), end - begin + 1});
  }
  return samples;
}

/// Runs of samples of like width: one edge may belong to a wall and to the frame of the window that carries it on.
std::vector<std::vector<EdgeSample>> runs_of_width(const std::vector<EdgeSample>& samples) {
  std::vector<std::vector<EdgeSample>> runs;
  double usual = 0;
  for (const auto& sample : samples) {
    const bool like = !runs.empty() && sample.width < 1.6 * usual + 1 && usual < 1.6 * sample.width + 1;
    if (!like) runs.emplace_back();
    auto& run = runs.back();
    run.push_back(sample);
    usual += (sample.width - usual) / std::min<double>(static_cast<double>(run.size()), 8);
  }
  return runs;
}

/// Widths of the ink behind an edge, and the centre lines it belongs to, by how much of the edge is theirs: one over
/// the whole edge, and one for every stretch of another width that is long enough to be a wall's.
std::vector<Seed> seeds_behind(const Ink& ink, const Segment2& edge) {
  const Point2 n = dark_side(ink, edge), u = edge.direction();
  const auto samples = samples_behind(ink, edge, n);
  if (samples.size() < 2 || static_cast<double>(samples.size()) * 2 * kSampleStep < edge.length()) return {};
  const auto seed_of = [&](const std::vector<EdgeSample>& of, double from, double to) {
    std::vector<double> widths, middles;
    for (const auto& sample : of) widths.push_back(sample.width), middles.push_back(sample.middle);
    const double offset = median_of(middles);
    return Seed{{edge.a + from * u + offset * n, edge.a + to * u + offset * n}, median_of(widths)};
  };
  std::vector<Seed> seeds{seed_of(samples, 0, edge.length())};
  for (const auto& run : runs_of_width(samples)) {
    const double length = run.back().s - run.front().s + kSampleStep;
    const double width = seed_of(run, 0, 1).width, whole = seeds.front().width;
    if (width < 1.6 * whole + 1 && whole < 1.6 * width + 1) continue;
    if (length >= std::max(kLeastRunPx, 0.7 * width)) seeds.push_back(seed_of(run, run.front().s, run.back().s));
  }
  return seeds;
}

struct Walk {
  double low = 0, high = 0;  ///< clean extent along the axis, from its point a
  std::vector<Point2> middles;
  std::vector<double> clean;  ///< where the cross-section is the stroke's own
  std::vector<double> held;   ///< there, and where wider ink crosses
};

/// Follows the axis both ways while the cross-section holds. Wider ink (a crossing wall) is walked through, not
/// counted; where there is more thinner ink than ink of the stroke's width, the stroke has ended before.
Walk walk_axis(const Ink& ink, const Segment2& axis, double width) {
  const Point2 u = axis.direction(), n = axis.normal();
  const double length = axis.length();
  const double slack = std::max(1.0, 0.35 * width);
  const double gap_limit = 2 + 0.3 * width;
  Walk walk;
  walk.low = walk.high = 0.5 * length;
  struct Way {
    double gap = 0, wide = 0;  ///< samples in a row without ink, and with ink of another width
    double score = 0, best = 0;
  };
  const auto look = [&](double s, Way& way, double& edge, bool inside) {
    const auto cut = cross_section(ink, axis.a + s * u, n, slack);
    if (!cut) return void(way.gap += 1);
    way.gap = 0;
    const bool clean =
        cut->width <= 1.5 * width + 1 && cut->width >= 0.5 * width - 1 && std::abs(cut->middle) <= slack + 0.5;
    if (clean || cut->width > width) walk.held.push_back(s);
    way.score += clean ? 1 : cut->width > width ? 0 : -1;
    if (!clean) return void(way.wide += 1);
    way.wide = 0;
    walk.clean.push_back(s);
    if (!inside && way.score < way.best) return;
    way.best = way.score;
    edge = s;
    walk.middles.push_back(axis.a + s * u + cut->middle * n);
  };
  for (const double sign : {1.0, -1.0}) {
    Way way;
    double& edge = sign > 0 ? walk.high : walk.low;
    for (double s = 0.5 * length + (sign > 0 ? 0 : -1);; s += sign) {
      const bool inside = s >= 0 && s <= length;
      look(s, way, edge, inside);
      if (!inside && (way.gap > gap_limit || way.wide > ink.cap_px || way.score < way.best - ink.cap_px)) break;
      if (inside && way.gap > 3 * gap_limit) break;
      if (s < -20000 || s > 20000) break;
    }
  }
  std::sort(walk.clean.begin(), walk.clean.end());
  std::sort(walk.held.begin(), walk.held.end());
  return walk;
}

/// The walk without the stretches where its ink is missing or thinner: windows, of which the edge that led here is a
/// frame. Short ones are slips of the pen.
std::vector<Segment2> pieces_of_walk(const Walk& walk, const Segment2& axis, double width) {
  const double least_break = std::max(kLeastBreakPx, kLeastBreakWidths * width);
  std::vector<Segment2> pieces;
  const Point2 u = axis.direction();
  double from = walk.low, last = walk.low;
  for (const double s : walk.held) {
    if (s < walk.low || s > walk.high) continue;
    if (s - last > least_break) pieces.push_back({axis.a + from * u, axis.a + last * u}), from = s;
    last = s;
  }
  pieces.push_back({axis.a + from * u, axis.a + walk.high * u});
  return pieces;
}

/// Total least squares through the middles.
std::optional<Segment2> fit_axis(const std::vector<Point2>& points, const Point2& direction) {
  if (points.size() < 4) return std::nullopt;
  Point2 mean = Point2::Zero();
  for (const auto& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  double xx = 0, xy = 0, yy = 0;
  for (const auto& p : points) {
    const Point2 d = p - mean;
    xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y();
  }
  const double heading = 0.5 * std::atan2(2 * xy, xx - yy);
  Point2 u(std::cos(heading), std::sin(heading));
  if (u.dot(direction) < 0) u = -u;
  double low = 1e18, high = -1e18;
  for (const auto& p : points) {
    const double s = (p - mean).dot(u);
    low = std::min(low, s), high = std::max(high, s);
  }
  return Segment2{mean + low * u, mean + high * u};
}

/// Thickness by summed darkness, so that a blurred line stays thin; and how dark the axis is.
void measure(const Ink& ink, InkStroke& stroke, double width) {
  const Point2 u = stroke.axis.direction(), n = stroke.axis.normal();
  const double length = stroke.length();
  std::vector<double> sums;
  double dark = 0;
  int samples = 0;
  const double step = std::max(1.0, length / 200);
  for (double s = 0.5; s < length; s += step) {
    const Point2 p = stroke.axis.a + s * u;
    const auto cut = cross_section(ink, p, n, std::max(1.0, 0.35 * width));
    if (!cut) continue;
    samples += 1;
    dark += ink.at(p + cut->middle * n) / 255.0;
    if (cut->width > 1.5 * width + 1) continue;
    double sum = 0, peak = 0.8 * ink.black;
    for (double o = cut->middle - 0.5 * cut->width - 2; o <= cut->middle + 0.5 * cut->width + 2; o += 1) {
      const double value = ink.at(p + o * n);
      sum += value;
      peak = std::max(peak, value);
    }
    sums.push_back(sum / peak);
  }
  stroke.thickness_px = width;
  if (!sums.empty()) stroke.thickness_px = median_of(std::move(sums));
  stroke.darkness = samples ? dark / samples : 0;
}

class Tracer {
 public:
  Tracer(const Ink& ink, const LayoutParams& params)
      : ink_(ink), params_(params), claimed_(ink.darkness.size(), CV_16UC1, cv::Scalar(0)) {}

  void add(const Segment2& edge) {
    for (const auto& seed : seeds_behind(ink_, edge)) follow(seed);
  }
  std::vector<InkStroke> take() { return std::move(strokes_); }

 private:
  void follow(const Seed& seed) {
    if (strokes_.size() >= 65000 || taken(seed.axis)) return;
    Segment2 axis = seed.axis;
    Walk walk = walk_axis(ink_, axis, seed.width);
    if (const auto fitted = fit_axis(walk.middles, axis.direction())) {
      axis = *fitted;
      if (axis.length() < 1) return;
      walk = walk_axis(ink_, axis, seed.width);
    }
    if (walk.high - walk.low < 3 || taken(part_of(axis, walk.low, walk.high))) return;
    const auto within = [](const std::vector<double>& places, double from, double to) {
      return static_cast<double>(std::upper_bound(places.begin(), places.end(), to + 0.5) -
                                 std::lower_bound(places.begin(), places.end(), from - 0.5));
    };
    const double clean =
        within(walk.clean, walk.low, walk.high) / std::max(1.0, within(walk.held, walk.low, walk.high));
    const int line = static_cast<int>(strokes_.size());
    for (const auto& piece : pieces_of_walk(walk, axis, seed.width)) {
      if (piece.length() < 3) continue;
      InkStroke stroke;
      stroke.axis = piece;
      stroke.line = line;
      const double from = (piece.a - axis.a).dot(axis.direction()), to = from + piece.length();
      stroke.coverage = std::min(1.0, clean * within(walk.held, from, to) / (piece.length() + 1));
      measure(ink_, stroke, seed.width);
      claim(stroke, seed.width);
      strokes_.push_back(stroke);
    }
  }
  static Segment2 part_of(const Segment2& axis, double from, double to) {
    return {axis.a + from * axis.direction(), axis.a + to * axis.direction()};
  }

  /// Most of it lies on a stroke of like direction.
  bool taken(const Segment2& axis) const {
    const double length = axis.length();
    int inside = 0, all = 0;
    for (double s = 0.5; s < length; s += 2, ++all) {
      const Point2 p = axis.a + s * axis.direction();
      const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
      if (x < 0 || y < 0 || x >= claimed_.cols || y >= claimed_.rows) continue;
      const int owner = claimed_.at<ushort>(y, x);
      if (owner == 0) continue;
      const double turn =
          line_angle_between(strokes_[static_cast<std::size_t>(owner - 1)].axis.heading(), axis.heading());
      if (turn < radians(4 * params_.merge_angle_deg)) inside += 1;
    }
    return all == 0 || inside * 2 > all;
  }
  void claim(const InkStroke& stroke, double width) {
    const auto px = [](const Point2& p) {
      return cv::Point(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
    };
    cv::line(claimed_, px(stroke.axis.a), px(stroke.axis.b), cv::Scalar(static_cast<double>(strokes_.size() + 1)),
             static_cast<int>(std::lround(width)) + 2);
  }

  const Ink& ink_;
  const LayoutParams& params_;
  cv::Mat claimed_;  ///< CV_16UC1: 1 + index of the stroke
  std::vector<InkStroke> strokes_;
};

/// Edges of the whole picture, longest first. Strips overlap, so that no edge is cut short unseen.
std::vector<Segment2> find_edges(const cv::Mat& darkness) {
  const int strip = 640, overlap = 40;
  const auto detector = cv::createLineSegmentDetector(cv::LSD_REFINE_NONE);
  std::vector<Segment2> edges;
  for (int y = 0; y < darkness.rows; y += strip) {
    const int top = std::max(0, y - overlap), bottom = std::min(darkness.rows, y + strip + overlap);
    std::vector<cv::Vec4f> lines;
    if (bottom - top < 8 || darkness.cols < 8) break;
    detector->detect(darkness.rowRange(top, bottom), lines);
    const Point2 shift(0, top);
    for (const auto& l : lines) edges.push_back({Point2(l[0], l[1]) + shift, Point2(l[2], l[3]) + shift});
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Segment2& a, const Segment2& b) { return a.length() > b.length(); });
  return edges;
}

}  // namespace

double usual_black(const cv::Mat& darkness, double share) {
  std::array<int, 256> histogram{};
  for (int y = 0; y < darkness.rows; ++y)
    for (int x = 0; x < darkness.cols; ++x) ++histogram[darkness.at<uchar>(y, x)];
  const auto above = [&](int from) {
    double count = 0;
    for (int v = from; v < 256; ++v) count += histogram[static_cast<std::size_t>(v)];
    return count;
  };
  const double ink = above(110);
  int black = 255;
  while (black > 110 && above(black) < share * ink) --black;
  return ink > 0 ? black : 255;
}

cv::Mat ink_mask(const cv::Mat& darkness, const LayoutParams& params) {
  const int reach = std::max(3, std::max(darkness.rows, darkness.cols) / 280);
  cv::Mat level;
  cv::dilate(darkness, level, cv::getStructuringElement(cv::MORPH_RECT, {2 * reach + 1, 2 * reach + 1}));
  level.convertTo(level, CV_8U, 0.5);
  cv::min(level, 255 * params.ink_high, level);
  cv::max(level, 255 * params.ink_low, level);
  return darkness >= level;
}

std::vector<InkStroke> trace_strokes(const cv::Mat& darkness, const LayoutParams& params) {
  const double side = std::max(darkness.rows, darkness.cols);
  const Ink ink{darkness, ink_mask(darkness, params), params.max_wall_share * side, usual_black(darkness)};
  Tracer tracer(ink, params);
  for (const auto& edge : find_edges(darkness)) {
    if (edge.length() < 5) break;
    tracer.add(edge);
  }
  return tracer.take();
}

}  // namespace smokemap
