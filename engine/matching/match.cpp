// Matching in three steps. Coarse: every sensible turn, scale and shift of map a over map b, compared as depth images
// (how far inside or outside free space). Fine: the best few are bent until walls meet, which shows how well each
// explains the other map. Regions: under each bent map, regions are assigned to regions by place, size and neighbours.
// The best hypothesis is the answer, the next different one the runner-up, and what separates the two is what to ask a
// person.
#include "matching/match.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/check.hpp"
#include "matching/confidence.hpp"
#include "matching/hypotheses.hpp"
#include "matching/next_tap.hpp"
#include "matching/published.hpp"
#include "matching/region_pairs.hpp"
#include "matching/same_building.hpp"

namespace smokemap {
namespace {

constexpr double kPinReach_px = 10;
constexpr double kClearMargin = 0.25;  ///< from here on the runner-up does not matter
constexpr double kDoubtfulMargin = 0.08;
constexpr double kDoubtfulConfidence = 0.5;
constexpr double kUnknownFit = 0.5;     ///< the published methods do not ask
constexpr double kMostInDoubt = 0.75;   ///< nothing is shown as sure while the whole is doubtful
constexpr double kSureBuilding = 0.93;  ///< or below this: one map of another building in a hundred gets this far
constexpr double kLeastSaid = 0.1;      ///< what is wrong nine times in ten is no pair
constexpr double kLeastJoined = 0.5;    ///< a region that only joins a pair is said if it is likelier right than wrong
constexpr double kPinned = 0.97;        ///< a tap may miss the room that was meant

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

/// The region whose tap is worth most, and none that a person has already bound.
std::optional<int> most_telling_label(const Segmentation& a, const Matching& matching, const PairRules& rules,
                                      const std::vector<WeighedAnswer>& answers) {
  Eigen::VectorXd importance(a.regions.size()), confidence = Eigen::VectorXd::Zero(importance.size());
  std::vector<bool> bound(a.regions.size());
  for (Eigen::Index i = 0; i < importance.size(); ++i) {
    importance(i) = std::sqrt(a.regions[static_cast<size_t>(i)].area_px);
    bound[static_cast<size_t>(i)] = rules.forced.row(i).any();
  }
  importance /= importance.sum();
  for (const RegionPair& pair : matching.pairs)
    confidence(pair.label_a - 1) = std::max(confidence(pair.label_a - 1), pair.confidence);
  const std::optional<int> region = next_tap(answers, importance, confidence, bound);
  return region ? std::optional<int>(*region + 1) : std::nullopt;
}

std::vector<RegionPair> pairs_of(const Hypothesis& hypothesis, const PairRules& rules) {
  return joined_pairs(hypothesis.structure.partner, hypothesis.scores, rules.forbidden);
}

void keep_verdicts(const std::vector<RegionPair>& verdicts, Matching& matching) {
  for (const RegionPair& verdict : verdicts) {
    if (verdict.verdict == Verdict::kRejected)
      matching.pairs.push_back({verdict.label_a, verdict.label_b, 0, Verdict::kRejected});
    for (RegionPair& pair : matching.pairs)
      if (verdict.verdict == Verdict::kConfirmed && pair.label_a == verdict.label_a && pair.label_b == verdict.label_b)
        pair.confidence = 1, pair.verdict = Verdict::kConfirmed;
  }
  std::stable_sort(matching.pairs.begin(), matching.pairs.end(),
                   [](const RegionPair& one, const RegionPair& two) { return one.confidence < two.confidence; });
}

/// Mean confidence, every region of a by the root of its area; regions without partner count as doubt.
double overall_confidence(const Segmentation& a, const std::vector<RegionPair>& pairs) {
  double sum = 0, total = 0;
  for (const Region& region : a.regions) {
    double best = 0;
    for (const RegionPair& pair : pairs)
      if (pair.label_a == region.label) best = std::max(best, pair.confidence);
    sum += best * std::sqrt(region.area_px), total += std::sqrt(region.area_px);
  }
  return sum / total;
}

/// Right taps make an answer poorer in the terms it is weighed by (it would have chosen otherwise), so that the answer
/// without them still counts, unless somebody said that some of it is wrong.
double chance_of_one_building(const HypothesisFinder& finder, const std::vector<Hypothesis>& all,
                              const PairRules& rules) {
  const auto taps = static_cast<int>((rules.forced.rowwise().maxCoeff().array() > 0).count());
  const double chance = same_building(finder.weigh_fit(all), taps);
  if (taps == 0 || !rules.forbidden.isZero()) return chance;
  return std::max(chance, same_building(finder.weigh_fit(finder.untapped()), 0));
}

void finish(const Segmentation& a, const PairRules& rules, const std::vector<RegionPair>& verdicts,
            const std::vector<Hypothesis>& all, Matching& matching) {
  const std::vector<int>& partner = all.front().structure.partner;
  matching.pairs = pairs_of(all.front(), rules);
  matching.turn_b_a = all.front().turn_b_a;
  matching.margin = 1;
  for (size_t i = 1; i < all.size(); ++i)
    if (std::vector<RegionPair> other = pairs_of(all[i], rules); disagreement(matching.pairs, other) > 0.3) {
      matching.runner_up = std::move(other);
      matching.margin = std::clamp((all.front().score - all[i].score) / kClearMargin, 0.0, 1.0);
      break;
    }
  const auto is_bound = [&](const RegionPair& pair) { return rules.forced(pair.label_a - 1, pair.label_b - 1) != 0; };
  for (RegionPair& pair : matching.pairs)
    pair.confidence = is_bound(pair) ? kPinned : confidence_of(weigh_pair(pair, all));
  std::erase_if(matching.pairs, [&](const RegionPair& pair) {
    const bool joins = partner[static_cast<size_t>(pair.label_a - 1)] != pair.label_b - 1;
    return pair.confidence < (joins ? kLeastJoined : kLeastSaid);
  });
  for (RegionPair& pair : matching.runner_up)
    pair.confidence = (1 - matching.margin) * 0.5;  // it is right at most when the best is wrong
  matching.doubtful = matching.margin < kDoubtfulMargin / kClearMargin ||
                      overall_confidence(a, matching.pairs) < kDoubtfulConfidence || matching.same_building < kFitsFrom;
  for (std::vector<RegionPair>* pairs : {&matching.pairs, &matching.runner_up})
    for (RegionPair& pair : *pairs) {
      if (is_bound(pair)) continue;
      pair.confidence *= matching.same_building;
      if (matching.doubtful || matching.same_building < kSureBuilding)
        pair.confidence = std::min(pair.confidence, kMostInDoubt);
    }
  keep_verdicts(verdicts, matching);
  std::vector<WeighedAnswer> answers;
  for (const Hypothesis& hypothesis : all)
    answers.push_back({hypothesis.structure.partner, weight_beside(hypothesis, all.front())});
  matching.next_pin_label_a = most_telling_label(a, matching, rules, answers);
}

/// Turn (no mirror image) that best lays the middles of partners over each other.
Eigen::Matrix2d turn_of_pairs(const Segmentation& a, const Segmentation& b, const std::vector<RegionPair>& pairs) {
  Point2 mean_a = Point2::Zero(), mean_b = Point2::Zero();
  const auto middles = [&](const RegionPair& pair) {
    return std::pair(a.regions[static_cast<size_t>(pair.label_a - 1)].centroid_px,
                     b.regions[static_cast<size_t>(pair.label_b - 1)].centroid_px);
  };
  for (const RegionPair& pair : pairs) mean_a += middles(pair).first, mean_b += middles(pair).second;
  const double count = static_cast<double>(std::max<size_t>(1, pairs.size()));
  double along = 0, across = 0;
  for (const RegionPair& pair : pairs) {
    const Point2 from = middles(pair).first - mean_a / count, to = middles(pair).second - mean_b / count;
    along += from.dot(to), across += from.x() * to.y() - from.y() * to.x();
  }
  return Eigen::Rotation2Dd(std::atan2(across, along)).toRotationMatrix();
}

/// A published method; what people bound is put over what it says.
Matching match_published(const Segmentation& a, const Segmentation& b, const PairRules& rules,
                         const std::vector<RegionPair>& verdicts, MatchMethod method) {
  Matching matching;
  for (const RegionPair& pair : method == MatchMethod::kUrsim ? match_ursim(a, b) : match_voronoi(a, b)) {
    const int i = pair.label_a - 1, j = pair.label_b - 1;
    const bool is_spoken_for = rules.forced.row(i).any() || rules.forced.col(j).any() || rules.forbidden(i, j);
    if (!is_spoken_for) matching.pairs.push_back(pair);
  }
  for (int i = 0; i < rules.forced.rows(); ++i)
    for (int j = 0; j < rules.forced.cols(); ++j)
      if (rules.forced(i, j)) matching.pairs.push_back({i + 1, j + 1, kPinned, Verdict::kProposed});
  matching.doubtful = true;
  matching.same_building = kUnknownFit;
  matching.turn_b_a = turn_of_pairs(a, b, matching.pairs);
  keep_verdicts(verdicts, matching);
  WeighedAnswer only{std::vector<int>(a.regions.size(), -1), 1};
  for (const RegionPair& pair : matching.pairs)
    if (pair.verdict != Verdict::kRejected) only.partner[static_cast<size_t>(pair.label_a - 1)] = pair.label_b - 1;
  matching.next_pin_label_a = most_telling_label(a, matching, rules, {only});
  return matching;
}

}  // namespace

Result<Ok> MatchParams::validate() const {
  return ParamCheck("MatchParams").in_range("candidates", candidates, 1, 100).result();
}

struct Matcher::Maps {
  Segmentation a, b;
  MatchParams params;
  std::optional<HypothesisFinder> finder;  ///< of our own method only
};

Matcher::Matcher(std::shared_ptr<const Maps> maps) : maps_(std::move(maps)) {}

Result<Matcher> Matcher::create(const Segmentation& a, const Segmentation& b, const MatchParams& params) {
  if (const Result<Ok> valid = params.validate(); !valid) return valid.error();
  if (a.regions.empty() || b.regions.empty())
    return fail(Errc::kDegenerate,
                a.regions.empty() ? "the first map has no region to match" : "the second map has no region to match");
  auto maps = std::make_shared<Maps>(Maps{a, b, params, std::nullopt});
  if (params.method == MatchMethod::kStructure) maps->finder.emplace(a, b, params);
  return Matcher(std::move(maps));
}

Result<Matching> Matcher::solve(const std::vector<Pin>& pins, const std::vector<RegionPair>& verdicts) const {
  const Segmentation &a = maps_->a, &b = maps_->b;
  const Result<PairRules> rules = make_rules(a, b, pins, verdicts);
  if (!rules) return rules.error();
  if (!maps_->finder) return match_published(a, b, *rules, verdicts, maps_->params.method);
  Matching matching;
  const std::vector<Hypothesis> all = maps_->finder->find(pins_and_confirmed(a, b, pins, verdicts), *rules);
  matching.same_building = chance_of_one_building(*maps_->finder, all, *rules);
  finish(a, *rules, verdicts, all, matching);
  return matching;
}

Result<Matching> match(const Segmentation& a, const Segmentation& b, const std::vector<Pin>& pins,
                       const std::vector<RegionPair>& verdicts, const MatchParams& params) {
  const Result<Matcher> matcher = Matcher::create(a, b, params);
  if (!matcher) return matcher.error();
  return matcher->solve(pins, verdicts);
}

}  // namespace smokemap
