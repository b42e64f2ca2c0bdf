// Matching in three steps. Coarse: every sensible turn, scale and shift of map a over map b, compared as depth images
// (how far inside or outside free space). Fine: the best few are bent until walls meet, which shows how well each
// explains the other map. Regions: under each bent map, regions are assigned to regions by place, size and neighbours.
// The best hypothesis is the answer, the next different one the runner-up, and what separates the two is what to ask a
// person.
#include "matching/match.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/check.hpp"
#include "matching/hypotheses.hpp"
#include "matching/region_pairs.hpp"

namespace smokemap {
namespace {

constexpr double kPinReach_px = 10;
constexpr double kClearMargin = 0.25;  ///< from here on the runner-up does not matter
constexpr double kDoubtfulMargin = 0.08;
constexpr double kDoubtfulLikeness = 0.55;

std::optional<int> region_near(const Segmentation& map, const Point2& p_px) {
  const int reach = static_cast<int>(kPinReach_px);
  const int cx = static_cast<int>(std::lround(p_px.x())), cy = static_cast<int>(std::lround(p_px.y()));
  std::optional<int> found;
  int best = reach * reach + 1;
  for (int y = std::max(0, cy - reach); y <= std::min(map.labels.rows - 1, cy + reach); ++y)
    for (int x = std::max(0, cx - reach); x <= std::min(map.labels.cols - 1, cx + reach); ++x) {
      const int squared = (x - cx) * (x - cx) + (y - cy) * (y - cy);
      if (map.labels.at<unsigned short>(y, x) == 0 || squared >= best) continue;
      best = squared;
      found = map.labels.at<unsigned short>(y, x);
    }
  return found;
}

Result<PairRules> make_rules(const Segmentation& a, const Segmentation& b, const std::vector<Pin>& pins,
                             const std::vector<RegionPair>& verdicts) {
  const auto rows = static_cast<Eigen::Index>(a.regions.size()), cols = static_cast<Eigen::Index>(b.regions.size());
  PairRules rules{Eigen::MatrixXi::Zero(rows, cols), Eigen::MatrixXi::Zero(rows, cols)};
  for (const RegionPair& verdict : verdicts) {
    if (verdict.verdict == Verdict::kProposed) continue;
    if (verdict.label_a < 1 || verdict.label_a > rows || verdict.label_b < 1 || verdict.label_b > cols)
      return fail(Errc::kConflict, "a verdict speaks of regions " + std::to_string(verdict.label_a) + " and " +
                                       std::to_string(verdict.label_b) + ", which are not both there");
    Eigen::MatrixXi& which = verdict.verdict == Verdict::kConfirmed ? rules.forced : rules.forbidden;
    which(verdict.label_a - 1, verdict.label_b - 1) = 1;
  }
  for (const Pin& pin : pins) {
    const std::optional<int> at_a = region_near(a, pin.p_a_px), at_b = region_near(b, pin.p_b_px);
    if (at_a && at_b && !rules.forbidden(*at_a - 1, *at_b - 1)) rules.forced(*at_a - 1, *at_b - 1) = 1;
  }
  return rules;
}

/// Confirmed regions pull like pins, from anchor to anchor.
std::vector<Pin> pins_and_confirmed(const Segmentation& a, const Segmentation& b, std::vector<Pin> pins,
                                    const std::vector<RegionPair>& verdicts) {
  for (const RegionPair& verdict : verdicts)
    if (verdict.verdict == Verdict::kConfirmed)
      pins.push_back({a.regions[static_cast<size_t>(verdict.label_a - 1)].anchor_px,
                      b.regions[static_cast<size_t>(verdict.label_b - 1)].anchor_px});
  return pins;
}

std::set<std::pair<int, int>> keys(const std::vector<RegionPair>& pairs) {
  std::set<std::pair<int, int>> result;
  for (const RegionPair& pair : pairs) result.emplace(pair.label_a, pair.label_b);
  return result;
}

/// Share of pairs that only one of the two has.
double disagreement(const std::vector<RegionPair>& one, const std::vector<RegionPair>& two) {
  const auto keys_one = keys(one), keys_two = keys(two);
  size_t common = 0;
  for (const auto& key : keys_one) common += keys_two.count(key);
  const size_t all = keys_one.size() + keys_two.size() - common;
  return all == 0 ? 0 : 1 - static_cast<double>(common) / static_cast<double>(all);
}

/// The largest region on which best and runner-up differ; without a runner-up, the one least sure for its size.
std::optional<int> most_telling_region(const Segmentation& a, const Matching& matching) {
  const auto best = keys(matching.pairs), other = keys(matching.runner_up);
  std::optional<int> found;
  double most = 0;
  for (const Region& region : a.regions) {
    double confidence = 0;
    bool differs = false;
    for (const RegionPair& pair : matching.pairs) {
      if (pair.label_a != region.label) continue;
      confidence = std::max(confidence, pair.confidence);
      differs |= !other.contains({pair.label_a, pair.label_b});
    }
    const double worth = std::sqrt(region.area_px) * (1 - confidence) * (differs && !other.empty() ? 2 : 1);
    if (worth > most) most = worth, found = region.label;
  }
  return most > 0 ? found : std::nullopt;
}

std::vector<RegionPair> pairs_of(const Hypothesis& hypothesis, const PairRules& rules) {
  const StructureMatch& structure = hypothesis.structure;
  std::vector<RegionPair> pairs = joined_pairs(structure.partner, hypothesis.scores, rules.forbidden);
  for (RegionPair& pair : pairs) {
    const int i = pair.label_a - 1, j = pair.label_b - 1;
    pair.confidence *= std::clamp(0.5 * structure.certainty(i, j) + 0.25 * (1 + structure.support(i)), 0.0, 1.0);
  }
  return pairs;
}

void finish(const Segmentation& a, const PairRules& rules, const std::vector<RegionPair>& verdicts,
            const std::vector<Hypothesis>& all, Matching& matching) {
  matching.pairs = pairs_of(all.front(), rules);
  matching.turn_b_a = all.front().turn_b_a;
  matching.margin = 1;
  for (size_t i = 1; i < all.size(); ++i)
    if (std::vector<RegionPair> other = pairs_of(all[i], rules); disagreement(matching.pairs, other) > 0.3) {
      matching.runner_up = std::move(other);
      matching.margin = std::clamp((all.front().score - all[i].score) / kClearMargin, 0.0, 1.0);
      break;
    }
  const double trust = 0.6 + 0.4 * matching.margin;
  for (RegionPair& pair : matching.pairs) {
    const int i = pair.label_a - 1, j = pair.label_b - 1;
    pair.confidence = rules.forced(i, j) ? 0.97 : std::clamp(trust * pair.confidence, 0.02, 0.95);
  }
  for (const RegionPair& verdict : verdicts) {
    if (verdict.verdict == Verdict::kRejected)
      matching.pairs.push_back({verdict.label_a, verdict.label_b, 0, Verdict::kRejected});
    for (RegionPair& pair : matching.pairs)
      if (verdict.verdict == Verdict::kConfirmed && pair.label_a == verdict.label_a && pair.label_b == verdict.label_b)
        pair.confidence = 1, pair.verdict = Verdict::kConfirmed;
  }
  std::stable_sort(matching.pairs.begin(), matching.pairs.end(),
                   [](const RegionPair& one, const RegionPair& two) { return one.confidence < two.confidence; });
  matching.doubtful = matching.margin < kDoubtfulMargin / kClearMargin || all.front().warp.likeness < kDoubtfulLikeness;
  matching.next_pin_label_a = most_telling_region(a, matching);
}

}  // namespace

Result<Ok> MatchParams::validate() const {
  return ParamCheck("MatchParams").in_range("candidates", candidates, 1, 100).result();
}

Result<Matching> match(const Segmentation& a, const Segmentation& b, const std::vector<Pin>& pins,
                       const std::vector<RegionPair>& verdicts, const MatchParams& params) {
  if (const Result<Ok> valid = params.validate(); !valid) return valid.error();
  if (a.regions.empty() || b.regions.empty())
    return fail(Errc::kDegenerate,
                std::string("the ") + (a.regions.empty() ? "first" : "second") + " map has no region to match");
  const Result<PairRules> rules = make_rules(a, b, pins, verdicts);
  if (!rules) return rules.error();
  const std::vector<Hypothesis> all = find_hypotheses(a, b, pins_and_confirmed(a, b, pins, verdicts), *rules, params);
  Matching matching;
  finish(a, *rules, verdicts, all, matching);
  return matching;
}

}  // namespace smokemap
