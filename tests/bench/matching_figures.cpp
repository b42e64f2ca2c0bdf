#include "tests/bench/matching_figures.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <numeric>
#include <optional>
#include <set>

#include "core/random.hpp"
#include "matching/transfer.hpp"

namespace smokemap::bench {
namespace {

constexpr int kPointsPerPair = 400;
constexpr int kClickReach_px = 10;

int label_near(const cv::Mat& labels, const Point2& p) {
  const int cx = static_cast<int>(std::lround(p.x())), cy = static_cast<int>(std::lround(p.y()));
  int found = 0, best = kClickReach_px * kClickReach_px + 1;
  for (int y = std::max(0, cy - kClickReach_px); y <= std::min(labels.rows - 1, cy + kClickReach_px); ++y)
    for (int x = std::max(0, cx - kClickReach_px); x <= std::min(labels.cols - 1, cx + kClickReach_px); ++x) {
      const int squared = (x - cx) * (x - cx) + (y - cy) * (y - cy);
      if (labels.at<unsigned short>(y, x) != 0 && squared < best)
        best = squared, found = labels.at<unsigned short>(y, x);
    }
  return found;
}

int label_at(const cv::Mat& labels, const Point2& p) {
  const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
  return x >= 0 && y >= 0 && x < labels.cols && y < labels.rows ? labels.at<unsigned short>(y, x) : 0;
}

bool holds(const std::vector<int>& labels, int label) {
  return std::find(labels.begin(), labels.end(), label) != labels.end();
}

Point2 mean_of(const std::vector<Point2>& points) {
  Point2 sum = Point2::Zero();
  for (const Point2& p : points) sum += p;
  return sum / static_cast<double>(std::max<size_t>(1, points.size()));
}

double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double share_below(const std::vector<double>& values, double limit) {
  const auto below = std::count_if(values.begin(), values.end(), [&](double value) { return value < limit; });
  return values.empty() ? 0 : static_cast<double>(below) / static_cast<double>(values.size());
}

struct Box {
  Point2 low, high;
  Box(const std::vector<Point2>& points, const Eigen::Matrix2d& turn) {
    low = high = turn * points.front();
    for (const Point2& p : points) low = low.cwiseMin(turn * p), high = high.cwiseMax(turn * p);
  }
};

/// Where a point would be if rooms were boxes: what the position error is measured from.
Point2 relative_place(const Point2& p, const Box& from, const Box& to, const Eigen::Matrix2d& turn,
                      const std::vector<Point2>& pixels_to) {
  const Point2 share = (turn * p - from.low).cwiseQuotient((from.high - from.low).cwiseMax(1.0));
  const Point2 wanted = to.low + share.cwiseMax(0.0).cwiseMin(1.0).cwiseProduct(to.high - to.low);
  return *std::min_element(pixels_to.begin(), pixels_to.end(), [&](const Point2& one, const Point2& two) {
    return (one - wanted).squaredNorm() < (two - wanted).squaredNorm();
  });
}

std::vector<size_t> farthest_groups(const std::vector<JudgedGroup>& groups, int count) {
  std::vector<size_t> usable, chosen;
  std::vector<Point2> firsts;
  for (size_t i = 0; i < groups.size(); ++i)
    if (!groups[i].clicks_a.empty() && !groups[i].clicks_b.empty())
      usable.push_back(i), firsts.push_back(groups[i].clicks_a.front());
  const Point2 middle = mean_of(firsts);
  while (!usable.empty() && static_cast<int>(chosen.size()) < count) {
    const auto room = [&](size_t i) {
      const Point2 p = groups[i].clicks_a.front();
      if (chosen.empty()) return (p - middle).squaredNorm();
      double nearest = 1e18;
      for (const size_t other : chosen) nearest = std::min(nearest, (p - groups[other].clicks_a.front()).squaredNorm());
      return nearest;
    };
    const auto best =
        std::max_element(usable.begin(), usable.end(), [&](size_t one, size_t two) { return room(one) < room(two); });
    chosen.push_back(*best);
    usable.erase(best);
  }
  return chosen;
}

/// The group that a person would tap when asked for a region: one with a click in it, else the nearest.
std::optional<size_t> asked_group(const JudgedPair& pair, int label, const std::vector<size_t>& tapped) {
  std::optional<size_t> nearest;
  double least = 1e18;
  for (size_t g = 0; g < pair.groups.size(); ++g) {
    const JudgedGroup& group = pair.groups[g];
    const bool is_tapped = std::find(tapped.begin(), tapped.end(), g) != tapped.end();
    if (is_tapped || group.clicks_a.empty() || group.clicks_b.empty()) continue;
    const Point2 p = group.clicks_a.front();
    const double distance = label_near(pair.a.labels, p) == label
                                ? 0
                                : (p - pair.a.regions[static_cast<size_t>(label - 1)].anchor_px).squaredNorm();
    if (distance < least) least = distance, nearest = g;
  }
  return nearest;
}

std::vector<size_t> choose_taps(const JudgedPair& pair, int taps, const Matcher& matcher, Taps choice) {
  if (choice == Taps::kFarApart) return farthest_groups(pair.groups, taps);
  std::vector<size_t> tapped;
  std::vector<Pin> pins;
  while (static_cast<int>(tapped.size()) < taps) {
    const auto matching = matcher.solve(pins, {});
    if (!matching || !matching->next_pin_label_a) break;
    const auto group = asked_group(pair, *matching->next_pin_label_a, tapped);
    if (!group) break;
    tapped.push_back(*group);
    pins.push_back({pair.groups[*group].clicks_a.front(), pair.groups[*group].clicks_b.front()});
  }
  return tapped;
}

/// The published rule: a pair is true if one group has a click in both of its regions.
void judge_pairs(const JudgedPair& truth, const Matching& matching, PairFigures& figures) {
  std::vector<std::pair<std::set<int>, std::set<int>>> groups;
  std::set<int> clicked;
  for (const JudgedGroup& group : truth.groups) {
    auto& [in_a, in_b] = groups.emplace_back();
    for (const Point2& p : group.clicks_a) in_a.insert(label_near(truth.a.labels, p));
    for (const Point2& p : group.clicks_b) in_b.insert(label_near(truth.b.labels, p));
    in_a.erase(0), in_b.erase(0);
    clicked.insert(in_a.begin(), in_a.end());
  }
  std::vector<bool> found(groups.size(), false);
  double right = 0;
  for (const RegionPair& pair : matching.pairs) {
    bool is_right = false;
    for (size_t g = 0; g < groups.size(); ++g)
      if (groups[g].first.contains(pair.label_a) && groups[g].second.contains(pair.label_b))
        is_right = true, found[g] = true;
    right += is_right;
    if (clicked.contains(pair.label_a)) figures.said.emplace_back(pair.confidence, is_right);
  }
  const double missed = static_cast<double>(std::count(found.begin(), found.end(), false));
  const double precision = matching.pairs.empty() ? 0 : right / static_cast<double>(matching.pairs.size());
  const double recall = right + missed > 0 ? right / (right + missed) : 0;
  figures.points_f1 = precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0;
}

/// Where a point of a room should go: exactly, where somebody knows; else to the same place in the box of its partner.
class TruePlace {
 public:
  TruePlace(const JudgedPair& truth, const std::vector<Point2>& pixels_a, const std::vector<Point2>& pixels_b,
            const Eigen::Matrix2d& turn)
      : truth_(truth),
        pixels_b_(pixels_b),
        turn_(turn),
        box_a_(pixels_a, turn),
        box_b_(pixels_b, Eigen::Matrix2d::Identity()) {}

