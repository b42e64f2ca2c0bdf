#include "acg/line_chain.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace smokemap {
namespace {

constexpr int kStretches = 17;
constexpr double kLeastStretch =
    -0.30;  ///< a strip is at least this much shorter than drawn; at most half as long again
constexpr double kStretchStep = 0.05;
constexpr double kSigmaDraw_m = 0.025;  ///< a line may be drawn this far off, against the one before
constexpr std::size_t kStates = static_cast<std::size_t>(LineChain::kPlaces) * kStretches;
constexpr float kNever = -1e9F;
constexpr std::size_t kAround = 3;  ///< places on both sides that count as the same

double stretch_at(int level) { return kLeastStretch + level * kStretchStep; }
double offset_m(int place) { return (place - LineChain::kReach_cells) * LineChain::kCell_m; }
std::size_t index(int place, int level) {
  return static_cast<std::size_t>(place) * kStretches + static_cast<std::size_t>(level);
}

/// How the state of one line goes over into that of the next. Where a strip ends does not depend on where it begins.
struct Step {
  struct Landing {
    int shift = 0;                          ///< in places, against the line before
    std::array<float, kStretches> log{};    ///< per level of the strip before
    std::array<float, kStretches> share{};  ///< exp(log)
  };
  std::array<std::array<Landing, 2>, kStretches> landings;  ///< per level of the strip

  /// @param visit  (state before, state, logarithm or share)
  template <typename Visit>
  void each(std::array<float, kStretches> Landing::*weight, const Visit& visit) const {
    for (int level = 0; level < kStretches; ++level)
      for (const Landing& landing : landings[static_cast<std::size_t>(level)])
        for (int place = std::max(0, -landing.shift);
             place < std::min(LineChain::kPlaces, LineChain::kPlaces - landing.shift); ++place)
          for (int before = 0; before < kStretches; ++before)
            visit(index(place, before), index(place + landing.shift, level),
                  (landing.*weight)[static_cast<std::size_t>(before)]);
  }
};

Step make_step(const LineChain& chain, std::size_t k) {
  Step step;
  const double width = chain.drawn_m[k + 1] - chain.drawn_m[k], now = chain.now_m[k + 1] - chain.now_m[k];
  const double before = k == 0 ? width : chain.drawn_m[k] - chain.drawn_m[k - 1];
  const double rho = k == 0 ? 0 : std::exp(-0.5 * (width + before) / chain.correlation_m);
  const double sigma = std::max(0.5 * kStretchStep, chain.sigma_stretch * std::sqrt(1 - rho * rho));
  std::array<std::array<double, kStretches>, kStretches> change{};
  for (std::size_t from = 0; from < kStretches; ++from) {
    double sum = 0;
    for (std::size_t to = 0; to < kStretches; ++to) {
      const double z =
          (std::log1p(stretch_at(static_cast<int>(to))) - rho * std::log1p(stretch_at(static_cast<int>(from)))) / sigma;
      change[from][to] = -0.5 * z * z;
      sum += std::exp(-0.5 * z * z);
    }
    for (double& value : change[from]) value -= std::log(sum);
  }
  for (std::size_t level = 0; level < kStretches; ++level) {
    const double moved = (width * (1 + stretch_at(static_cast<int>(level))) - now) / LineChain::kCell_m;
    for (const std::size_t up : {0u, 1u}) {
      const double cells = std::clamp(std::floor(moved) + static_cast<double>(up), -1e6, 1e6);
      const double error = (cells - moved) * LineChain::kCell_m / kSigmaDraw_m;
      Step::Landing& landing = step.landings[level][up];
      landing.shift = static_cast<int>(cells);
      for (std::size_t from = 0; from < kStretches; ++from) {
        landing.log[from] = static_cast<float>(change[from][level] - 0.5 * error * error);
        landing.share[from] = std::exp(landing.log[from]);
      }
    }
  }
  return step;
}

using Values = std::vector<float>;

/// The best arrangement, from the last line back to the first.
std::vector<int> best_places(const LineChain& chain, const std::vector<Step>& steps) {
  const std::size_t lines = chain.now_m.size();
  std::vector<std::vector<std::uint16_t>> came_from(lines);
  Values score(kStates);
  for (int place = 0; place < LineChain::kPlaces; ++place)
    for (int level = 0; level < kStretches; ++level)
      score[index(place, level)] = chain.support[0][static_cast<std::size_t>(place)];
  for (std::size_t k = 0; k + 1 < lines; ++k) {
    Values next(kStates, kNever);
    came_from[k + 1].assign(kStates, 0);
    steps[k].each(&Step::Landing::log, [&](std::size_t from, std::size_t to, float log) {
      if (score[from] + log > next[to]) {
        next[to] = score[from] + log;
        came_from[k + 1][to] = static_cast<std::uint16_t>(from);
      }
    });
    for (int place = 0; place < LineChain::kPlaces; ++place)
      for (int level = 0; level < kStretches; ++level)
        next[index(place, level)] += chain.support[k + 1][static_cast<std::size_t>(place)];
    score = std::move(next);
  }
  std::vector<int> places(lines);
  auto state = static_cast<std::size_t>(std::max_element(score.begin(), score.end()) - score.begin());
  for (std::size_t k = lines; k-- > 0;) {
    places[k] = static_cast<int>(state / kStretches);
    if (k > 0) state = came_from[k][state];
  }
  return places;
}

void multiply_support(const LineChain& chain, std::size_t k, Values& values) {
  const auto& support = chain.support[k];
  const float largest = *std::max_element(support.begin(), support.end());
  float sum = 0;
  for (int place = 0; place < LineChain::kPlaces; ++place) {
    const float factor = std::exp(support[static_cast<std::size_t>(place)] - largest);
    for (int level = 0; level < kStretches; ++level) sum += values[index(place, level)] *= factor;
  }
  for (float& v : values) v /= std::max(sum, 1e-30F);
}

/// Per line, the weight of every state with what speaks on its left (forward) and on its right (backward).
std::vector<Values> marginals(const LineChain& chain, const std::vector<Step>& steps) {
  const std::size_t lines = chain.now_m.size();
  std::vector<Values> out(lines, Values(kStates, 1.0F));
  multiply_support(chain, 0, out[0]);
  for (std::size_t k = 0; k + 1 < lines; ++k) {
    std::fill(out[k + 1].begin(), out[k + 1].end(), 0.0F);
    steps[k].each(&Step::Landing::share,
                  [&](std::size_t from, std::size_t to, float share) { out[k + 1][to] += out[k][from] * share; });
    multiply_support(chain, k + 1, out[k + 1]);
  }
  Values backward(kStates, 1.0F);
  for (std::size_t k = lines - 1; k-- > 0;) {
    multiply_support(chain, k + 1, backward);
    Values before(kStates, 0.0F);
    steps[k].each(&Step::Landing::share,
                  [&](std::size_t from, std::size_t to, float share) { before[from] += backward[to] * share; });
    for (std::size_t i = 0; i < kStates; ++i) out[k][i] *= before[i];
    backward = std::move(before);
  }
  return out;
}

}  // namespace

