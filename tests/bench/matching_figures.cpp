#include "tests/bench/matching_figures.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "core/random.hpp"
#include "matching/transfer.hpp"
#include "segmentation/constriction.hpp"
#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"

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

bool holds(const std::vector<int>& labels, int label) {
  return std::find(labels.begin(), labels.end(), label) != labels.end();
}

std::vector<Point2> pixels_of(const cv::Mat& labels, const std::vector<int>& members) {
  std::vector<Point2> pixels;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (const int label = labels.at<unsigned short>(y, x); label != 0 && holds(members, label))
        pixels.emplace_back(x, y);
  return pixels;
}

Point2 mean_of(const std::vector<Point2>& points) {
  Point2 sum = Point2::Zero();
  for (const Point2& p : points) sum += p;
  return sum / static_cast<double>(std::max<size_t>(1, points.size()));
}

/// Rotation (no mirror image) that best lays `from` over `to`.
Eigen::Matrix2d best_rotation(const std::vector<Point2>& from, const std::vector<Point2>& to) {
  const Point2 mean_from = mean_of(from), mean_to = mean_of(to);
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (size_t i = 0; i < from.size(); ++i) moment += (to[i] - mean_to) * (from[i] - mean_from).transpose();
  if (moment.norm() < 1e-9) return Eigen::Matrix2d::Identity();
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Eigen::Vector2d(1, sign).asDiagonal() * svd.matrixV().transpose();
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

struct RoomTally {
  double points = 0, hits = 0, answers = 0;
};

void judge_transfer(const JudgedPair& truth, const PointTransfer& transfer, const std::vector<size_t>& tapped,
                    PairFigures& figures) {
  std::vector<std::vector<Point2>> rooms_a, rooms_b;
  std::vector<Point2> middles_a, middles_b;
  for (const JudgedGroup& group : truth.groups) {
    rooms_a.push_back(pixels_of(truth.truth_a, group.labels_a));
    rooms_b.push_back(pixels_of(truth.truth_b, group.labels_b));
    if (!rooms_a.back().empty() && !rooms_b.back().empty())
      middles_a.push_back(mean_of(rooms_a.back())), middles_b.push_back(mean_of(rooms_b.back()));
  }
  if (middles_a.empty()) return;
  const Eigen::Matrix2d turn = best_rotation(middles_a, middles_b);
  std::mt19937_64 random(1);
  std::vector<double> errors;
  double rooms = 0, untapped = 0, near = 0;
  for (size_t g = 0; g < truth.groups.size(); ++g) {
    if (rooms_a[g].empty() || rooms_b[g].empty()) continue;
    const Box box_a(rooms_a[g], turn), box_b(rooms_b[g], Eigen::Matrix2d::Identity());
    RoomTally tally;
    const int count = std::max(1, kPointsPerPair / static_cast<int>(middles_a.size()));
    for (int k = 0; k < count; ++k) {
      const Point2& p = rooms_a[g][uniform_index(random, rooms_a[g].size())];
      const Transferred place = transfer(p);
      tally.points += 1;
      if (!place.p) continue;
      tally.answers += 1;
      const int x = static_cast<int>(std::lround(place.p->x())), y = static_cast<int>(std::lround(place.p->y()));
      const bool inside = x >= 0 && y >= 0 && x < truth.truth_b.cols && y < truth.truth_b.rows &&
                          holds(truth.groups[g].labels_b, truth.truth_b.at<unsigned short>(y, x));
      if (!inside) continue;
      tally.hits += 1;
      const double miss = (*place.p - relative_place(p, box_a, box_b, turn, rooms_b[g])).norm();
      errors.push_back(miss / ((box_b.high - box_b.low).array() + 1).matrix().norm());
      near += miss < 1.5 * place.sigma;
    }
    const double hit = tally.hits / tally.points;
    figures.room_hit += hit, figures.answered += tally.answers / tally.points, rooms += 1;
    if (std::find(tapped.begin(), tapped.end(), g) == tapped.end()) figures.untapped_hit += hit, untapped += 1;
  }
  figures.room_hit /= rooms, figures.answered /= rooms;
  figures.untapped_hit = untapped > 0 ? figures.untapped_hit / untapped : figures.room_hit;
  if (!errors.empty()) {
    figures.inside_sigma = near / static_cast<double>(errors.size());
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
    figures.position_error = errors[errors.size() / 2];
  }
}

std::vector<Point2> points_of(const nlohmann::json& list) {
  std::vector<Point2> points;
  for (const auto& p : list) points.emplace_back(p[0].get<double>(), p[1].get<double>());
  return points;
}

Result<Segmentation> read_and_segment(const std::string& path, const ConstrictionParams& params) {
  const cv::Mat picture = cv::imread(path, cv::IMREAD_GRAYSCALE);
  const auto free_space = free_space_of_picture(picture);
  if (!free_space) return fail(free_space.error().code, path + ": " + free_space.error().message);
  return segment_by_constrictions(*free_space, params);
}

cv::Mat read_labels(const std::string& path) {
  cv::Mat labels = cv::imread(path, cv::IMREAD_UNCHANGED), wide;
  if (labels.channels() > 1) cv::extractChannel(labels, labels, 0);
  labels.convertTo(wide, CV_16U);
  return wide;
}

void print_reliability(const std::vector<std::pair<double, bool>>& said) {
  std::printf("    reliability (said: right of pairs):");
  for (const auto& [low, high] : {std::pair(0.0, 0.3), {0.3, 0.5}, {0.5, 0.7}, {0.7, 0.9}, {0.9, 1.01}}) {
    int right = 0, all = 0;
    for (const auto& [confidence, is_right] : said)
      if (confidence >= low && confidence < high) all += 1, right += is_right;
    std::printf("  %.1f-%.1f %d/%d=%.2f", low, std::min(1.0, high), right, all, all ? double(right) / all : 0.0);
  }
  std::printf("\n");
}

}  // namespace

