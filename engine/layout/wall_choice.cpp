#include "layout/wall_choice.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "layout/clutter.hpp"
#include "layout/drafting.hpp"
#include "layout/gaps.hpp"
#include "layout/median.hpp"

namespace smokemap {
namespace {

constexpr double kAtTheLimit = 0.95;         ///< of the thickness that walls may have
constexpr double kWider = 1.5;               ///< is looked for then
constexpr double kThinnerThanHatched = 0.7;  ///< beside a hatched wall: what is as thick would be hatched too
constexpr double kFragment = 0.4;            ///< of the hatched walls: what was read may be anything
constexpr double kManyThinner = 0.7;         ///< of the length of hatched walls
constexpr double kLeastBesideOutline = 1.6;  ///< times an outline's thickness: walls, once the space between is filled

/// What is left of a stroke that begins or ends in a filled figure, if that still is a stroke lying on ink.
std::optional<InkStroke> beside_blocks(const InkStroke& stroke, const cv::Mat& blocks, const cv::Mat& ink) {
  if (covered_share(stroke.axis, blocks) > 0.6) return std::nullopt;
  const Point2 u = stroke.axis.direction();
  const auto on = [&](const cv::Mat& mask, double t) {
    const Point2 p = stroke.axis.a + t * u;
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    return x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && mask.at<uchar>(y, x) != 0;
  };
  double from = 0, to = stroke.length();
  while (from < to && on(blocks, from)) from += 1;
  while (from < to && on(blocks, to)) to -= 1;
  if (to - from == stroke.length()) return stroke;
  double inked = 0;
  for (double t = from; t < to; t += 1) inked += on(ink, t);
  if (inked < 0.6 * (to - from) || to - from < stroke.thickness_px) return std::nullopt;
  InkStroke rest = stroke;
  rest.axis = {stroke.axis.a + from * u, stroke.axis.a + to * u};
  return rest;
}

/// Without the outlines of filled figures, which show only against the walls' thickness.
WallChoice without_blocks(const std::vector<InkStroke>& strokes, const cv::Mat& darkness, WallChoice first,
                          double least_px, const LayoutParams& params, const std::optional<Point2>& at) {
  const cv::Mat solid = darkness >= params.solid_share * usual_black(darkness);
  const cv::Mat blocks = find_blocks(solid, std::max(first.walls.thickness_px, first.walls.thickest_px));
  if (cv::countNonZero(blocks) == 0) return first;
  const cv::Mat ink = ink_mask(darkness, params);
  std::vector<InkStroke> free;
  for (const auto& s : strokes)
    if (const auto rest = beside_blocks(s, blocks, ink)) free.push_back(*rest);
  cv::Mat covered;
  cv::bitwise_or(first.covered, blocks, covered);
  return {select_walls(free, darkness.size(), params, least_px, at), covered};
}

/// Strokes of the drawing itself, without the paper's lines and without dimensions.
/// @param hatched  what is hatched, if wanted; where something is, dimensions stay: they look like hatching then
std::vector<InkStroke> traced(const cv::Mat& darkness, const cv::Mat& hidden, const LayoutParams& params,
                              std::vector<HatchedBand>* hatched = nullptr) {
  const double side = std::max(darkness.rows, darkness.cols);
  auto strokes = without_ruling(trace_strokes(darkness, params), darkness.size());
  if (hatched) {
    *hatched = find_hatching(strokes, kWider * params.max_wall_share * side);
    if (!hatched->empty()) return strokes;
  }
  return without_dimensions(strokes, ink_mask(darkness, params), hidden);
}

/// Closes gaps of paper up to so wide.
cv::Mat closed(const cv::Mat& darkness, double gap_px) {
  const int reach = static_cast<int>(std::lround(gap_px)) | 1;
  cv::Mat filled;
  cv::morphologyEx(darkness, filled, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_RECT, {reach, reach}));
  return filled;
}

/// Thickness of walls drawn as two lines beside thicker hatched ones, where they are about as many; else 0.
double hollow_beside(const std::vector<HatchedBand>& bands, const WallStrokes& walls) {
  std::vector<double> thickness;
  double hatched = 0, hollow = 0, thickest = 0;
  for (const auto& band : bands) thickness.push_back(band.thickness_px), hatched += band.axis.length();
  const double usual = median_of(std::move(thickness));
  for (const auto& s : walls.walls)
    if (s.hollow && s.thickness_px < kThinnerThanHatched * usual)
      hollow += s.length(), thickest = std::max(thickest, s.thickness_px);
  return hollow > kManyThinner * hatched ? thickest : 0;
}

/// The drawing once more with what is hatched filled, and what is drawn as two lines beside it.
WallChoice choose_hatched(const cv::Mat& darkness, const cv::Mat& hidden, const std::vector<HatchedBand>& bands,
                          const WallChoice& first, const LayoutParams& params, const std::optional<Point2>& at) {
  cv::Mat filled = with_bands_filled(darkness, bands);
  double least_px = 0;
  if (const double gap = hollow_beside(bands, first.walls); gap > 0) {
    least_px = kLeastBesideOutline * first.walls.outline_px;
    filled = closed(filled, 1.1 * gap);
  }
  LayoutParams wider = params;
  wider.max_wall_share *= kWider;
  const auto strokes = traced(filled, hidden, wider);
  WallChoice second{select_walls(strokes, filled.size(), params, least_px, at), first.covered, false};
  if (second.walls.walls.empty()) return first;
  second = without_blocks(strokes, filled, std::move(second), least_px, params, at);
  second.fragment =  // not one floor of several
      second.walls.drawings.size() == 1 && share_read(bands, second.walls.walls) < kFragment;
  return second;
}

void erase(cv::Mat& darkness, const InkStroke& stroke) {
  constexpr double kRimPx = 2;
  const Point2 along = kRimPx * stroke.axis.direction();
  const Point2 aside = (0.5 * stroke.thickness_px + kRimPx) * stroke.axis.normal();
  std::vector<cv::Point> quad;
  for (const Point2& p : {Point2(stroke.axis.a - along - aside), Point2(stroke.axis.b + along - aside),
                          Point2(stroke.axis.b + along + aside), Point2(stroke.axis.a - along + aside)})
    quad.emplace_back(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  cv::fillConvexPoly(darkness, quad, cv::Scalar(0));
}

/// The drawing once more with the paper between the two lines of walls filled: then thickness tells walls from leaves
/// and treads, as in plans with solid walls, and blur does no harm.
WallChoice choose_hollow(const std::vector<InkStroke>& strokes, const cv::Mat& darkness, const cv::Mat& hidden,
                         const WallChoice& first, const LayoutParams& params, const std::optional<Point2>& at) {
  const double least_px = kLeastBesideOutline * first.walls.outline_px;
  // Limits of the property run so close beside outer walls that both would become one.
  cv::Mat filled = darkness.clone();
  for (const auto& dash : dash_dot_lines(strokes, darkness.size(), params)) erase(filled, dash);
  filled = closed(filled, 1.1 * first.walls.hollow_px);
  const auto solid = traced(filled, hidden, params);
  WallChoice second{select_walls(solid, filled.size(), params, least_px, at), first.covered};
  if (second.walls.walls.empty()) return first;
  second = without_blocks(solid, filled, std::move(second), least_px, params, at);
  second.walls.hollow = true;
  return second;
}

}  // namespace

WallChoice choose_walls(const cv::Mat& legible, const cv::Mat& covered, const cv::Mat& hidden,
                        const LayoutParams& params, const std::optional<Point2>& at, const Progress& progress) {
  const cv::Mat darkness = with_cells_filled(legible, ink_mask(legible, params));
  std::vector<HatchedBand> hatched;
  auto strokes = traced(darkness, hidden, params, &hatched);
  progress.tell(0.7, "rooms");
  WallChoice choice{select_walls(strokes, darkness.size(), params, 0, at), covered};
  const double thickest_px = params.max_wall_share * std::max(darkness.rows, darkness.cols);
  if (choice.walls.thickest_px > kAtTheLimit * thickest_px) {
    LayoutParams wider = params;
    wider.max_wall_share *= kWider;
    strokes = traced(darkness, hidden, wider, &hatched);
    choice.walls = select_walls(strokes, darkness.size(), params, 0, at);
  }
  if (choice.walls.walls.empty() || progress.cancelled()) return choice;
  choice = !hatched.empty()      ? choose_hatched(darkness, hidden, hatched, choice, params, at)
           : choice.walls.hollow ? choose_hollow(strokes, darkness, hidden, choice, params, at)
                                 : without_blocks(strokes, darkness, std::move(choice), 0, params, at);
  choice.strokes = std::move(strokes);
  return choice;
}

}  // namespace smokemap
