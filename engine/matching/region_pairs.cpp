#include "matching/region_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kBlur_cells = 4.5;    ///< how far a room may lie from its place, added to the size of the rooms
constexpr double kSizeSpread = 0.7;    ///< standard deviation of the logarithm of drawn over true area
constexpr double kOverlapShare = 0.4;  ///< of the likeness; the rest is place and size
constexpr double kLeastInside = 0.6;   ///< share of a left-over region that must lie in another's partner

struct Landing {
  Eigen::MatrixXd overlap;    ///< cells of a
  Eigen::VectorXd area_a;     ///< cells of a
  Eigen::VectorXd area_b;     ///< cells of b
  Eigen::MatrixX2d centre_a;  ///< in cells of b, after warping
  Eigen::MatrixX2d centre_b;  ///< in cells of b
};

Landing land(const Segmentation& a, const Segmentation& b, const MapRaster& raster_a, const MapRaster& raster_b,
             const Warp& warp) {
  const auto count_a = static_cast<Eigen::Index>(a.regions.size()),
             count_b = static_cast<Eigen::Index>(b.regions.size());
  Landing landing{Eigen::MatrixXd::Zero(count_a, count_b), Eigen::VectorXd::Zero(count_a),
                  Eigen::VectorXd::Zero(count_b), Eigen::MatrixX2d::Zero(count_a, 2),
                  Eigen::MatrixX2d::Zero(count_b, 2)};
  for (int y = 0; y < raster_a.labels.rows; ++y)
    for (int x = 0; x < raster_a.labels.cols; ++x) {
      const int i = raster_a.labels.at<unsigned short>(y, x) - 1;
      if (i < 0) continue;
      const cv::Vec2f to = warp.cells_b.at<cv::Vec2f>(y, x);
      landing.area_a(i) += 1;
      landing.centre_a.row(i) += Eigen::RowVector2d(to[0], to[1]);
      const int bx = static_cast<int>(std::lround(to[0])), by = static_cast<int>(std::lround(to[1]));
      if (bx < 0 || by < 0 || bx >= raster_b.labels.cols || by >= raster_b.labels.rows) continue;
      if (const int j = raster_b.labels.at<unsigned short>(by, bx) - 1; j >= 0) landing.overlap(i, j) += 1;
    }
  for (int y = 0; y < raster_b.labels.rows; ++y)
    for (int x = 0; x < raster_b.labels.cols; ++x)
      if (const int j = raster_b.labels.at<unsigned short>(y, x) - 1; j >= 0) {
        landing.area_b(j) += 1;
        landing.centre_b.row(j) += Eigen::RowVector2d(x, y);
      }
  // A region too small for the raster still has its anchor; its landing is looked up there.
  for (Eigen::Index i = 0; i < count_a; ++i)
    if (landing.area_a(i) == 0) {
      const Point2 at = raster_a.to_cells(a.regions[static_cast<size_t>(i)].anchor_px);
      const int x = std::clamp(static_cast<int>(std::lround(at.x())), 0, raster_a.labels.cols - 1);
      const int y = std::clamp(static_cast<int>(std::lround(at.y())), 0, raster_a.labels.rows - 1);
      const cv::Vec2f to = warp.cells_b.at<cv::Vec2f>(y, x);
      landing.area_a(i) = 1;
      landing.centre_a.row(i) = Eigen::RowVector2d(to[0], to[1]);
    }
  for (Eigen::Index j = 0; j < count_b; ++j)
    if (landing.area_b(j) == 0) {
      landing.area_b(j) = 1;
      landing.centre_b.row(j) = raster_b.to_cells(b.regions[static_cast<size_t>(j)].anchor_px).transpose();
    }
  for (Eigen::Index i = 0; i < count_a; ++i) landing.centre_a.row(i) /= landing.area_a(i);
  for (Eigen::Index j = 0; j < count_b; ++j) landing.centre_b.row(j) /= landing.area_b(j);
  return landing;
}

}  // namespace

PairScores score_pairs(const Segmentation& a, const Segmentation& b, const MapRaster& raster_a,
                       const MapRaster& raster_b, const Warp& warp) {
  const Landing landing = land(a, b, raster_a, raster_b, warp);
  const double density = warp.scale * warp.scale;
  const Eigen::Index count_a = landing.overlap.rows(), count_b = landing.overlap.cols();
  PairScores scores{Eigen::MatrixXd::Zero(count_a, count_b), landing.overlap, landing.overlap * density};
  for (Eigen::Index i = 0; i < count_a; ++i)
    for (Eigen::Index j = 0; j < count_b; ++j) {
      const double area_a = landing.area_a(i) * density, area_b = landing.area_b(j);
      const double overlap = landing.overlap(i, j) * density;
      scores.share_of_a(i, j) = overlap / area_a;
      scores.share_of_b(i, j) = std::min(1.0, overlap / area_b);
      const double joined = std::max(1e-9, area_a + area_b - overlap);
      const double reach = 0.5 * (std::sqrt(area_a) + std::sqrt(area_b)) + kBlur_cells;
      const double apart = (landing.centre_a.row(i) - landing.centre_b.row(j)).norm() / reach;
      const double log_size = std::log(area_a / area_b) / kSizeSpread;
      scores.likeness(i, j) = kOverlapShare * std::min(1.0, overlap / joined) +
                              (1 - kOverlapShare) * std::exp(-0.5 * (apart * apart + log_size * log_size));
    }
  return scores;
}

std::vector<RegionPair> joined_pairs(const std::vector<int>& partner, const PairScores& scores,
                                     const Eigen::MatrixXi& forbidden) {
  std::vector<RegionPair> pairs;
  std::vector<bool> taken(static_cast<size_t>(scores.likeness.cols()), false);
  for (const int j : partner)
    if (j >= 0) taken[static_cast<size_t>(j)] = true;
  for (int i = 0; i < scores.likeness.rows(); ++i)
    for (int j = 0; j < scores.likeness.cols(); ++j) {
      const bool is_partner = partner[static_cast<size_t>(i)] == j;
      const bool joins = partner[static_cast<size_t>(i)] >= 0 && !taken[static_cast<size_t>(j)] && !forbidden(i, j) &&
                         scores.share_of_b(i, j) >= kLeastInside;
      if (is_partner || joins)
        pairs.push_back({i + 1, j + 1, is_partner ? 1.0 : 0.6 * scores.share_of_b(i, j), Verdict::kProposed});
    }
  return pairs;
}

}  // namespace smokemap