  Point2 operator()(const Point2& p_a) const {
    if (truth_.truth_b_a.empty()) return relative_place(p_a, box_a_, box_b_, turn_, pixels_b_);
    const auto at = truth_.truth_b_a.at<cv::Vec2f>(static_cast<int>(p_a.y()), static_cast<int>(p_a.x()));
    return {at[0], at[1]};
  }
  double diagonal_a() const { return ((box_a_.high - box_a_.low).array() + 1).matrix().norm(); }
  double diagonal_b() const { return ((box_b_.high - box_b_.low).array() + 1).matrix().norm(); }

 private:
  const JudgedPair& truth_;
  const std::vector<Point2>& pixels_b_;
  Eigen::Matrix2d turn_;
  Box box_a_, box_b_;
};

struct Rooms {
  std::vector<std::vector<Point2>> a, b;  ///< pixels of each judged group
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
  int judged = 0;  ///< groups with pixels on both sides

  explicit Rooms(const JudgedPair& truth) {
    std::vector<Point2> middles_a, middles_b;
    for (const JudgedGroup& group : truth.groups) {
      a.push_back(pixels_of(truth.truth_a, group.labels_a)), b.push_back(pixels_of(truth.truth_b, group.labels_b));
      if (a.back().empty() || b.back().empty()) continue;
      middles_a.push_back(mean_of(a.back())), middles_b.push_back(mean_of(b.back()));
    }
    judged = static_cast<int>(middles_a.size());
    if (judged > 0) turn = best_rotation(middles_a, middles_b);
  }
};

struct RoomTally {
  double points = 0, hits = 0, answers = 0;
};

RoomTally judge_room(const JudgedPair& truth, const PointTransfer& transfer, const std::vector<Point2>& points,
                     const std::vector<int>& labels_b, const TruePlace& true_place, PairFigures& figures,
                     std::vector<double>& errors) {
  RoomTally tally;
  for (const Point2& p : points) {
    const Transferred place = transfer(p);
    tally.points += 1;
    if (!place.p) continue;
    tally.answers += 1;
    figures.in_walls += label_at(truth.b.labels, *place.p) == 0;
    if (const Transferred back = transfer.inverse(*place.p); back.p)
      figures.returns.push_back((*back.p - p).norm() / true_place.diagonal_a());
    if (!holds(labels_b, label_at(truth.truth_b, *place.p))) continue;
    tally.hits += 1;
    const double miss = (*place.p - true_place(p)).norm();
    errors.push_back(miss / true_place.diagonal_b());
    figures.misses.push_back(miss / place.sigma);
  }
  return tally;
}

void judge_transfer(const JudgedPair& truth, const PointTransfer& transfer, const std::vector<size_t>& tapped,
                    PairFigures& figures) {
  const Rooms rooms(truth);
  if (rooms.judged == 0) return;
  std::mt19937_64 random(1);
  std::vector<double> errors;
  double count = 0, untapped = 0, answers = 0;
  for (size_t g = 0; g < truth.groups.size(); ++g) {
    if (rooms.a[g].empty() || rooms.b[g].empty()) continue;
    std::vector<Point2> points;
    for (int k = 0; k < std::max(1, kPointsPerPair / rooms.judged); ++k)
      points.push_back(rooms.a[g][uniform_index(random, rooms.a[g].size())]);
    const RoomTally tally = judge_room(truth, transfer, points, truth.groups[g].labels_b,
                                       TruePlace(truth, rooms.a[g], rooms.b[g], rooms.turn), figures, errors);
    const double hit = tally.hits / tally.points;
    figures.room_hit += hit, figures.answered += tally.answers / tally.points, count += 1;
    answers += tally.answers;
    if (std::find(tapped.begin(), tapped.end(), g) == tapped.end()) figures.untapped_hit += hit, untapped += 1;
  }
  figures.room_hit /= count, figures.answered /= count;
  figures.in_walls /= std::max(1.0, answers);
  figures.untapped_hit = untapped > 0 ? figures.untapped_hit / untapped : figures.room_hit;
  figures.position_error = median_of(errors);
}

/// Sums over pairs of one set and annotator.
struct FigureSums {
  double count = 0, points_f1 = 0, room_hit = 0, untapped = 0, answered = 0, error = 0, ms = 0, slowest_ms = 0;
  double in_walls = 0;
  std::vector<double> misses, returns;

