#include "matching/warp.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace smokemap {
namespace {

struct Stage {
  double smooth_cells;  ///< sigma of the smoothing of the whole field
  int rounds;
};
constexpr std::array kStages = {Stage{8.0, 12}, Stage{5.0, 14}, Stage{3.5, 14}};
constexpr float kMaxStep_cells = 1.0f;
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

double cosine(const cv::Mat& one, const cv::Mat& two, double energy_two) {
  return one.dot(two) / std::sqrt(std::max(1e-9, one.dot(one) * energy_two));
}

/// Move of every cell that brings its depth closer to that of the other map.
cv::Mat demon_steps(const MapRaster& a, const cv::Mat& seen, const cv::Mat& seen_gx, const cv::Mat& seen_gy) {
  cv::Mat steps(a.depth.size(), CV_32FC2);
  for (int y = 0; y < steps.rows; ++y)
    for (int x = 0; x < steps.cols; ++x) {
      const float miss = a.depth.at<float>(y, x) - seen.at<float>(y, x);
      const float gx = seen_gx.at<float>(y, x), gy = seen_gy.at<float>(y, x);
      const float weight = gx * gx + gy * gy + miss * miss * 0.1f + 1e-4f;
      cv::Vec2f step(miss * gx / weight, miss * gy / weight);
      const float length = std::hypot(step[0], step[1]);
      if (length > kMaxStep_cells) step *= kMaxStep_cells / length;
      steps.at<cv::Vec2f>(y, x) = step;
    }
  return steps;
}

void pull_to_pins(const MapRaster& a, const MapRaster& b, const std::vector<Pin>& pins, double reach_cells,
                  const cv::Mat& rigid, cv::Mat& moves) {
  for (const Pin& pin : pins) {
    const Point2 at = a.to_cells(pin.p_a_px);
    const int cx = std::clamp(static_cast<int>(std::lround(at.x())), 0, moves.cols - 1);
    const int cy = std::clamp(static_cast<int>(std::lround(at.y())), 0, moves.rows - 1);
    const Point2 wanted = b.to_cells(pin.p_b_px);
    const cv::Vec2f here = rigid.at<cv::Vec2f>(cy, cx) + moves.at<cv::Vec2f>(cy, cx);
    const cv::Vec2f miss(static_cast<float>(wanted.x()) - here[0], static_cast<float>(wanted.y()) - here[1]);
    for (int y = 0; y < moves.rows; ++y)
      for (int x = 0; x < moves.cols; ++x) {
        const double squared = (x - cx) * (x - cx) + (y - cy) * (y - cy);
        const auto pull = static_cast<float>(std::exp(-squared / (2 * reach_cells * reach_cells)));
        moves.at<cv::Vec2f>(y, x) += pull * miss;
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

}  // namespace

Warp bend(const MapAlignment& alignment, const MapRaster& a, const MapRaster& b, const std::vector<Pin>& pins) {
  const Eigen::Affine2d cells_b_a = pixels_of_cells(b).inverse() * alignment.T_b_a_px * pixels_of_cells(a);
  const cv::Mat rigid = affine_field(cells_b_a, a.depth.size());
  const double scale = std::sqrt(std::abs(cells_b_a.linear().determinant()));
  cv::Mat gx, gy, moves(a.depth.size(), CV_32FC2, cv::Scalar::all(0));
  cv::Sobel(b.depth, gx, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(b.depth, gy, CV_32F, 0, 1, 3, 1.0 / 8);
  for (const Stage& stage : kStages)
    for (int round = 0; round < stage.rounds; ++round) {
      const cv::Mat field = rigid + moves;
      moves += demon_steps(a, look_up(b.depth, field), look_up(gx, field), look_up(gy, field));
      cv::GaussianBlur(moves, moves, cv::Size(0, 0), stage.smooth_cells, stage.smooth_cells, cv::BORDER_REPLICATE);
      pull_to_pins(a, b, pins, 2 * stage.smooth_cells, rigid, moves);
    }
  Warp warp;
  warp.scale = scale;
  warp.cells_b = rigid + moves;
  const double density = scale * scale;  // cells of b that one cell of a covers
  warp.likeness = cosine(look_up(b.depth, warp.cells_b), a.depth, a.depth.dot(a.depth));
  const double covered = look_up(b.depth, warp.cells_b).dot(a.depth) * density;
  warp.likeness = covered / std::sqrt(std::max(1e-9, a.depth.dot(a.depth) * density * b.depth.dot(b.depth)));
  warp.bending = root_mean_square_stretch(a, moves, scale);
  warp.score = std::min(1.0, warp.likeness) - kBendingWeight * warp.bending;
  return warp;
}

}  // namespace smokemap
