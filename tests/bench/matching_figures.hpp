#pragma once

#include <string>
#include <utility>
#include <vector>

#include "matching/match.hpp"
#include "tests/bench/judged_pairs.hpp"

namespace smokemap::bench {

/// How one match was, by the rules of the published evaluation.
struct PairFigures {
  double points_f1 = 0;  ///< pairs against clicks, both looked up in our own regions
  double room_hit = 0;   ///< share of points of a room that land in its partner, every room alike
  double untapped_hit = 0;
  double answered = 0;
  double position_error = 0;  ///< median, share of the room's diagonal, of the points in the right room
  double match_ms = 0;        ///< from regions to a way for points; with taps: from the last tap on
  double in_walls = 0;        ///< share of answers that are not in free space
  bool doubtful = false;
  std::vector<std::pair<double, bool>> said;  ///< confidence of a pair, was it right (pairs of judged regions)
  std::vector<double> misses;                 ///< of answers in the right room, in said sigmas
  std::vector<double> returns;                ///< distance after there and back, share of the room's diagonal
};

enum class Taps {
  kFarApart,  ///< the first click of each of the groups that lie farthest apart
  kAsked      ///< of the group at the region that matching asks for, one after the other
};

/// @param taps  rooms that a person taps first
PairFigures judge(const JudgedPair& pair, int taps, const MatchParams& params, Taps choice = Taps::kFarApart);

/// Figures of an answer made elsewhere.
PairFigures judge_answer(const JudgedPair& pair, const Matching& matching, const std::vector<Pin>& pins);

/// How often what was said came true, and whether right pairs were said to be surer than wrong ones.
void print_reliability(const std::vector<std::pair<double, bool>>& said);

/// The table of the matching part, one line a set, annotator and number of taps, with the reliability table below.
void print_matching_figures(const std::vector<JudgedPair>& pairs, const std::vector<int>& taps,
                            const MatchParams& params, bool every_pair, Taps choice = Taps::kFarApart);

/// All sets below a folder that are there (KTH, E5_on_08, E5_on_10); one error if one cannot be read.
Result<std::vector<JudgedPair>> read_judged_sets(const std::string& folder, const Segmenter& segmenter);

}  // namespace smokemap::bench
