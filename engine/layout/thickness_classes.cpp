#include "layout/thickness_classes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kUsualLimit = 0.25;   ///< of a heap is worth moving the limit of thickness e-fold from the usual
constexpr double kThinOfUsual = 0.85;  ///< partitions beside thicker outer walls differ a little
constexpr double kThinOfAll = 0.5;     ///< where all walls are alike

/// The deepest valley of the length-weighted log histogram between low and high: how much lies there, compared with the
/// smaller of the heaps on its two sides. Where there is no valley, `otherwise`.
double valley(const std::vector<InkStroke>& strokes, double low, double high, double otherwise) {
  constexpr int kBinsPerFold = 24;
  constexpr double kThinnest = 0.2, kSpread = 0.07;
  const int bins = 1 + static_cast<int>(kBinsPerFold * std::log(std::max(2.0, 20 * high / kThinnest)));
  std::vector<double> weight(static_cast<std::size_t>(bins), 0.0);
  for (const auto& s : strokes) {
    const double position = kBinsPerFold * std::log(std::max(kThinnest, s.thickness_px) / kThinnest);
    for (int b = 0; b < bins; ++b) {
      const double away = (b + 0.5 - position) / (kSpread * kBinsPerFold);
      if (std::abs(away) < 3) weight[static_cast<std::size_t>(b)] += s.length() * std::exp(-0.5 * away * away);
    }
  }
  std::vector<double> heap_above(weight);
  for (std::size_t b = weight.size() - 1; b-- > 0;) heap_above[b] = std::max(heap_above[b], heap_above[b + 1]);
  double best = 1e300, at = otherwise, heap_below = 0;
  for (std::size_t b = 0; b < weight.size(); ++b) {
    heap_below = std::max(heap_below, weight[b]);
    const double t = kThinnest * std::exp((static_cast<double>(b) + 0.5) / kBinsPerFold);
    if (t < low || t > high) continue;
    const double heap = std::min(heap_below, heap_above[b]);
    const double cost = (heap > 0 ? weight[b] / heap : 1) + kUsualLimit * std::abs(std::log(t / otherwise));
    if (cost < best) best = cost, at = t;
  }
  return best < 1 ? at : otherwise;
}

/// By how much (log) lines that run across look thicker than upright ones. Walls of one kind are drawn alike whichever
/// way they run, but a photograph taken from below or aside shortens one way: the shift at which the two heaps of
/// thicknesses agree best; 0 if it is small or hardly better than none.
double tilt_of_thickness(const std::vector<InkStroke>& strokes) {
  constexpr int kBinsPerFold = 20, kBins = 110, kMostShift = 9, kLeastShift = 3;
  constexpr double kThinnest = 0.3, kBetter = 1.25;
  std::array<std::array<double, kBins>, 2> heap{};
  for (const auto& s : strokes) {
    if (s.length() < 4 * s.thickness_px) continue;
    const double place = kBinsPerFold * std::log(std::max(kThinnest, s.thickness_px) / kThinnest);
    auto& own = heap[std::abs(std::sin(s.axis.heading())) > std::sqrt(0.5) ? 1 : 0];
    for (int b = std::max(0, static_cast<int>(place) - 3); b < std::min(kBins, static_cast<int>(place) + 5); ++b)
      own[static_cast<std::size_t>(b)] +=
          s.length() * s.thickness_px * std::exp(-0.5 * std::pow((b + 0.5 - place) / 1.4, 2));
  }
  const auto agreement = [&](int shift) {
    double sum = 0;
    for (int b = std::max(0, -shift); b < std::min(kBins, kBins - shift); ++b)
      sum += std::min(heap[0][static_cast<std::size_t>(b + shift)], heap[1][static_cast<std::size_t>(b)]);
    return sum;
  };
  int best = 0;
  for (int shift = -kMostShift; shift <= kMostShift; ++shift)
    if (std::abs(shift) >= kLeastShift && agreement(shift) > kBetter * agreement(0) &&
        agreement(shift) > agreement(best))
      best = shift;
  return static_cast<double>(best) / kBinsPerFold;
}

}  // namespace

double weighted_quantile(std::vector<std::pair<double, double>> value_weight, double share) {
  if (value_weight.empty()) return 0;
  std::sort(value_weight.begin(), value_weight.end());
  double total = 0, sum = 0;
  for (const auto& [value, weight] : value_weight) total += weight;
  for (const auto& [value, weight] : value_weight) {
    sum += weight;
    if (sum >= share * total) return value;
  }
  return value_weight.back().first;
}

void straighten_thickness(std::vector<InkStroke>& strokes) {
  const double tilt = tilt_of_thickness(strokes);
  if (tilt == 0) return;
  for (auto& s : strokes) s.thickness_px *= std::exp(-0.5 * tilt * std::cos(2 * s.axis.heading()));
}

ThicknessClasses thickness_classes(const std::vector<InkStroke>& plan, const LayoutParams& params) {
  std::vector<std::pair<double, double>> by_area;
  for (const auto& s : plan)
    if (s.length() >= 2.5 * s.thickness_px) by_area.emplace_back(s.thickness_px, s.length() * s.thickness_px);
  ThicknessClasses classes;
  classes.usual_px = weighted_quantile(by_area, 0.6);
  classes.outer_px = std::max(classes.usual_px, weighted_quantile(by_area, 0.9));
  const double most = std::max(kThinOfAll * classes.usual_px,
                               std::min(1.5 * params.thin_ratio * classes.outer_px, kThinOfUsual * classes.usual_px));
  classes.thin_limit_px =
      valley(plan, 0.7 * params.thin_ratio * classes.usual_px, most, 0.9 * params.thin_ratio * classes.outer_px);
  return classes;
}

}  // namespace smokemap
