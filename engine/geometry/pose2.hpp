#pragma once

#include <Eigen/Core>
#include <cmath>

#include "geometry/angle.hpp"

namespace smokemap {

using Point2 = Eigen::Vector2d;

/// A planar rigid motion. `T_a_b` maps points of frame b into frame a, and T_a_c = T_a_b * T_b_c.
/// Heading counter-clockwise from +x, wrapped to [-pi, pi) at creation.
class Pose2 {
 public:
  Pose2() = default;
  Pose2(double x, double y, double heading) : translation_(x, y), heading_(wrap_angle(heading)) {}
  Pose2(const Point2& translation, double heading) : translation_(translation), heading_(wrap_angle(heading)) {}

  const Point2& translation() const { return translation_; }
  double x() const { return translation_.x(); }
  double y() const { return translation_.y(); }
  double heading() const { return heading_; }
  Eigen::Matrix2d rotation() const {
    const double c = std::cos(heading_), s = std::sin(heading_);
    return (Eigen::Matrix2d() << c, -s, s, c).finished();
  }
  bool is_finite() const { return translation_.allFinite() && std::isfinite(heading_); }

  Pose2 inverse() const { return {-(rotation().transpose() * translation_), -heading_}; }
  /// x, y, heading as a vector; not the logarithm of SE(2).
  Eigen::Vector3d vector() const { return {x(), y(), heading_}; }

  friend Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
    return {T_a_b * T_b_c.translation_, T_a_b.heading_ + T_b_c.heading_};
  }
  friend Point2 operator*(const Pose2& T_a_b, const Point2& p_b) { return T_a_b.translation_ + T_a_b.rotation() * p_b; }

 private:
  Point2 translation_ = Point2::Zero();
  double heading_ = 0;
};

/// z of the cross product: twice the signed area of the triangle (0, a, b).
inline double cross(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// From a to b at share t in [0, 1]: straight line, shortest turn.
inline Pose2 interpolate(const Pose2& a, const Pose2& b, double t) {
  return {a.translation() + t * (b.translation() - a.translation()),
          a.heading() + t * wrap_angle(b.heading() - a.heading())};
}

}  // namespace smokemap
