// Idea: hatching runs from face to face at an angle; nothing else that is drawn between two close parallel lines does
// so again and again. The bands with many lines show how the plan hatches: in which direction, between faces how far
// apart. With that knowledge one line is enough for a pier.
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "layout/drafting.hpp"
#include "layout/drawings.hpp"
#include "layout/median.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kLeastHatching = 3;                ///< lines of a band that stands for itself
constexpr double kLeastAngle = 0.35, kMostAngle = 1.31;  ///< rad, between hatching and face
constexpr double kParallelFaces = 0.06;                  ///< rad
constexpr double kLikeDirection = 0.2;                   ///< rad, among the lines of a plan's hatching
constexpr double kCloser = 1.3;                          ///< times the least spacing of the faces that a line crosses
constexpr double kJoin = 1.5;                            ///< times the thickness
constexpr double kCrosses = 0.7;                         ///< of the band's width: hatching may be broken
constexpr double kOverFace = 0.2;                        ///< of the band's width: how far hatching may miss a face
constexpr double kSparsest = 2.5;                        ///< times the band's width from line to line along it
constexpr double kCell = 0.006;                          ///< of the picture's long side: paper between dense lines
constexpr int kSmallestCellPx = 6;                       ///< less is noise
constexpr double kOneWay = 0.55;                         ///< in how much they are drawn out in one direction
constexpr int kNeighbours = 4;                           ///< cells about one of hatching, within twice that
constexpr std::size_t kManyCells = 60;                   ///< of a plan that is hatched
constexpr int kManyLines = 24;                           ///< of hatching, in a plan whose walls are hatched
constexpr double kLeastLength = 8;                       ///< times the thickest wall: less is furniture
constexpr double kDense = 0.5;                           ///< of the band's width: paper between two lines
constexpr double kLikeWidth = 1.3;                       ///< times as wide or narrow as a band that is known

struct FacePair {
  Segment2 axis;  ///< between them, where both run
  double spacing = 0;
  double line_px = 0;
};

std::optional<FacePair> facing(const InkStroke& one, const InkStroke& two, double max_spacing) {
  if (line_angle_between(one.axis.heading(), two.axis.heading()) > kParallelFaces) return std::nullopt;
  const double offset = signed_line_distance(one.axis, two.axis.midpoint()), spacing = std::abs(offset);
  const double line = std::max(one.thickness_px, two.thickness_px);
  if (spacing > max_spacing || spacing < 3 * line) return std::nullopt;
  double low = along(one.axis, two.axis.a) * one.length(), high = along(one.axis, two.axis.b) * one.length();
  if (low > high) std::swap(low, high);
  low = std::max(low, 0.0), high = std::min(high, one.length());
  if (high - low < 0.8 * spacing) return std::nullopt;
  const Point2 u = one.axis.direction(), shift = 0.5 * offset * one.axis.normal();
  return FacePair{{one.axis.a + low * u + shift, one.axis.a + high * u + shift}, spacing, line};
}

/// Where the stroke crosses the middle between the faces, if it runs from one to the other.
std::optional<double> crossing(const FacePair& faces, const InkStroke& stroke) {
  const double angle = line_angle_between(stroke.axis.heading(), faces.axis.heading());
  if (angle < kLeastAngle || angle > kMostAngle) return std::nullopt;
  const double a = signed_line_distance(faces.axis, stroke.axis.a), b = signed_line_distance(faces.axis, stroke.axis.b);
  const double reach = (0.5 + kOverFace) * faces.spacing + 2;
  if (a * b >= 0 || std::abs(a - b) < kCrosses * faces.spacing || std::max(std::abs(a), std::abs(b)) > reach)
    return std::nullopt;
  const Point2 p = stroke.axis.a + a / (a - b) * (stroke.axis.b - stroke.axis.a);
  const double at = (p - faces.axis.a).dot(faces.axis.direction());
  if (at < 0 || at > faces.axis.length()) return std::nullopt;
  return at;
}

/// Faces and the strokes that cross from one to the other.
struct Crossed {
  FacePair faces;
  std::vector<std::pair<std::size_t, double>> by;  ///< stroke, place along the axis
  double heading = 0;                              ///< of most of them
};

