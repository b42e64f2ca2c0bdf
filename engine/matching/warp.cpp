#include "matching/warp.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace smokemap {
namespace {

constexpr float kMaxStep_cells = 1.0f;  ///< of the fine raster, as all cells here
constexpr float kMissWeight = 0.1f;
constexpr double kWide_cells = 8.0, kMiddle_cells = 5.0, kNarrow_cells = 3.5;  ///< sigmas of the smoothing
constexpr int kWideRounds = 12, kMiddleRounds = 14, kNarrowRounds = 14;
constexpr double kBendingWeight = 0.35;

cv::Mat affine_field(const Eigen::Affine2d& cells_b_a, const cv::Size& size) {
  cv::Mat field(size, CV_32FC2);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Point2 p = cells_b_a * Point2(x, y);
      field.at<cv::Vec2f>(y, x) = {static_cast<float>(p.x()), static_cast<float>(p.y())};
    }
  return field;
}

cv::Mat look_up(const cv::Mat& image, const cv::Mat& field) {
  cv::Mat found;
  cv::remap(image, found, field, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, 0);
  return found;
}

/// Adds the move of every cell that brings its depth closer to that of the other map.
/// @param seen  depth of b there, and its slope
void add_demon_steps(const cv::Mat& depth_a, const cv::Mat& seen, float fine_per_cell, cv::Mat& moves) {
  const float longest = kMaxStep_cells / fine_per_cell;
  const float miss_weight = kMissWeight * fine_per_cell * fine_per_cell;
  for (int y = 0; y < moves.rows; ++y) {
    const auto* own = depth_a.ptr<float>(y);
    const auto* other = seen.ptr<cv::Vec3f>(y);
    auto* move = moves.ptr<cv::Vec2f>(y);
    for (int x = 0; x < moves.cols; ++x) {
      const float miss = own[x] - other[x][0], gx = other[x][1], gy = other[x][2];
      const float slope = gx * gx + gy * gy;
      if (slope == 0 || miss == 0) continue;
      const float step = miss / (slope + miss * miss * miss_weight + 1e-4f);
      const float length = std::abs(step) * std::sqrt(slope);
      const float kept = length > longest ? step * longest / length : step;
      move[x] += cv::Vec2f(kept * gx, kept * gy);
    }
  }
}

/// How a pin pulls on the moves of a level: the same in every round.
struct PinPull {
  cv::Point cell;    ///< of a, where the pin is
  cv::Vec2f wanted;  ///< cells of b
  cv::Mat strength;  ///< CV_32FC1, 1 at the cell
};

std::vector<PinPull> pulls_of(const MapRaster& a, const MapRaster& b, const std::vector<Pin>& pins,
                              double reach_cells) {
  std::vector<PinPull> pulls;
  for (const Pin& pin : pins) {
    const Point2 at = a.to_cells(pin.p_a_px), to = b.to_cells(pin.p_b_px);
    PinPull pull{{std::clamp(static_cast<int>(std::lround(at.x())), 0, a.depth.cols - 1),
                  std::clamp(static_cast<int>(std::lround(at.y())), 0, a.depth.rows - 1)},
                 {static_cast<float>(to.x()), static_cast<float>(to.y())},
                 cv::Mat(a.depth.size(), CV_32FC1)};
    for (int y = 0; y < a.depth.rows; ++y)
      for (int x = 0; x < a.depth.cols; ++x) {
        const double squared = (x - pull.cell.x) * (x - pull.cell.x) + (y - pull.cell.y) * (y - pull.cell.y);
        pull.strength.at<float>(y, x) = static_cast<float>(std::exp(-squared / (2 * reach_cells * reach_cells)));
      }
    pulls.push_back(std::move(pull));
  }
  return pulls;
}

void pull_to_pins(const std::vector<PinPull>& pulls, const cv::Mat& rigid, cv::Mat& moves) {
  for (const PinPull& pull : pulls) {
    const cv::Vec2f miss = pull.wanted - (rigid.at<cv::Vec2f>(pull.cell) + moves.at<cv::Vec2f>(pull.cell));
    for (int y = 0; y < moves.rows; ++y) {
      const auto* strength = pull.strength.ptr<float>(y);
      auto* move = moves.ptr<cv::Vec2f>(y);
      for (int x = 0; x < moves.cols; ++x) move[x] += strength[x] * miss;
    }
  }
}