  void add(const PairFigures& one) {
    count += 1, points_f1 += one.points_f1, room_hit += one.room_hit, untapped += one.untapped_hit;
    answered += one.answered, error += one.position_error, ms += one.match_ms, in_walls += one.in_walls;
    slowest_ms = std::max(slowest_ms, one.match_ms);
    misses.insert(misses.end(), one.misses.begin(), one.misses.end());
    returns.insert(returns.end(), one.returns.begin(), one.returns.end());
  }
  void print(const std::string& set, const std::string& annotator, int taps) const {
    std::printf("%-9s %-9s %4d %4.0f %9.3f %8.3f %8.3f %8.3f %6.3f   %4.2f %4.2f %4.2f %8.3f %5.3f %5.0f %5.0f\n",
                set.c_str(), annotator.c_str(), taps, count, points_f1 / count, room_hit / count, untapped / count,
                answered / count, error / count, share_below(misses, 1), share_below(misses, 1.5),
                share_below(misses, 2), median_of(returns), in_walls / count, ms / count, slowest_ms);
  }
};

void print_whole_time(const std::vector<double>& ms) {
  const double sum = std::accumulate(ms.begin(), ms.end(), 0.0);
  std::printf("    a pair with the regions of both maps: %.0f ms (max %.0f)\n",
              sum / static_cast<double>(std::max<size_t>(1, ms.size())),
              ms.empty() ? 0 : *std::max_element(ms.begin(), ms.end()));
}

void print_pair(const JudgedPair& pair, const PairFigures& one) {
  std::printf("    %s/%s %s  F1 %.2f hit %.2f untapped %.2f error %.2f %4.0f ms %s\n", pair.set.c_str(),
              pair.name.c_str(), pair.annotator.c_str(), one.points_f1, one.room_hit, one.untapped_hit,
              one.position_error, one.match_ms, one.doubtful ? "doubtful" : "");
}

}  // namespace

PairFigures judge(const JudgedPair& pair, int taps, const MatchParams& params, Taps choice) {
  PairFigures figures;
  std::clock_t begin = std::clock();
  auto matcher = Matcher::create(pair.a, pair.b, params);
  if (!matcher) {
    figures.doubtful = true;
    return figures;
  }
  const std::vector<size_t> tapped = choose_taps(pair, taps, *matcher, choice);
  std::vector<Pin> pins;
  for (const size_t g : tapped) pins.push_back({pair.groups[g].clicks_a.front(), pair.groups[g].clicks_b.front()});
  if (!pins.empty()) {  // the answer before the last tap was there already
    (void)matcher->solve({pins.begin(), pins.end() - 1}, {});
    begin = std::clock();
  }
  const auto matching = matcher->solve(pins, {});
  const PointTransfer transfer(pair.a, pair.b, *matching, pins);
  figures.match_ms = 1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  figures.doubtful = matching->doubtful;
  judge_pairs(pair, *matching, figures);
  judge_transfer(pair, transfer, tapped, figures);
  return figures;
}

PairFigures judge_answer(const JudgedPair& pair, const Matching& matching, const std::vector<Pin>& pins) {
  PairFigures figures;
  const PointTransfer transfer(pair.a, pair.b, matching, pins);
  judge_pairs(pair, matching, figures);
  judge_transfer(pair, transfer, {}, figures);
  return figures;
}

void print_reliability(const std::vector<std::pair<double, bool>>& said) {
  std::printf("    reliability, by what was said (mean said: right of pairs, and one sigma of chance):\n     ");
  for (int decile = 0; decile < 10; ++decile) {
    double right = 0, all = 0, sum = 0;
    for (const auto& [confidence, is_right] : said)
      if (std::clamp(static_cast<int>(10 * confidence), 0, 9) == decile) all += 1, right += is_right, sum += confidence;
    if (all == 0) continue;
    const double mean = sum / all;
    std::printf("  %.2f: %.0f/%.0f=%.2f+-%.2f", mean, right, all, right / all, std::sqrt(mean * (1 - mean) / all));
  }
  double ordered = 0, compared = 0;  // of a right and a wrong pair, the right one is said to be surer
  for (const auto& [sure, is_right] : said)
    for (const auto& [other, other_right] : said)
      if (is_right && !other_right) compared += 1, ordered += sure > other ? 1 : sure == other ? 0.5 : 0;
  std::printf("; right ones surer than wrong ones %.2f\n", compared > 0 ? ordered / compared : 1.0);
}

Result<std::vector<JudgedPair>> read_judged_sets(const std::string& folder, const Segmenter& segmenter) {
  std::vector<JudgedPair> judged;
  for (const char* set : {"KTH", "E5_on_08", "E5_on_10"}) {
    if (!std::filesystem::is_directory(std::filesystem::path(folder) / set)) continue;
    auto pairs = read_judged_pairs(folder, set, segmenter);
    if (!pairs) return pairs.error();
    judged.insert(judged.end(), pairs->begin(), pairs->end());
  }
  return judged;
}

void print_matching_figures(const std::vector<JudgedPair>& pairs, const std::vector<int>& taps,
                            const MatchParams& params, bool every_pair, Taps choice) {
  std::set<std::pair<std::string, std::string>> rows;
  for (const JudgedPair& pair : pairs) rows.emplace(pair.set, pair.annotator);
  std::printf("%-9s %-9s %4s %4s %9s %8s %8s %8s %6s   %-14s %8s %5s %5s %5s\n", "set", "truth", "taps", "n",
              "points F1", "room_hit", "untapped", "answered", "error", "in 1/1.5/2 sd", "there&back", "walls", "ms",
              "max");
  for (const int count : taps) {
    std::vector<std::pair<double, bool>> said;
    std::vector<double> whole_ms;
    int low = 0, low_unflagged = 0, flagged = 0;
    for (const auto& [set, annotator] : rows) {
      FigureSums sums;
      for (const JudgedPair& pair : pairs) {
        if (pair.set != set || pair.annotator != annotator) continue;
        const PairFigures one = judge(pair, count, params, choice);
        sums.add(one);
        whole_ms.push_back(pair.segment_ms + one.match_ms);
        flagged += one.doubtful, low += one.room_hit < 0.2, low_unflagged += one.room_hit < 0.2 && !one.doubtful;
        said.insert(said.end(), one.said.begin(), one.said.end());
        if (every_pair) print_pair(pair, one);
      }
      sums.print(set, annotator, count);
    }
    if (count == 0) print_whole_time(whole_ms);
    std::printf("    room_hit < 0.2: %d of %zu, not flagged %d; flagged %d\n", low, pairs.size(), low_unflagged,
                flagged);
    print_reliability(said);
  }
  std::fflush(stdout);
}

}  // namespace smokemap::bench
