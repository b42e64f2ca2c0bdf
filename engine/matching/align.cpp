#include "matching/align.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace smokemap {
namespace {

constexpr std::array kScales = {0.65, 0.75, 0.87, 1.0, 1.15};  ///< times the root of the ratio of areas
constexpr std::array kStretches = {0.72, 1.0, 1.39};           ///< along over across the walls
constexpr double kPinSigma_cells = 4;  ///< how far a good alignment of bent maps may leave a pin
constexpr double kPinWeight = 0.06;    ///< score lost at one sigma
constexpr double kPinCap = 9;          ///< in squared sigmas: one wrong pin must not rule out everything

constexpr double kApart = 0.08;  ///< of b's longer side: alignments nearer than this are one

/// Shift that brings each pin of a, already turned and scaled, onto its partner.
std::vector<Point2> pin_shifts(const Eigen::Affine2d& turned, const MapRaster& a, const MapRaster& b,
                               const std::vector<Pin>& pins) {
  std::vector<Point2> shifts;
  for (const Pin& pin : pins) shifts.push_back(b.to_cells(pin.p_b_px) - turned * a.to_cells(pin.p_a_px));
  return shifts;
}

double pin_cost(const std::vector<Point2>& shifts, const Point2& shift) {
  double cost = 0;
  for (const Point2& wanted : shifts)
    cost += std::min(kPinCap, (wanted - shift).squaredNorm() / (kPinSigma_cells * kPinSigma_cells));
  return shifts.empty() ? 0 : kPinWeight * cost;
}

/// Compares one turned and scaled a with all shifts over b at once.
class ShiftCorrelation {
 public:
  explicit ShiftCorrelation(const MapRaster& b) {
    const int side = 2 * std::max(b.depth.cols, b.depth.rows);
    size_ = cv::getOptimalDFTSize(side);
    cv::Mat padded(size_, size_, CV_32FC1, cv::Scalar(0));
    b.depth.copyTo(padded(cv::Rect(0, 0, b.depth.cols, b.depth.rows)));
    energy_b_ = padded.dot(padded);
    cv::dft(padded, spectrum_b_);
  }

  /// Turn and scale of a about its middle, which is laid on the middle of the window.
  Eigen::Affine2d window(const MapRaster& a, const Eigen::Matrix2d& linear) const {
    Eigen::Affine2d window_a = Eigen::Affine2d::Identity();
    window_a.linear() = linear;
    window_a.translation() =
        Point2::Constant(0.5 * size_) - linear * Point2(0.5 * (a.depth.cols - 1), 0.5 * (a.depth.rows - 1));
    return window_a;
  }

