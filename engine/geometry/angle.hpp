#pragma once

#include <cmath>
#include <numbers>

namespace smokemap {

constexpr double kPi = std::numbers::pi;

/// Into [-pi, pi).
inline double wrap_angle(double radians) {
  const double turned = std::fmod(radians + kPi, 2 * kPi);
  return turned < 0 ? turned + kPi : turned - kPi;
}

/// Smallest turn between two undirected lines, in [0, pi/2].
inline double line_angle_between(double a, double b) {
  const double turn = std::abs(wrap_angle(a - b));
  return turn > kPi / 2 ? kPi - turn : turn;
}

constexpr double degrees(double radians) { return radians * 180.0 / kPi; }
constexpr double radians(double degrees_) { return degrees_ * kPi / 180.0; }

}  // namespace smokemap