PairFigures judge(const JudgedPair& pair, int taps, const MatchParams& params) {
  PairFigures figures;
  const std::vector<size_t> tapped = farthest_groups(pair.groups, taps);
  std::vector<Pin> pins;
  for (const size_t g : tapped) pins.push_back({pair.groups[g].clicks_a.front(), pair.groups[g].clicks_b.front()});
  const std::clock_t begin = std::clock();
  const auto matching = match(pair.a, pair.b, pins, {}, params);
  if (!matching) {
    figures.doubtful = true;
    return figures;
  }
  const PointTransfer transfer(pair.a, pair.b, *matching, pins);
  figures.match_ms = 1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  figures.doubtful = matching->doubtful;
  judge_pairs(pair, *matching, figures);
  judge_transfer(pair, transfer, tapped, figures);
  return figures;
}

Matching true_matching(const JudgedPair& pair) {
  Matching matching;
  const auto most = [](const cv::Mat& labels, int label, const cv::Mat& truth) {
    std::map<int, int> count;
    for (int y = 0; y < labels.rows; ++y)
      for (int x = 0; x < labels.cols; ++x)
        if (labels.at<unsigned short>(y, x) == label && truth.at<unsigned short>(y, x) != 0)
          ++count[truth.at<unsigned short>(y, x)];
    int best = 0, found = 0;
    for (const auto& [room, pixels] : count)
      if (pixels > best) best = pixels, found = room;
    return found;
  };
  std::vector<Point2> from, to;
  for (const Region& a : pair.a.regions)
    for (const Region& b : pair.b.regions) {
      const int room_a = most(pair.a.labels, a.label, pair.truth_a),
                room_b = most(pair.b.labels, b.label, pair.truth_b);
      const bool same = std::any_of(pair.groups.begin(), pair.groups.end(), [&](const JudgedGroup& group) {
        return holds(group.labels_a, room_a) && holds(group.labels_b, room_b);
      });
      if (!same) continue;
      matching.pairs.push_back({a.label, b.label, 1, Verdict::kProposed});
      from.push_back(a.centroid_px), to.push_back(b.centroid_px);
    }
  if (from.size() > 1) matching.turn_b_a = best_rotation(from, to);
  return matching;
}

PairFigures judge_answer(const JudgedPair& pair, const Matching& matching, const std::vector<Pin>& pins) {
  PairFigures figures;
  const PointTransfer transfer(pair.a, pair.b, matching, pins);
  judge_pairs(pair, matching, figures);
  judge_transfer(pair, transfer, {}, figures);
  return figures;
}

