#include "matching/same_building.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kHalfTrusted = 8;  ///< regions at which evidence counts half
constexpr double kPerTap = 0.8;     ///< logit
constexpr int kMostTaps = 4;        ///< that count: a person may be wrong about the whole building
constexpr double kLeast = 0.02, kMost = 0.99;

}  // namespace

double same_building(const FitEvidence& e, int taps) {
  const double trust = e.regions / (e.regions + kHalfTrusted);
  const double logit =
      trust * (9.7 * e.likeness + 7.1 * e.explained + 12.3 * e.lead - 10.6) + kPerTap * std::clamp(taps, 0, kMostTaps);
  return std::clamp(1 / (1 + std::exp(-logit)), kLeast, kMost);
}

}  // namespace smokemap
