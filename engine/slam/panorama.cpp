#include "slam/panorama.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kEdgeOn = 0.17;  ///< cosine of the angle to the normal: flatter than 10 degrees

}  // namespace

std::size_t Panorama::bearing_of(const Point2& away) {
  const double share = (std::atan2(away.y(), away.x()) + kPi) / (2 * kPi);
  return static_cast<std::size_t>(share * kBearings) % kBearings;
}

void Panorama::add(const Point2& p, const Point2& normal) {
  const Point2 away = p - p_eye_;
  const double range = away.norm();
  if (range <= 0 || -normal.dot(away) < kEdgeOn * range) return;
  Seen& seen = seen_[bearing_of(away)];
  if (seen.range_m > 0 && seen.range_m <= range) return;
  seen = {range, p, normal};
}

Panorama::Sight Panorama::look(const Point2& p, Point2& normal) const {
  const Point2 away = p - p_eye_;
  const double range = away.norm();
  const std::size_t middle = bearing_of(away);
  bool through = true, before = true;
  for (const std::size_t b : {middle + kBearings - 1, middle, middle + 1}) {
    const Seen& seen = seen_[b % kBearings];
    if (seen.range_m <= 0) return Sight::kOpen;
    const double across = seen.normal.dot(p - seen.p);
    if (std::abs(across) <= margin_m_ || std::abs(seen.range_m - range) <= margin_m_) {
      normal = seen.normal;
      return Sight::kAgrees;
    }
    through = through && range > seen.range_m && across < 0;
    before = before && range < seen.range_m;
  }
  return through ? Sight::kThrough : before ? Sight::kBefore : Sight::kOpen;
}

}  // namespace smokemap
