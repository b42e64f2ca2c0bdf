#include "layout/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "geometry/angle.hpp"
#include "geometry/segment2.hpp"

namespace smokemap {
namespace {

// Logits of the chance that a stroke is a wall; every feature lies in 0..1.
constexpr double kWallBias = -3.2, kByInk = 2.2, kByThickness = -1.7, kByLength = 5.4, kByAttachment = 4.4;
// Logits of the chance that a corner is one.
constexpr double kCornerBias = -4.4, kByWeakest = 2.65, kBySecond = 4.0;
constexpr double kSurestCorner = 0.89;
constexpr double kSameEndPx = 2.5;  ///< an opening begins where a wall ends

// Of a row of treads or hatching.
constexpr int kLeastRow = 4;            ///< others like it
constexpr double kLikeLength = 1.6;     ///< times longer or shorter
constexpr double kTreadSpacing = 0.35;  ///< of their length; partitions of offices are farther apart
constexpr double kHatchSpacing = 0.6;   ///< where they run askew to most walls, or are short
constexpr double kShortShare = 0.05;    ///< of the plan's extent
constexpr double kInARow = 0.45;        ///< of the confidence is left

double chance(double logit) { return 1 / (1 + std::exp(-logit)); }

/// Half of the walls' length is thicker.
double usual_thickness(const LayoutMap& map) {
  std::vector<std::pair<double, double>> thickness_length;
  double all = 0, sum = 0;
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const double length = map.wall_px(static_cast<int>(w)).length();
    thickness_length.emplace_back(map.walls[w].thickness_px, length);
    all += length;
  }
  std::sort(thickness_length.begin(), thickness_length.end());
  for (const auto& [thickness, length] : thickness_length)
    if ((sum += length) >= 0.5 * all) return thickness;
  return 1;
}

bool meets_something(const LayoutMap& map, int corner) {
  const auto& c = map.corners[static_cast<std::size_t>(corner)];
  return c.degree > 1 || std::any_of(map.openings.begin(), map.openings.end(), [&](const LayoutOpening& o) {
           return (o.gap_px.a - c.p_px).norm() < kSameEndPx || (o.gap_px.b - c.p_px).norm() < kSameEndPx;
         });
}

void grade_corners(LayoutMap& map) {
  std::vector<std::vector<double>> walls_of(map.corners.size());
  for (const auto& w : map.walls)
    for (const int c : {w.corner_a, w.corner_b}) walls_of[static_cast<std::size_t>(c)].push_back(w.confidence);
  for (std::size_t c = 0; c < map.corners.size(); ++c) {
    auto& confidences = walls_of[c];
    std::sort(confidences.begin(), confidences.end(), std::greater<>());
    const double weakest = confidences.empty() ? 0 : confidences.back();
    const double second = confidences.size() > 1 ? confidences[1] : weakest;
    map.corners[c].confidence =
        std::min(kSurestCorner, chance(kCornerBias + kByWeakest * weakest + kBySecond * second));
  }
}

/// Heading modulo a right angle of most walls, by length.
double main_heading(const LayoutMap& map) {
  Point2 sum = Point2::Zero();
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const Segment2 s = map.wall_px(static_cast<int>(w));
    sum += s.length() * Point2(std::cos(4 * s.heading()), std::sin(4 * s.heading()));
  }
  return 0.25 * std::atan2(sum.y(), sum.x());
}

/// Walls like one another side by side, closer than walls stand: treads of a stair, lines of hatching, shelves.
class Rows {
 public:
  Rows(const LayoutMap& map, double extent_px) : heading_(main_heading(map)), short_px_(kShortShare * extent_px) {
    for (std::size_t w = 0; w < map.walls.size(); ++w) walls_.push_back(map.wall_px(static_cast<int>(w)));
    std::vector<bool> within(walls_.size());
    for (std::size_t w = 0; w < walls_.size(); ++w) within[w] = others_like(w, {}) >= kLeastRow;
    members_ = within;
    for (std::size_t w = 0; w < walls_.size(); ++w)  // the ends of a row have others on one side only
      if (!within[w]) members_[w] = others_like(w, within) >= kLeastRow / 2;
  }
  bool holds(std::size_t wall) const { return members_[wall]; }

 private:
  /// @param among  counts only; empty = all
  std::ptrdiff_t others_like(std::size_t of, const std::vector<bool>& among) const {
    const Segment2& wall = walls_[of];
    const double length = wall.length(), turn = line_angle_between(wall.heading(), heading_);
    const bool askew = std::min(turn, kPi / 2 - turn) > radians(15);
    const double spacing = askew || length < short_px_ ? kHatchSpacing : kTreadSpacing;
    std::ptrdiff_t count = 0;
    for (std::size_t o = 0; o < walls_.size(); ++o) {
      if (!among.empty() && !among[o]) continue;
      const double off = std::abs(signed_line_distance(wall, walls_[o].midpoint()));
      const double t = along(wall, walls_[o].midpoint()), ratio = walls_[o].length() / std::max(length, 1e-9);
      count += off > 0.05 * length && off < 0.5 * kLeastRow * spacing * length &&
               std::abs(t - 0.5) < (askew ? 1.5 : 0.5) && ratio < kLikeLength && ratio * kLikeLength > 1 &&
               line_angle_between(walls_[o].heading(), wall.heading()) < radians(8);
    }
    return count;
  }

  double heading_, short_px_;
  std::vector<Segment2> walls_;
  std::vector<bool> members_;
};

}  // namespace

void grade_confidence(LayoutMap& map) {
  if (map.walls.empty()) return;
  Point2 low = map.corners.front().p_px, high = low;
  for (const auto& c : map.corners) low = low.cwiseMin(c.p_px), high = high.cwiseMax(c.p_px);
  const double extent = std::max(1.0, (high - low).maxCoeff()), usual = std::max(0.3, usual_thickness(map));
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    auto& wall = map.walls[w];
    if (wall.by_person) continue;
    const double odd = std::min(1.0, std::abs(std::log(std::max(wall.thickness_px, 0.3) / usual)));
    const double length = std::min(1.0, std::log1p(20 * map.wall_px(static_cast<int>(w)).length() / extent) / 3);
    const double attached = 0.5 * (meets_something(map, wall.corner_a) + meets_something(map, wall.corner_b));
    wall.confidence = chance(kWallBias + kByInk * wall.confidence + kByThickness * odd + kByLength * length +
                             kByAttachment * attached);
  }
  const Rows rows(map, extent);
  for (std::size_t w = 0; w < map.walls.size(); ++w)
    if (!map.walls[w].by_person && rows.holds(w)) map.walls[w].confidence *= kInARow;
  grade_corners(map);
}

}  // namespace smokemap