std::vector<std::pair<std::size_t, double>> crossings(const FacePair& faces, const std::vector<InkStroke>& strokes,
                                                      const std::vector<std::size_t>& oblique) {
  std::vector<std::pair<std::size_t, double>> found;
  const Point2 middle = faces.axis.midpoint();
  const double reach = 0.5 * faces.axis.length() + 2 * faces.spacing;
  for (const std::size_t i : oblique) {
    if ((strokes[i].axis.midpoint() - middle).squaredNorm() > reach * reach) continue;
    if (const auto at = crossing(faces, strokes[i])) found.emplace_back(i, *at);
  }
  return found;
}

/// Every two parallel strokes with others between them. What crosses closer faces from one to the other does not belong
/// to those farther apart.
std::vector<Crossed> crossed_faces(const std::vector<InkStroke>& strokes, double max_thickness_px) {
  std::vector<std::size_t> slim, oblique;
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (strokes[i].thickness_px < 0.3 * max_thickness_px && strokes[i].length() > 2 * strokes[i].thickness_px) {
      slim.push_back(i);
      if (strokes[i].length() < 3 * max_thickness_px) oblique.push_back(i);
    }
  std::vector<Crossed> found;
  std::vector<double> closest(strokes.size(), 1e300);
  for (std::size_t n = 0; n < slim.size(); ++n)
    for (std::size_t m = n + 1; m < slim.size(); ++m) {
      const auto &one = strokes[slim[n]], &two = strokes[slim[m]];
      const double reach = 0.5 * (one.length() + two.length()) + max_thickness_px;
      if ((one.axis.midpoint() - two.axis.midpoint()).squaredNorm() > reach * reach) continue;
      const auto faces = facing(one, two, max_thickness_px);
      if (!faces) continue;
      auto by = crossings(*faces, strokes, oblique);
      for (const auto& [stroke, at] : by) closest[stroke] = std::min(closest[stroke], faces->spacing);
      if (!by.empty()) found.push_back({*faces, std::move(by), 0});
    }
  for (auto& pair : found)
    std::erase_if(pair.by, [&](const auto& b) { return pair.faces.spacing > kCloser * closest[b.first]; });
  return found;
}

/// Leaves the lines of the direction that most have, in order along the faces.
void keep_one_direction(Crossed& pair, const std::vector<InkStroke>& strokes) {
  std::size_t most = 0;
  for (const auto& [one, unused] : pair.by) {
    const double heading = strokes[one].axis.heading();
    const auto like = static_cast<std::size_t>(std::count_if(pair.by.begin(), pair.by.end(), [&](const auto& other) {
      return line_angle_between(strokes[other.first].axis.heading(), heading) < 0.5 * kLikeDirection;
    }));
    if (like > most) most = like, pair.heading = heading;
  }
  std::erase_if(pair.by, [&](const auto& b) {
    return line_angle_between(strokes[b.first].axis.heading(), pair.heading) >= 0.5 * kLikeDirection;
  });
  std::sort(pair.by.begin(), pair.by.end(), [](const auto& x, const auto& y) { return x.second < y.second; });
}

/// Stretches of the faces along which at least so many lines of hatching follow each other.
void add_bands(const Crossed& pair, std::size_t least, std::vector<HatchedBand>& bands) {
  const auto& by = pair.by;
  const FacePair& faces = pair.faces;
  std::vector<double> steps;
  for (std::size_t i = 1; i < by.size(); ++i) steps.push_back(by[i].second - by[i - 1].second);
  const double usual = steps.empty() ? faces.spacing : std::max(median_of(steps), 1.0);
  const double margin = 0.8 * std::min(usual, faces.spacing) + 0.5 * faces.spacing;
  const double cell = usual * std::sin(line_angle_between(pair.heading, faces.axis.heading())) - faces.line_px;
  const Point2 u = faces.axis.direction();
  for (std::size_t from = 0, i = 0; i < by.size(); ++i) {
    if (i + 1 < by.size() && by[i + 1].second - by[i].second < kSparsest * faces.spacing) continue;
    if (i + 1 - from >= least) {
      const double before = std::max(0.0, by[from].second - margin);
      const double after = std::min(faces.axis.length(), by[i].second + margin);
      bands.push_back({{faces.axis.a + before * u, faces.axis.a + after * u},
                       faces.spacing + faces.line_px,
                       cell,
                       static_cast<int>(i + 1 - from)});
    }
    from = i + 1;
  }
}

