#include "layout/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace smokemap {
namespace {

// Logits of the chance that a stroke is a wall; every feature lies in 0..1.
constexpr double kWallBias = -3.2, kByInk = 2.2, kByThickness = -1.7, kByLength = 5.4, kByAttachment = 4.4;
// Logits of the chance that a corner is one.
constexpr double kCornerBias = -4.4, kByWeakest = 2.65, kBySecond = 4.0;
constexpr double kSurestCorner = 0.89;
constexpr double kSameEndPx = 2.5;  ///< an opening begins where a wall ends

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
  grade_corners(map);
}

}  // namespace smokemap
