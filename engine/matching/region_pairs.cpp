#include "matching/region_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "matching/assignment.hpp"

namespace smokemap {
namespace {

constexpr double kLeastLikeness = 0.12;  ///< below this a region rather has no partner
constexpr double kLeastInside = 0.6;     ///< share of a left-over region that must lie in another's partner
constexpr double kNeighbourWeight = 0.3;
constexpr int kNeighbourRounds = 3;

/// Neighbours of every region, by label - 1.
std::vector<std::vector<int>> neighbours(const Segmentation& map) {
  std::vector<std::vector<int>> result(map.regions.size());
  for (const RegionBorder& border : map.borders) {
    result[static_cast<size_t>(border.label_a - 1)].push_back(border.label_b - 1);
    result[static_cast<size_t>(border.label_b - 1)].push_back(border.label_a - 1);
  }
  for (std::vector<int>& list : result) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return result;
}

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

/// How well the neighbours of a pair agree with it: the share of them that find a partner beside the partner.
double neighbour_support(const std::vector<int>& of_i, const std::vector<int>& of_j, int j,
                         const Eigen::MatrixXd& likeness) {
  if (of_i.empty() || of_j.empty()) return 0.5;
  double sum = 0;
  for (const int k : of_i) {
    double best = 0.5 * likeness(k, j);
    for (const int l : of_j) best = std::max(best, likeness(k, l));
    sum += best;
  }
  return sum / static_cast<double>(of_i.size());
}

}  // namespace

PairScores score_pairs(const Segmentation& a, const Segmentation& b, const MapRaster& raster_a,
                       const MapRaster& raster_b, const Warp& warp, const PairRules& rules) {
  const Landing landing = land(a, b, raster_a, raster_b, warp);
  const double density = raster_b.free_cells / std::max(1.0, raster_a.free_cells);
  const Eigen::Index count_a = landing.overlap.rows(), count_b = landing.overlap.cols();
  PairScores scores{Eigen::MatrixXd::Zero(count_a, count_b), landing.overlap, landing.overlap * density};
  Eigen::MatrixXd alone(count_a, count_b);
  for (Eigen::Index i = 0; i < count_a; ++i)
    for (Eigen::Index j = 0; j < count_b; ++j) {
      const double area_a = landing.area_a(i) * density, area_b = landing.area_b(j);
      const double overlap = landing.overlap(i, j) * density;
      scores.share_of_a(i, j) = overlap / area_a;
      scores.share_of_b(i, j) = std::min(1.0, overlap / area_b);
      const double joined = std::max(1e-9, area_a + area_b - overlap);
      const double reach = std::sqrt(area_a / std::numbers::pi) + std::sqrt(area_b / std::numbers::pi) + 2;
      const double apart = (landing.centre_a.row(i) - landing.centre_b.row(j)).norm() / reach;
      const double sizes = std::exp(-0.5 * std::abs(std::log(area_a / area_b)));
      alone(i, j) = 0.5 * std::min(1.0, overlap / joined) + 0.5 * std::exp(-2 * apart * apart) * sizes;
      if (rules.forced(i, j)) alone(i, j) = 1;
      if (rules.forbidden(i, j)) alone(i, j) = 0;
    }
  const auto beside_a = neighbours(a), beside_b = neighbours(b);
  scores.likeness = alone;
  for (int round = 0; round < kNeighbourRounds; ++round) {
    const Eigen::MatrixXd before = scores.likeness;
    for (int i = 0; i < count_a; ++i)
      for (int j = 0; j < count_b; ++j) {
        if (alone(i, j) < 0.02) continue;
        const double support =
            0.5 * (neighbour_support(beside_a[static_cast<size_t>(i)], beside_b[static_cast<size_t>(j)], j, before) +
                   neighbour_support(beside_b[static_cast<size_t>(j)], beside_a[static_cast<size_t>(i)], i,
                                     before.transpose()));
        scores.likeness(i, j) = alone(i, j) * (1 - kNeighbourWeight + kNeighbourWeight * 1.5 * support);
        scores.likeness(i, j) = std::min(1.0, scores.likeness(i, j));
      }
  }
  return scores;
}

std::vector<RegionPair> choose_pairs(const PairScores& scores, const PairRules& rules, bool many_to_many) {
  const Eigen::MatrixXd& likeness = scores.likeness;
  Eigen::MatrixXd gain = (likeness.array() - kLeastLikeness).matrix();
  for (Eigen::Index i = 0; i < gain.rows(); ++i)
    for (Eigen::Index j = 0; j < gain.cols(); ++j) {
      if (rules.forced(i, j)) gain(i, j) = 100;
      if (rules.forbidden(i, j)) gain(i, j) = -1;
    }
  const std::vector<int> partner = best_assignment(gain);
  Eigen::MatrixXd paired = Eigen::MatrixXd::Zero(gain.rows(), gain.cols());
  for (size_t i = 0; i < partner.size(); ++i)
    if (partner[i] >= 0)
      paired(static_cast<Eigen::Index>(i), partner[i]) = likeness(static_cast<Eigen::Index>(i), partner[i]);
  const Eigen::MatrixXd one_to_one = paired;
  for (Eigen::Index i = 0; i < gain.rows(); ++i)
    for (Eigen::Index j = 0; j < gain.cols(); ++j) {
      if (rules.forced(i, j)) paired(i, j) = 1;
      if (!many_to_many || rules.forbidden(i, j)) continue;
      const bool a_is_free = one_to_one.row(i).maxCoeff() <= 0, b_is_free = one_to_one.col(j).maxCoeff() <= 0;
      const bool joins = (a_is_free && scores.share_of_a(i, j) >= kLeastInside) ||
                         (b_is_free && scores.share_of_b(i, j) >= kLeastInside);
      if (joins)
        paired(i, j) = std::max(paired(i, j), 0.6 * std::max(scores.share_of_a(i, j), scores.share_of_b(i, j)));
    }
  std::vector<RegionPair> pairs;
  for (int i = 0; i < gain.rows(); ++i)
    for (int j = 0; j < gain.cols(); ++j)
      if (paired(i, j) > 0) pairs.push_back({i + 1, j + 1, paired(i, j), Verdict::kProposed});
  return pairs;
}

}  // namespace smokemap
