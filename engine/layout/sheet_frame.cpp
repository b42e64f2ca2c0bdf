// Idea: a picture frame as bright as paper is taken for its margin. What gives it away is a step in brightness, however
// low, at the same distance inside all sides; a header is a step inside one, and thin printed lines are none.
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/segment2.hpp"
#include "layout/rim_profile.hpp"
#include "layout/sheet.hpp"

namespace smokemap {
namespace {

constexpr double kWidestFrame = 0.05;              ///< of the sheet's long side
constexpr double kStrip = 0.0055;                  ///< of the same: width of the strips that are compared
constexpr int kPlaces = 40;                        ///< along a side
constexpr int kLowStepGrey = 4;                    ///< more than noise leaves in the median of a strip
constexpr double kAlongSide = 0.7;                 ///< of the places must see the step
constexpr double kLikeWidth = 1.35;                ///< times wider or narrower a frame may look on another side
constexpr int kLeastSides = 2;                     ///< on others the rim may have been found
constexpr int kPaperLike = 100, kMostChroma = 40;  ///< what frames and paper are, and headers and walls are not

/// Where the k-th place across a side is.
int offset_of(std::size_t k, int strip) { return strip + 2 + static_cast<int>(k) * strip / 2; }

bool is_paper_like(const Colour& c) {
  const auto [low, high] = std::minmax({c[0], c[1], c[2]});
  return low > kPaperLike && high - low < kMostChroma;
}

/// Places of a side that see a step of the same sign at each offset, as a share.
std::vector<double> steps_inside(const cv::Mat& bgr, const Segment2& side, const Point2& inward, int reach, int strip) {
  const auto count = static_cast<std::size_t>(reach / strip * 2);
  std::vector<int> up(count, 0), down(count, 0);
  for (int i = 0; i < kPlaces; ++i) {
    const Point2 p = side.a + (0.1 + 0.8 * (i + 0.5) / kPlaces) * (side.b - side.a);
    const RimProfile profile(bgr, p, inward, 0, reach + 4 * strip);
    for (std::size_t k = 0; k < count; ++k) {
      const int at = offset_of(k, strip);
      // A line may be printed there: neither strip holds much of it.
      const auto outside = profile.median(std::max(2, at - 3 * strip / 2), at - strip / 3),
                 inside = profile.median(at + strip / 3 + 1, at + 3 * strip / 2 + 1);
      if (!outside || !inside || !is_paper_like(*outside) || !is_paper_like(*inside)) continue;
      const int step = (*inside)[1] - (*outside)[1];
      up[k] += step >= kLowStepGrey, down[k] += step <= -kLowStepGrey;
    }
  }
  std::vector<double> share;
  for (std::size_t k = 0; k < count; ++k) share.push_back(std::max(up[k], down[k]) / static_cast<double>(kPlaces));
  return share;
}

}  // namespace

bool may_be_framed(const cv::Mat& bgr, const SheetCorners& corners_px) {
  double long_side = 0;
  for (std::size_t i = 0; i < 4; ++i) long_side = std::max(long_side, (corners_px[(i + 1) % 4] - corners_px[i]).norm());
  const int strip = std::max(5, static_cast<int>(kStrip * long_side)),
            reach = static_cast<int>(kWidestFrame * long_side);
  std::array<std::vector<double>, 4> steps;
  for (std::size_t i = 0; i < 4; ++i) {
    const Segment2 side{corners_px[i], corners_px[(i + 1) % 4]};
    if (side.length() < 32) return false;
    Point2 inward = side.normal();
    if (inward.dot(corners_px[(i + 2) % 4] - side.a) < 0) inward = -inward;
    steps[i] = steps_inside(bgr, side, inward, reach, strip);
  }
  for (std::size_t k = 0; k < steps[0].size(); ++k) {
    const auto sees = [&](const std::vector<double>& side) {
      for (std::size_t m = 0; m < side.size(); ++m) {
        const double ratio = static_cast<double>(offset_of(m, strip)) / offset_of(k, strip);
        if (ratio < kLikeWidth && ratio * kLikeWidth > 1 && side[m] >= kAlongSide) return true;
      }
      return false;
    };
    if (std::count_if(steps.begin(), steps.end(), sees) >= kLeastSides) return true;
  }
  return false;
}

}  // namespace smokemap
