#pragma once

#include <array>
#include <cstdint>

#include "geometry/pose2.hpp"

namespace smokemap {

/// What is to be seen from one place: by bearing, the nearest of the surfaces that were added. Asked whether a point
/// that was measured from this place agrees with that.
class Panorama {
 public:
  enum class Sight : std::uint8_t {
    kOpen,     ///< no surface is known in this direction, or one of its neighbours: nothing to say
    kAgrees,   ///< on the surface
    kThrough,  ///< behind it: the two cannot both be true
    kBefore,   ///< in front of it: something that was not there, or had not been seen
  };

  /// @param margin_m  across the surface; nearer is on it
  explicit Panorama(const Point2& p_eye, double margin_m) : p_eye_(p_eye), margin_m_(margin_m) {}
  /// Surfaces that turn their back on the eye, or are seen edge on, show nothing.
  void add(const Point2& p, const Point2& normal);
  /// @param normal  of the surface that agrees
  Sight look(const Point2& p, Point2& normal) const;

 private:
  static constexpr int kBearings = 360;
  struct Seen {
    double range_m = 0;  ///< 0 = nothing
    Point2 p, normal;
  };
  static std::size_t bearing_of(const Point2& away);

  Point2 p_eye_;
  double margin_m_;
  std::array<Seen, kBearings> seen_{};
};

}  // namespace smokemap