/// Carries the bands on over the squares where they meet, which belong to both, and over what parts two of one wall.
void join_bands(std::vector<HatchedBand>& bands) {
  const std::vector<HatchedBand> before = bands;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    const Segment2& own = before[i].axis;
    double low = 0, high = own.length();
    for (std::size_t j = 0; j < before.size(); ++j) {
      const auto& other = before[j];
      const double reach = kJoin * std::max(before[i].thickness_px, other.thickness_px);
      if (j == i || gap_between(own, other.axis) > reach) continue;
      std::vector<double> to;
      if (line_angle_between(own.heading(), other.axis.heading()) > 0.5) {
        const auto p = line_intersection(own, other.axis);
        if (!p || distance(other.axis, *p) > reach) continue;
        const double at = along(own, *p) * own.length();
        to = {at - 0.5 * other.thickness_px, at + 0.5 * other.thickness_px};
      } else if (std::abs(signed_line_distance(own, other.axis.midpoint())) < 0.3 * before[i].thickness_px) {
        to = {along(own, other.axis.a) * own.length(), along(own, other.axis.b) * own.length()};
        if (to[0] > to[1]) std::swap(to[0], to[1]);
        to = {to[0] < 0 ? to[1] : to[0]};
      }
      for (const double at : to)
        if (at > -reach - 0.5 * other.thickness_px && at < own.length() + reach + 0.5 * other.thickness_px)
          low = std::min(low, at), high = std::max(high, at);
    }
    bands[i].axis = {own.a + low * own.direction(), own.a + high * own.direction()};
  }
}

}  // namespace

std::vector<HatchedBand> find_hatching(const std::vector<InkStroke>& strokes, double max_thickness_px) {
  auto found = crossed_faces(strokes, max_thickness_px);
  std::vector<std::pair<double, double>> known;  // direction of the hatching, width of the wall
  for (auto& pair : found) {
    keep_one_direction(pair, strokes);
    std::vector<HatchedBand> bands;
    add_bands(pair, kLeastHatching, bands);
    if (!bands.empty()) known.emplace_back(pair.heading, pair.faces.spacing);
  }
  std::vector<HatchedBand> bands;
  for (const auto& pair : found)
    if (std::any_of(known.begin(), known.end(), [&](const auto& style) {
          return line_angle_between(style.first, pair.heading) < kLikeDirection &&
                 pair.faces.spacing < kLikeWidth * style.second && style.second < kLikeWidth * pair.faces.spacing;
        }))
      add_bands(pair, 1, bands);
  double length = 0;
  int lines = 0;
  for (const auto& band : bands) length += band.axis.length(), lines += band.lines;
  if (length < kLeastLength * max_thickness_px || lines < kManyLines) return {};
  join_bands(bands);
  return bands;
}

namespace {

/// How much the chosen spots of a picture of labels are drawn out in one direction: 0 any, 1 all the same and slender.
double common_direction(const cv::Mat& labels, const std::vector<std::uint8_t>& chosen) {
  struct Moments {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  };
  std::vector<Moments> moments(chosen.size());
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      const auto label = static_cast<std::size_t>(labels.at<int>(y, x));
      if (!chosen[label]) continue;
      auto& m = moments[label];
      m.n += 1, m.x += x, m.y += y, m.xx += x * x, m.xy += x * y, m.yy += y * y;
    }
  Point2 sum = Point2::Zero();
  double all = 0;
  for (const auto& m : moments) {
    if (m.n == 0) continue;
    const double xx = m.xx / m.n - m.x * m.x / m.n / m.n, yy = m.yy / m.n - m.y * m.y / m.n / m.n,
                 xy = m.xy / m.n - m.x * m.y / m.n / m.n;
    sum += Point2(xx - yy, 2 * xy) / std::max(1e-9, xx + yy), all += 1;
  }
  return all > 0 ? sum.norm() / all : 0;
}

}  // namespace

