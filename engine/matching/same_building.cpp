#include "matching/same_building.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kHalfTrusted = 8;  ///< regions at which evidence counts half
constexpr double kPerRatio = 1.27;  ///< logit lost when one map has e times as many regions as the other
constexpr double kPerTap = 0.4;     ///< logit: who is shown a wrong map may well confirm what it shows
constexpr int kMostTaps = 4;        ///< that count: a person may be wrong about the whole building
constexpr double kLeast = 0.02, kMost = 0.99;

}  // namespace

double same_building(const FitEvidence& e, int taps) {
  const double trust = e.regions / (e.regions + kHalfTrusted);
  const double logit = trust * (12.6 * e.likeness + 1.0 * e.explained + 16.2 * e.lead - 7.3) -
                       kPerRatio * std::log(std::max(1.0, e.ratio)) + kPerTap * std::clamp(taps, 0, kMostTaps);
  return std::clamp(1 / (1 + std::exp(-logit)), kLeast, kMost);
}

}  // namespace smokemap
