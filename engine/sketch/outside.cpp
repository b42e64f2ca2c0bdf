#include "sketch/outside.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace smokemap {
namespace {

constexpr double kLookSide_px = 900;  ///< how far to reach is decided on a picture no larger than this
constexpr double kLeastSaved = 0.06;  ///< share of the walls that a wider reach must save
constexpr double kLeastLost = 0.45;   ///< share of the walls round a bay that face nothing else inside
constexpr double kLeastOfAll = 0.04;  ///< and of all walls: an overshooting line makes no room
constexpr std::size_t kMostBays = 64;

/// Everything the border of the sheet reaches through openings wider than 2 * radius.
cv::Mat outside_of(const cv::Mat& shut, double radius) {
  cv::Mat padded, distance, open, reached;
  cv::copyMakeBorder(shut, padded, 2, 2, 2, 2, cv::BORDER_CONSTANT, cv::Scalar(0));
  const int margin = static_cast<int>(radius) + 2;  // a drawing that touches the sheet's edge still has an outside
  cv::copyMakeBorder(padded, padded, margin, margin, margin, margin, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::distanceTransform(padded == 0, distance, cv::DIST_L2, cv::DIST_MASK_5);
  open = distance > radius;
  cv::floodFill(open, {0, 0}, cv::Scalar(128));
  cv::distanceTransform(open != 128, reached, cv::DIST_L2, cv::DIST_MASK_5);
  cv::Mat outside = (reached <= radius) & (padded == 0);
  return cv::Mat(outside(cv::Rect(margin + 2, margin + 2, shut.cols, shut.rows))).clone();
}

cv::Mat near_to(const cv::Mat& mask) {
  cv::Mat opened, grown;
  cv::morphologyEx(mask, opened, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}));
  cv::dilate(opened, grown, cv::getStructuringElement(cv::MORPH_RECT, {9, 9}));
  return grown;
}

/// Share of wall pixels with nothing but outside and walls around.
double lost_share(const cv::Mat& shut, const cv::Mat& inside) {
  const double walls = cv::countNonZero(shut);
  return walls > 0 ? 1 - cv::countNonZero(near_to(inside) & shut) / walls : 1;
}

cv::Mat inside_of(const cv::Mat& shut, double radius) { return (shut == 0) & (outside_of(shut, radius) == 0); }

/// What is inside with the smallest reach that is worth it; `reach_px` says which.
cv::Mat inside_by_reach(const cv::Mat& shut, double extent_px, const SketchParams& params, double& reach_px) {
  cv::Mat best;
  double least = 2;
  const double from = params.close_gap_share, to = params.report_gap_share, widest = params.widest_gap_share;
  for (const double share : {from, to, 0.5 * (to + widest), widest}) {
    const cv::Mat inside = inside_of(shut, 0.5 * share * extent_px);
    const double lost = lost_share(shut, inside);
    if (lost < least - kLeastSaved) best = inside, least = lost, reach_px = 0.5 * share * extent_px;
    if (least <= kLeastSaved) break;
  }
  return best;
}

/// A wide reach also fills in bays of the outline. Of what it gained over `sure`, only the parts stay whose walls would
/// have nothing inside beside them otherwise; largest first.
cv::Mat without_bays(const cv::Mat& shut, const cv::Mat& inside, const cv::Mat& sure) {
  cv::Mat labels, stats, centroids, kept = sure.clone();
  const int count = cv::connectedComponentsWithStats(inside & (sure == 0), labels, stats, centroids, 4);
  std::vector<int> order;
  for (int label = 1; label < count; ++label) order.push_back(label);
  std::stable_sort(order.begin(), order.end(), [&](int one, int two) {
    return stats.at<int>(one, cv::CC_STAT_AREA) > stats.at<int>(two, cv::CC_STAT_AREA);
  });
  const double least_walls = kLeastOfAll * cv::countNonZero(shut);
  if (order.size() > kMostBays) order.resize(kMostBays);
  for (const int label : order) {
    const cv::Mat part = labels == label, walls = near_to(part) & shut;
    const int lost = cv::countNonZero(walls & (near_to(kept) == 0));
    if (lost > std::max(kLeastLost * cv::countNonZero(walls), least_walls)) kept |= part;
  }
  return kept;
}