double root_mean_square_stretch(const MapRaster& a, const cv::Mat& moves, double scale) {
  double sum = 0, count = 0;
  for (int y = 0; y + 1 < moves.rows; ++y)
    for (int x = 0; x + 1 < moves.cols; ++x) {
      if (a.labels.at<unsigned short>(y, x) == 0) continue;
      const cv::Vec2f right = moves.at<cv::Vec2f>(y, x + 1) - moves.at<cv::Vec2f>(y, x);
      const cv::Vec2f below = moves.at<cv::Vec2f>(y + 1, x) - moves.at<cv::Vec2f>(y, x);
      sum += right.dot(right) + below.dot(below);
      count += 1;
    }
  return count == 0 ? 0 : std::sqrt(sum / count) / scale;
}

/// A field of moves on a coarser raster, as moves on the finer one.
cv::Mat refined_moves(const cv::Mat& moves, const cv::Size& size) {
  cv::Mat places(size, CV_32FC2);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      places.at<cv::Vec2f>(y, x) = {0.5f * (static_cast<float>(x) - 0.5f), 0.5f * (static_cast<float>(y) - 0.5f)};
  cv::Mat fine;
  cv::remap(moves, fine, places, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return 2 * fine;
}

cv::Mat rigid_field(const MapAlignment& alignment, const MapRaster& a, const MapRaster& b) {
  return affine_field(pixels_of_cells(b).inverse() * alignment.T_b_a_px * pixels_of_cells(a), a.depth.size());
}

}  // namespace

BendingPair::Level BendingPair::make_level(const MapRaster& a, const MapRaster& b, double fine_per_cell) {
  std::array<cv::Mat, 3> seen = {b.depth, {}, {}};
  cv::Sobel(b.depth, seen[1], CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(b.depth, seen[2], CV_32F, 0, 1, 3, 1.0 / 8);
  Level level{a, b, {}, fine_per_cell};
  cv::merge(seen.data(), seen.size(), level.seen_b);
  return level;
}

BendingPair::BendingPair(const MapRaster& a, const MapRaster& b)
    : fine_(make_level(a, b, 1)), coarse_(make_level(halved(a), halved(b), 2)) {}

void BendingPair::run_stage(const Level& level, double smooth_cells, int rounds, const std::vector<Pin>& pins,
                            const cv::Mat& rigid, cv::Mat& moves) {
  const double sigma = smooth_cells / level.fine_per_cell;
  const std::vector<PinPull> pulls = pulls_of(level.a, level.b, pins, 2 * sigma);
  for (int round = 0; round < rounds; ++round) {
    add_demon_steps(level.a.depth, look_up(level.seen_b, rigid + moves), static_cast<float>(level.fine_per_cell),
                    moves);
    cv::GaussianBlur(moves, moves, cv::Size(0, 0), sigma, sigma, cv::BORDER_REPLICATE);
    pull_to_pins(pulls, rigid, moves);
  }
}

Warp BendingPair::bend(const MapAlignment& alignment, const std::vector<Pin>& pins) const {
  const MapRaster &a = fine_.a, &b = fine_.b;
  cv::Mat moves(coarse_.a.depth.size(), CV_32FC2, cv::Scalar::all(0));
  const cv::Mat rigid_coarse = rigid_field(alignment, coarse_.a, coarse_.b);
  run_stage(coarse_, kWide_cells, kWideRounds, pins, rigid_coarse, moves);
  run_stage(coarse_, kMiddle_cells, kMiddleRounds, pins, rigid_coarse, moves);
  moves = refined_moves(moves, a.depth.size());
  const cv::Mat rigid = rigid_field(alignment, a, b);
  run_stage(fine_, kNarrow_cells, kNarrowRounds, pins, rigid, moves);
  Warp warp;
  warp.scale = std::sqrt(
      std::abs((pixels_of_cells(b).inverse() * alignment.T_b_a_px * pixels_of_cells(a)).linear().determinant()));
  warp.cells_b = rigid + moves;
  const double density = warp.scale * warp.scale;  // cells of b that one cell of a covers
  const double covered = look_up(b.depth, warp.cells_b).dot(a.depth) * density;
  warp.likeness = covered / std::sqrt(std::max(1e-9, a.depth.dot(a.depth) * density * b.depth.dot(b.depth)));
  warp.bending = root_mean_square_stretch(a, moves, warp.scale);
  warp.score = std::min(1.0, warp.likeness) - kBendingWeight * warp.bending;
  return warp;
}

}  // namespace smokemap
