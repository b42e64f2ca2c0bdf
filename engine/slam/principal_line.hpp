#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/pose2.hpp"

namespace smokemap {

/// The straight line through points in least squares of the distances, from running sums.
class PrincipalLine {
 public:
  struct Fit {
    Point2 mean = Point2::Zero();
    Point2 normal = Point2::UnitX();  ///< unit, either side
    double rms_across_m = 0;
    double rms_along_m = 0;
  };

  void add(const Point2& p, double weight = 1) {
    if (count_++ == 0) offset_ = p;  // sums stay small wherever the points are
    const Point2 d = p - offset_;
    weight_ += weight;
    sum_ += weight * d;
    xx_ += weight * d.x() * d.x();
    xy_ += weight * d.x() * d.y();
    yy_ += weight * d.y() * d.y();
  }
  int count() const { return count_; }

  Fit fit() const {
    Fit fit;
    const Point2 mean = sum_ / weight_;
    const double xx = xx_ / weight_ - mean.x() * mean.x();
    const double xy = xy_ / weight_ - mean.x() * mean.y();
    const double yy = yy_ / weight_ - mean.y() * mean.y();
    const double half_gap = std::hypot(0.5 * (xx - yy), xy), middle = 0.5 * (xx + yy);
    const double along = 0.5 * std::atan2(2 * xy, xx - yy);
    fit.mean = offset_ + mean;
    fit.normal = {-std::sin(along), std::cos(along)};
    fit.rms_across_m = std::sqrt(std::max(0.0, middle - half_gap));
    fit.rms_along_m = std::sqrt(std::max(0.0, middle + half_gap));
    return fit;
  }

 private:
  int count_ = 0;
  double weight_ = 0;
  Point2 offset_ = Point2::Zero(), sum_ = Point2::Zero();
  double xx_ = 0, xy_ = 0, yy_ = 0;
};

}  // namespace smokemap