/// The wall pixel nearest to `p` in a window of `reach` pixels; `p` itself if there is none.
cv::Point wall_near(const cv::Mat& shut, const cv::Point& p, int reach) {
  cv::Point best = p;
  int least = 2 * reach * reach + 1;
  for (int y = std::max(0, p.y - reach); y <= std::min(shut.rows - 1, p.y + reach); ++y)
    for (int x = std::max(0, p.x - reach); x <= std::min(shut.cols - 1, p.x + reach); ++x) {
      const cv::Point d = cv::Point(x, y) - p;
      if (shut.at<uchar>(y, x) && d.dot(d) < least) least = d.dot(d), best = {x, y};
    }
  return best;
}

/// The two ends of every place where inside and outside touch without a wall.
std::vector<std::pair<cv::Point, cv::Point>> openings_of(const cv::Mat& shut, const cv::Mat& inside) {
  cv::Mat grown, labels;
  cv::dilate(inside, grown, cv::getStructuringElement(cv::MORPH_CROSS, {3, 3}));
  const int count = cv::connectedComponents(grown & (inside == 0) & (shut == 0), labels, 8);
  std::vector<std::vector<cv::Point>> runs(static_cast<std::size_t>(count));
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (const int label = labels.at<int>(y, x); label > 0) runs[static_cast<std::size_t>(label)].emplace_back(x, y);
  std::vector<std::pair<cv::Point, cv::Point>> openings;
  for (const auto& run : runs) {
    if (run.size() < 3) continue;
    const auto farthest = [&](const cv::Point& from) {
      return *std::max_element(run.begin(), run.end(), [&](const cv::Point& one, const cv::Point& two) {
        return (one - from).dot(one - from) < (two - from).dot(two - from);
      });
    };
    const cv::Point a = farthest(run.front());
    openings.emplace_back(a, farthest(a));
  }
  return openings;
}

}  // namespace

Outline find_outline(const cv::Mat& shut, double extent_px, const SketchParams& params) {
  const double scale = std::min(1.0, kLookSide_px / std::max(shut.rows, shut.cols));
  cv::Mat small;
  cv::resize(shut, small, {}, scale, scale, cv::INTER_AREA);
  small = small > 0;
  extent_px = std::min(extent_px, static_cast<double>(std::max(shut.rows, shut.cols)));  // walls may run off the sheet
  const double usual = 0.5 * params.close_gap_share * extent_px;
  double reach = usual * scale;
  cv::Mat inside = inside_by_reach(small, scale * extent_px, params, reach);
  Outline outline{outside_of(shut, usual), {}};
  if (reach <= 1.001 * usual * scale) return outline;
  inside = without_bays(small, inside, inside_of(small, usual * scale));
  cv::Mat closed = shut.clone();
  for (const auto& [a, b] : openings_of(small, inside)) {
    const auto on_wall = [&](const cv::Point& p) {
      const cv::Point at = wall_near(small, p, 4);
      const cv::Point full(static_cast<int>((at.x + 0.5) / scale), static_cast<int>((at.y + 0.5) / scale));
      return wall_near(shut, full, static_cast<int>(std::ceil(2 / scale)));
    };
    const cv::Point from = on_wall(a), to = on_wall(b);
    if (cv::norm(to - from) < 2 * usual) continue;
    cv::line(closed, from, to, cv::Scalar(255), params.min_wall_px);
    outline.openings_px.push_back({Point2(from.x, from.y), Point2(to.x, to.y)});
  }
  outline.outside = outside_of(closed, usual);
  return outline;
}

}  // namespace smokemap
