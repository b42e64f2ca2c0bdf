#include "matching/confidence.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kScoreSpread = 0.12;  ///< hypotheses worse by this count a third
constexpr double kMostSure = 0.97, kLeastSure = 0.02;

}  // namespace

double weight_beside(const Hypothesis& hypothesis, const Hypothesis& best) {
  return std::exp((hypothesis.score - best.score) / kScoreSpread);
}

PairEvidence weigh_pair(const RegionPair& pair, const std::vector<Hypothesis>& all) {
  const int i = pair.label_a - 1, j = pair.label_b - 1;
  const Hypothesis& best = all.front();
  PairEvidence evidence;
  evidence.certainty = best.structure.certainty(i, j);
  evidence.likeness = best.scores.likeness(i, j);
  const bool is_partner = best.structure.partner[static_cast<size_t>(i)] == j;
  double agreeing = 0, total = 0;
  for (const Hypothesis& hypothesis : all) {
    const double weight = weight_beside(hypothesis, best);
    total += weight;
    const bool agrees = hypothesis.structure.partner[static_cast<size_t>(i)] == j ||
                        (!is_partner && hypothesis.scores.share_of_b(i, j) > 0.5);
    agreeing += agrees ? weight : 0;
  }
  evidence.agreement = agreeing / total;
  return evidence;
}

double confidence_of(const PairEvidence& e) {
  const double logit = -4.6 + 0.9 * e.certainty + 2.3 * e.likeness + 5.3 * e.agreement;
  return std::clamp(1 / (1 + std::exp(-logit)), kLeastSure, kMostSure);
}

}  // namespace smokemap
