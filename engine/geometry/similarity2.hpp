#pragma once

#include <vector>

#include "core/result.hpp"
#include "geometry/pose2.hpp"

namespace smokemap {

/// Turn, uniform scale and shift: p_a = scale * R * p_b + t.
struct Similarity2 {
  double scale = 1;
  Pose2 T_a_b;  ///< rotation and translation

  Point2 operator*(const Point2& p_b) const { return T_a_b.translation() + scale * (T_a_b.rotation() * p_b); }
  Similarity2 inverse() const;
};

/// One place seen in two frames.
struct PointPair {
  Point2 p_a = Point2::Zero();
  Point2 p_b = Point2::Zero();
  double sigma_m = 0.1;  ///< of the pair, in frame a
};

/// Weighted least squares over two or more pairs (Umeyama 1991, no reflection).
/// kDegenerate for fewer than two distinct points in either frame.
Result<Similarity2> fit_similarity(const std::vector<PointPair>& pairs);

}  // namespace smokemap