Result<std::vector<JudgedPair>> read_judged_pairs(const std::string& folder, const std::string& set,
                                                  const ConstrictionParams& params) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path where = std::filesystem::path(folder) / set / "gt";
  if (!std::filesystem::is_directory(where)) return fail(Errc::kNotFound, "there is no folder " + where.string());
  for (const auto& entry : std::filesystem::directory_iterator(where))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<JudgedPair> pairs;
  std::map<std::string, Segmentation> known;  // the metric map is the same for many
  for (const auto& file : files) {
    std::ifstream stream(file);
    const nlohmann::json record = nlohmann::json::parse(stream, nullptr, false);
    if (record.is_discarded()) return fail(Errc::kCorrupt, file.string() + " is not JSON");
    for (const char* key : {"sketch", "metric"}) {
      const std::string path = folder + "/" + record[key].get<std::string>();
      if (known.contains(path)) continue;
      auto segmentation = read_and_segment(path, params);
      if (!segmentation) return segmentation.error();
      known[path] = std::move(*segmentation);
    }
    for (const auto& [annotator, said] : record["annotators"].items()) {
      JudgedPair pair{set, file.stem().string(), annotator, {}, {}, {}, {}, {}};
      pair.a = known[folder + "/" + record["sketch"].get<std::string>()];
      pair.b = known[folder + "/" + record["metric"].get<std::string>()];
      pair.truth_a = read_labels(folder + "/" + record["sketch_labels"].get<std::string>());
      pair.truth_b = read_labels(folder + "/" + record["metric_labels"].get<std::string>());
      for (const auto& group : said["groups"])
        pair.groups.push_back({points_of(group["sketch_points"]), points_of(group["metric_points"]),
                               group["sketch_labels"].get<std::vector<int>>(),
                               group["metric_labels"].get<std::vector<int>>()});
      pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

std::vector<JudgedPair> generated_pairs(int count, std::uint64_t first_seed, const ConstrictionParams& params) {
  std::vector<JudgedPair> pairs;
  for (std::uint64_t seed = first_seed; static_cast<int>(pairs.size()) < count; ++seed) {
    std::mt19937_64 random(seed);
    const test::PlanPicture plan =
        seed % 2 ? test::hall_plan(random) : test::office_plan(random, 2 + static_cast<int>(uniform_index(random, 4)));
    test::SketchHabits habits;
    habits.quarter_turns = static_cast<int>(uniform_index(random, 4));
    habits.scale = uniform(random, 0.7, 1.6), habits.stretch = uniform(random, 0.75, 1.3);
    habits.tilt_rad = normal(random, 0.05), habits.bend_px = uniform(random, 2, 8);
    habits.rooms_left_out = static_cast<int>(uniform_index(random, 3));
    habits.doors_forgotten = static_cast<int>(uniform_index(random, 3));
    habits.uneven = uniform(random, 0, 0.5);
    const test::PlanSketch sketch = test::sketch_of(plan, habits, random);
    auto a = segment_by_constrictions(sketch.picture.free_space, params);
    auto b = segment_by_constrictions(plan.free_space, params);
    if (!a || !b) continue;
    JudgedPair pair{"generated",   std::to_string(seed), "truth",    std::move(*a),
                    std::move(*b), sketch.picture.rooms, plan.rooms, {}};
    for (int room = 1; room <= static_cast<int>(plan.boxes.size()); ++room) {
      const std::vector<Point2> drawn = pixels_of(pair.truth_a, {room});
      if (drawn.size() < 30) continue;
      const cv::Rect box = plan.boxes[static_cast<size_t>(room - 1)];
      const Point2 middle(box.x + box.width / 2, box.y + box.height / 2);
      const Point2 click = *std::min_element(drawn.begin(), drawn.end(), [&](const Point2& one, const Point2& two) {
        return (sketch.on_plan(one) - middle).squaredNorm() < (sketch.on_plan(two) - middle).squaredNorm();
      });
      pair.groups.push_back({{click}, {middle}, {room}, {room}});
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

void print_matching_figures(const std::vector<JudgedPair>& pairs, const std::vector<int>& taps,
                            const MatchParams& params, bool every_pair) {
  std::set<std::pair<std::string, std::string>> rows;
  for (const JudgedPair& pair : pairs) rows.emplace(pair.set, pair.annotator);
  for (const int count : taps) {
    std::vector<std::pair<double, bool>> said;
    int low = 0, low_unflagged = 0, flagged = 0, all = 0;
    for (const auto& [set, annotator] : rows) {
      PairFigures sum;
      double number = 0, slowest = 0;
      for (const JudgedPair& pair : pairs) {
        if (pair.set != set || pair.annotator != annotator) continue;
        const PairFigures one = judge(pair, count, params);
        number += 1, all += 1, flagged += one.doubtful;
        low += one.room_hit < 0.2, low_unflagged += one.room_hit < 0.2 && !one.doubtful;
        sum.points_f1 += one.points_f1, sum.room_hit += one.room_hit, sum.untapped_hit += one.untapped_hit;
        sum.answered += one.answered, sum.position_error += one.position_error, sum.match_ms += one.match_ms;
        sum.inside_sigma += one.inside_sigma;
        slowest = std::max(slowest, one.match_ms);
        said.insert(said.end(), one.said.begin(), one.said.end());
        if (every_pair)
          std::printf("    %s/%s %s  F1 %.2f hit %.2f untapped %.2f error %.2f %4.0f ms %s\n", set.c_str(),
                      pair.name.c_str(), annotator.c_str(), one.points_f1, one.room_hit, one.untapped_hit,
                      one.position_error, one.match_ms, one.doubtful ? "doubtful" : "");
      }
      std::printf(
          "%-9s %-9s taps %d  n %2.0f  points F1 %.3f  room_hit %.3f  untapped %.3f  answered %.3f  error %.3f  within "
          "1.5 sigma %.2f  %.0f ms (max %.0f)\n",
          set.c_str(), annotator.c_str(), count, number, sum.points_f1 / number, sum.room_hit / number,
          sum.untapped_hit / number, sum.answered / number, sum.position_error / number, sum.inside_sigma / number,
          sum.match_ms / number, slowest);
    }
    std::printf("    room_hit < 0.2: %d of %d, not flagged %d; flagged %d\n", low, all, low_unflagged, flagged);
    print_reliability(said);
  }
  std::fflush(stdout);
}

}  // namespace smokemap::bench
