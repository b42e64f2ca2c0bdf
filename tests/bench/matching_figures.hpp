#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "geometry/pose2.hpp"
#include "maps/segmentation.hpp"
#include "matching/match.hpp"
#include "segmentation/constriction.hpp"

namespace smokemap::bench {

/// What one person (or the generator) says is one place on both maps.
struct JudgedGroup {
  std::vector<Point2> clicks_a, clicks_b;
  std::vector<int> labels_a, labels_b;  ///< in the label images of the truth
};

/// Two maps and one person's truth about them.
struct JudgedPair {
  std::string set, name, annotator;
  Segmentation a, b;         ///< our own reading of both maps
  cv::Mat truth_a, truth_b;  /// CV_16UC1: the true rooms
  std::vector<JudgedGroup> groups;
};

/// How one match was, by the rules of the published evaluation: see docs of `judge`.
struct PairFigures {
  double points_f1 = 0;  ///< pairs against clicks, both looked up in our own regions
  double room_hit = 0;   ///< share of points of a room that land in its partner, every room alike
  double untapped_hit = 0;
  double answered = 0;
  double position_error = 0;  ///< median, share of the room's diagonal, of the points in the right room
  double match_ms = 0;        ///< from regions to transferred points
  double inside_sigma = 0;    ///< share of answers (right room) nearer than one and a half said sigmas
  bool doubtful = false;
  std::vector<std::pair<double, bool>> said;  ///< confidence of a pair, was it right (pairs of judged regions)
};

/// @param taps  rooms that a person taps first: the first click of each of the groups that lie farthest apart
PairFigures judge(const JudgedPair& pair, int taps, const MatchParams& params);

/// The best that can be said of our regions: those that mostly lie in rooms of one group are pairs, all sure.
Matching true_matching(const JudgedPair& pair);

/// Figures of an answer made elsewhere.
PairFigures judge_answer(const JudgedPair& pair, const Matching& matching, const std::vector<Pin>& pins);

/// DIR/<set>/gt/*.json with label images, as in the folder's README; maps are segmented by our own default.
Result<std::vector<JudgedPair>> read_judged_pairs(const std::string& folder, const std::string& set,
                                                  const ConstrictionParams& params);

/// Sketches made from random buildings the way people draw, with exact truth, one for each seed from `first_seed` on.
std::vector<JudgedPair> generated_pairs(int count, std::uint64_t first_seed, const ConstrictionParams& params);

/// The table of the matching part, one line a set, annotator and number of taps, with the reliability table below.
void print_matching_figures(const std::vector<JudgedPair>& pairs, const std::vector<int>& taps,
                            const MatchParams& params, bool every_pair);

}  // namespace smokemap::bench