std::vector<LineBelief> arrange_lines(const LineChain& chain) {
  const std::size_t lines = chain.now_m.size();
  if (lines == 0) return {};
  std::vector<Step> steps;
  for (std::size_t k = 0; k + 1 < lines; ++k) steps.push_back(make_step(chain, k));
  const std::vector<int> places = best_places(chain, steps);
  const std::vector<Values> weights = marginals(chain, steps);
  std::vector<LineBelief> out(lines);
  for (std::size_t k = 0; k < lines; ++k) {
    out[k].together.move_m = offset_m(places[k]);
    std::array<double, LineChain::kPlaces> here{};
    double all = 0, elsewhere = 0, square = 0, most = 0;
    for (int place = 0; place < LineChain::kPlaces; ++place) {
      double& value = here[static_cast<std::size_t>(place)];
      for (int level = 0; level < kStretches; ++level) value += static_cast<double>(weights[k][index(place, level)]);
      const double apart = offset_m(place);
      all += value;
      if (std::abs(apart) > LineBelief::kNear_m) elsewhere += value, square += value * apart * apart;
    }
    for (std::size_t place = kAround; place + kAround < here.size(); ++place) {
      double around = 0;
      for (std::size_t i = place - kAround; i <= place + kAround; ++i) around += here[i];
      if (around > most) most = around, out[k].alone.move_m = offset_m(static_cast<int>(place));
    }
    const auto gain = [&](double move_m) {
      const auto place = static_cast<std::size_t>(std::lround(move_m / LineChain::kCell_m) + LineChain::kReach_cells);
      return static_cast<double>(chain.support[k][place] - chain.support[k][LineChain::kReach_cells]);
    };
    out[k].together.gain = gain(out[k].together.move_m);
    out[k].alone.gain = gain(out[k].alone.move_m);
    out[k].elsewhere = all > 0 ? elsewhere / all : 1;
    out[k].apart_m = elsewhere > 0 ? std::sqrt(square / elsewhere) : 0;
  }
  return out;
}

}  // namespace smokemap
