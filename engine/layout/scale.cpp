// Idea: every hint is a likelihood over the logarithm of metres per pixel, with humps where the hint allows several
// readings. They are multiplied on a fine grid; the highest place is the guess, and the spread around it, other humps
// included, is its sigma.
#include "layout/scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/angle.hpp"
#include "layout/doors.hpp"

namespace smokemap {
namespace {

constexpr double kBarSigma = 0.02;    ///< a division is measured that well
constexpr double kBarWrong = 0.05;    ///< what looks like a bar is none
constexpr double kSheetSigma = 0.03;  ///< margins cut off, paper stretched
constexpr double kSheetOther = 0.15;  ///< drawn at no round ratio, or on another paper
constexpr double kWorthSaying = 0.7;  ///< a guess with a larger sigma is none

constexpr std::array<double, 7> kDivisionsM{0.5, 1, 2, 5, 10, 20, 50};
constexpr std::array<std::array<double, 2>, 3> kPapersM{{{0.297, 0.4}, {0.420, 0.45}, {0.594, 0.15}}};  ///< side, share
constexpr std::array<double, 9> kRatios{50, 100, 150, 200, 250, 300, 350, 400, 500};

constexpr double kLowestM = 5e-4, kHighestM = 0.5;  ///< metres per pixel that a plan may have
constexpr double kGridStep = 0.005;                 ///< of the logarithm

struct Hump {
  double at = 0;  ///< logarithm of metres per pixel
  double weight = 1;
  double sigma = 1;
};

/// Likelihood at a place: the humps over a floor that says the hint itself may be wrong.
double likelihood(const std::vector<Hump>& humps, double floor, double at) {
  double sum = 0, weights = 0;
  for (const auto& h : humps) {
    const double away = (at - h.at) / h.sigma;
    if (std::abs(away) < 8) sum += h.weight * std::exp(-0.5 * away * away) / h.sigma;
    weights += h.weight;
  }
  const double flat = std::sqrt(2 * kPi) / std::log(kHighestM / kLowestM);
  return (1 - floor) * sum / weights + floor * flat;
}

/// @param usual  width of a door
std::vector<Hump> doors_say(std::vector<double> widths, double usual, const LayoutParams& params) {
  std::sort(widths.begin(), widths.end());
  const auto at = [&](double share) {
    return widths[static_cast<std::size_t>(share * static_cast<double>(widths.size() - 1))];
  };
  const double spread = 0.74 * std::log(std::max(1.0, at(0.75) / std::max(1e-9, at(0.25))));
  const double sigma = std::hypot(params.door_width_sigma, spread / std::sqrt(static_cast<double>(widths.size())));
  return {{std::log(params.door_width_m / usual), 1, sigma}};
}

std::vector<Hump> bar_says(double division_px) {
  std::vector<Hump> humps;
  for (const double metres : kDivisionsM) humps.push_back({std::log(metres / division_px), 1, kBarSigma});
  return humps;
}

std::vector<Hump> sheet_says(double sheet_px) {
  std::vector<Hump> humps;
  for (const auto& [side_m, share] : kPapersM)
    for (const double ratio : kRatios) humps.push_back({std::log(ratio * side_m / sheet_px), share, kSheetSigma});
  return humps;
}

}  // namespace

std::optional<LayoutScale> guess_scale(const ScaleEvidence& evidence, const LayoutParams& params) {
  std::vector<double> doors;
  for (const double width : evidence.door_widths_px)
    if (width > 0 && std::isfinite(width)) doors.push_back(width);
  std::vector<std::pair<std::vector<Hump>, double>> hints;
  if (const auto usual = usual_door_width(doors)) hints.emplace_back(doors_say(doors, *usual, params), 0.02);
  if (evidence.bar_division_px && *evidence.bar_division_px > 0)
    hints.emplace_back(bar_says(*evidence.bar_division_px), kBarWrong);
  if (evidence.sheet_px && *evidence.sheet_px > 0) hints.emplace_back(sheet_says(*evidence.sheet_px), kSheetOther);
  if (hints.empty()) return std::nullopt;

  std::vector<double> places, density;
  double sum = 0, best = -1, mode = 0;
  for (double at = std::log(kLowestM); at < std::log(kHighestM); at += kGridStep) {
    double value = 1;
    for (const auto& [humps, floor] : hints) value *= likelihood(humps, floor, at);
    places.push_back(at), density.push_back(value);
    sum += value;
    if (value > best) best = value, mode = at;
  }
  double square = 0;
  for (std::size_t i = 0; i < places.size(); ++i) square += density[i] / sum * (places[i] - mode) * (places[i] - mode);
  const double sigma = std::max(0.01, std::sqrt(square));
  if (sigma > kWorthSaying) return std::nullopt;
  return LayoutScale{std::exp(mode), sigma, false};
}

std::optional<double> a_series_side(cv::Size picture) {
  const double large = std::max(picture.width, picture.height), small = std::min(picture.width, picture.height);
  if (small < 1 || std::abs(large / small / std::sqrt(2.0) - 1) > 0.015) return std::nullopt;
  return large;
}

}  // namespace smokemap