cv::Mat with_cells_filled(const cv::Mat& darkness, const cv::Mat& ink) {
  const double side = std::max(ink.rows, ink.cols), reach = kCell * side;
  cv::Mat labels, stats, centroids;
  const cv::Mat paper = ink == 0;
  const int count = cv::connectedComponentsWithStats(paper, labels, stats, centroids, 4, CV_32S);
  std::vector<int> cells;
  for (int label = 1; label < count; ++label)
    if (std::max(stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT)) < reach &&
        stats.at<int>(label, cv::CC_STAT_AREA) >= kSmallestCellPx)
      cells.push_back(label);
  const auto x_of = [&](int label) { return centroids.at<double>(label, 0); };
  const auto y_of = [&](int label) { return centroids.at<double>(label, 1); };
  std::stable_sort(cells.begin(), cells.end(), [&](int a, int b) { return x_of(a) < x_of(b); });
  std::vector<int> around(cells.size(), 0);
  for (std::size_t a = 0; a < cells.size(); ++a)
    for (std::size_t b = a + 1; b < cells.size() && x_of(cells[b]) - x_of(cells[a]) < 2 * reach; ++b)
      if (std::abs(y_of(cells[b]) - y_of(cells[a])) < 2 * reach) ++around[a], ++around[b];
  std::vector<std::uint8_t> fill(static_cast<std::size_t>(count), 0);
  std::vector<double> widths;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (around[c] < kNeighbours) continue;
    fill[static_cast<std::size_t>(cells[c])] = 1;
    widths.push_back(std::sqrt(static_cast<double>(stats.at<int>(cells[c], cv::CC_STAT_AREA))));
  }
  if (widths.size() < kManyCells || common_direction(labels, fill) < kOneWay) return darkness;
  cv::Mat filled = darkness.clone();
  const auto black = static_cast<std::uint8_t>(usual_black(darkness));
  for (int y = 0; y < ink.rows; ++y)
    for (int x = 0; x < ink.cols; ++x)
      if (fill[static_cast<std::size_t>(labels.at<int>(y, x))]) filled.at<std::uint8_t>(y, x) = black;
  // Cells at the rim are open.
  const int gap = static_cast<int>(std::lround(median_of(widths) + 1)) | 1;
  cv::morphologyEx(filled, filled, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_RECT, {gap, gap}));
  return filled;
}

cv::Mat with_bands_filled(const cv::Mat& darkness, const std::vector<HatchedBand>& bands) {
  cv::Mat filled = darkness.clone();
  if (bands.empty()) return filled;
  const double black = usual_black(darkness);
  std::vector<double> cells, widths;
  for (const auto& band : bands) {
    const Point2 side = 0.5 * band.thickness_px * band.axis.normal();
    std::vector<cv::Point> quad;
    for (const Point2& p : {Point2(band.axis.a - side), Point2(band.axis.b - side), Point2(band.axis.b + side),
                            Point2(band.axis.a + side)})
      quad.emplace_back(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
    cv::fillConvexPoly(filled, quad, cv::Scalar(black));
    cells.push_back(band.cell_px), widths.push_back(band.thickness_px);
  }
  const double cell = median_of(cells);
  if (cell < kDense * median_of(widths)) {
    const int reach = static_cast<int>(std::lround(cell + 1)) | 1;
    cv::morphologyEx(filled, filled, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_RECT, {reach, reach}));
  }
  return filled;
}

double share_read(const std::vector<HatchedBand>& bands, const std::vector<InkStroke>& walls) {
  double all = 0, read = 0;
  for (const auto& band : bands) {
    const auto along = [&](const InkStroke& s) { return distance(s.axis, band.axis.midpoint()) < band.thickness_px; };
    all += band.axis.length();
    if (std::any_of(walls.begin(), walls.end(), along)) read += band.axis.length();
  }
  return all > 0 ? read / all : 1;
}

}  // namespace smokemap
