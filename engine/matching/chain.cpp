#include "matching/chain.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace smokemap {
namespace {

constexpr int kTries = 4;  ///< each looks half as far, until the second way has a place somewhere

/// Variance per coordinate of where points around `p` come out, for points that scatter by `sigma`.
double scattered(const Point2& p, double sigma, const Point2& middle, const PointWay& second) {
  double look = 1;
  for (int trial = 0; trial < kTries; ++trial, look *= 0.5) {
    const double step = std::numbers::sqrt2 * sigma * look;
    double sum = 0, count = 0;
    for (const Point2& way : {Point2(step, 0), Point2(-step, 0), Point2(0, step), Point2(0, -step)})
      if (const Transferred there = second(p + way); there.p) sum += (*there.p - middle).squaredNorm() / 2, count += 1;
    if (count > 0) return sum / count / (look * look);
  }
  return 0;
}

}  // namespace

Transferred carry_on(const Transferred& first, const PointWay& second) {
  if (!first.p) return first;
  Transferred there = second(*first.p);
  if (!there.p) return there;
  there.sigma = std::sqrt(there.sigma * there.sigma + scattered(*first.p, first.sigma, *there.p, second));
  there.confidence *= first.confidence;
  return there;
}

PointWay chained(PointWay first, PointWay second) {
  return [first = std::move(first), second = std::move(second)](const Point2& p) { return carry_on(first(p), second); };
}

}  // namespace smokemap