  cv::Mat likeness(const MapRaster& a, const Eigen::Affine2d& window_a) const {
    const cv::Matx23d matrix(window_a(0, 0), window_a(0, 1), window_a(0, 2), window_a(1, 0), window_a(1, 1),
                             window_a(1, 2));
    cv::Mat warped, spectrum_a, correlation;
    cv::warpAffine(a.depth, warped, matrix, cv::Size(size_, size_), cv::INTER_LINEAR, cv::BORDER_CONSTANT, 0);
    const double norm = std::sqrt(std::max(1e-9, warped.dot(warped) * energy_b_));
    cv::dft(warped, spectrum_a);
    cv::mulSpectrums(spectrum_b_, spectrum_a, spectrum_a, 0, true);
    cv::dft(spectrum_a, correlation, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
    return correlation / norm;
  }

 private:
  int size_ = 0;
  double energy_b_ = 0;
  cv::Mat spectrum_b_;
};

Eigen::Matrix2d rotation(double angle_rad) { return Eigen::Rotation2Dd(angle_rad).toRotationMatrix(); }

/// Mean distance in pixels of b between where two alignments put the corners of a.
double difference(const MapAlignment& one, const MapAlignment& two, const MapRaster& a) {
  double sum = 0;
  for (const Point2& corner :
       {Point2(0, 0), Point2(a.depth.cols, 0), Point2(0, a.depth.rows), Point2(a.depth.cols, a.depth.rows)})
    sum += (one.T_b_a_px * a.to_px(corner) - two.T_b_a_px * a.to_px(corner)).norm();
  return sum / 4;
}

/// The best of every turn first, because parts and bent maps may look most alike when laid wrongly; then the best of
/// the rest; none twice.
std::vector<MapAlignment> choose(std::vector<std::vector<MapAlignment>>& by_turn, const MapRaster& a, double apart,
                                 size_t count) {
  const auto better = [](const MapAlignment& one, const MapAlignment& two) { return one.score > two.score; };
  std::vector<MapAlignment> chosen, rest;
  for (std::vector<MapAlignment>& turned : by_turn) {
    if (turned.empty()) continue;
    std::stable_sort(turned.begin(), turned.end(), better);
    chosen.push_back(turned.front());
    rest.insert(rest.end(), turned.begin() + 1, turned.end());
  }
  std::stable_sort(chosen.begin(), chosen.end(), better);
  if (chosen.size() > count) chosen.resize(count);
  std::stable_sort(rest.begin(), rest.end(), better);
  for (const MapAlignment& candidate : rest) {
    if (chosen.size() >= count) break;
    if (std::none_of(chosen.begin(), chosen.end(),
                     [&](const MapAlignment& other) { return difference(candidate, other, a) < apart; }))
      chosen.push_back(candidate);
  }
  std::stable_sort(chosen.begin(), chosen.end(), better);
  return chosen;
}

}  // namespace

AlignmentSearch::AlignmentSearch(const MapRaster& a, const MapRaster& b, Facing facing) : a_(a), b_(b) {
  const ShiftCorrelation correlation(b);
  const double scale = std::sqrt(b.free_cells / std::max(1.0, a.free_cells));
  for (int mirror = facing == Facing::kMirrored ? 1 : 0; mirror <= (facing == Facing::kAsDrawn ? 0 : 1); ++mirror)
    for (int quarter = 0; quarter < 4; ++quarter) {
      // Straighten a's walls, mirror, turn by quarters, then into b's wall direction; stretch along b's walls.
      const Eigen::Matrix2d flip = Eigen::Vector2d(mirror ? -1 : 1, 1).asDiagonal();
      const Eigen::Matrix2d straight =
          rotation(quarter * std::numbers::pi / 2) * flip * rotation(-a.wall_direction_rad);
      for (const double size : kScales)
        for (const double stretch : kStretches) {
          const Eigen::Matrix2d scaling =
              (scale * size * Eigen::Vector2d(std::sqrt(stretch), 1 / std::sqrt(stretch))).asDiagonal();
          // Wall directions are modulo 90 degrees: take the smaller of the two equal turns.
          const Eigen::Affine2d window_a = correlation.window(a, rotation(b.wall_direction_rad) * scaling * straight);
          candidates_.push_back({4 * mirror + quarter, window_a, correlation.likeness(a, window_a)});
        }
    }
}

MapAlignment AlignmentSearch::best_shift(const Candidate& candidate, const std::vector<Pin>& pins) const {
  const std::vector<Point2> shifts = pin_shifts(candidate.window_a, a_, b_, pins);
  const int size = candidate.likeness.cols;
  MapAlignment best{candidate.window_a, -1e9};
  Point2 best_shift = Point2::Zero();
  for (int y = 0; y < size; ++y) {
    const auto* row = candidate.likeness.ptr<float>(y);
    for (int x = 0; x < size; ++x) {
      if (row[x] <= best.score) continue;  // pins only cost
      const Point2 shift(x < size / 4 ? x : x - size, y < size / 4 ? y : y - size);
      const double score = row[x] - pin_cost(shifts, shift);
      if (score > best.score) best.score = score, best_shift = shift;
    }
  }
  best.T_b_a_px.pretranslate(best_shift);  // cells so far
  best.T_b_a_px = pixels_of_cells(b_) * best.T_b_a_px * pixels_of_cells(a_).inverse();
  return best;
}

std::vector<MapAlignment> AlignmentSearch::best(const std::vector<Pin>& pins, int count) const {
  std::vector<std::vector<MapAlignment>> by_turn(static_cast<size_t>(candidates_.back().turn) + 1);
  for (const Candidate& candidate : candidates_)
    by_turn[static_cast<size_t>(candidate.turn)].push_back(best_shift(candidate, pins));
  return choose(by_turn, a_, kApart * b_.px_per_cell * std::max(b_.depth.cols, b_.depth.rows),
                static_cast<size_t>(count));
}

}  // namespace smokemap
