#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "geometry/pose2.hpp"

namespace smokemap {

enum class Verdict {
  kProposed,
  kConfirmed,
  kRejected
};  ///< confirmed and rejected come from people and survive re-runs

/// A region of one map and the region of another that is the same place.
struct RegionPair {
  int label_a = 0;        ///< on the sketch (or layout)
  int label_b = 0;        ///< on the other map
  double confidence = 0;  ///< 0..1, calibrated: of pairs said to be 0.9 sure, nine in ten are right, among maps that
                          ///< may be of other buildings; what people did not say has at most 0.75 in doubtful matchings
                          ///< and where same_building is below 0.93
  Verdict verdict = Verdict::kProposed;
};

/// What a person says is the same place.
struct Pin {
  Point2 p_a_px = Point2::Zero();
  Point2 p_b_px = Point2::Zero();
};

/// Below this `Matching::same_building` says that the two maps do not seem to belong together.
constexpr double kFitsFrom = 0.55;

/// Region correspondences between two segmented maps, with doubt made visible.
struct Matching {
  std::vector<RegionPair> pairs;        ///< worst confidence first
  std::vector<RegionPair> runner_up;    ///< the second-best hypothesis, empty if there is none
  double margin = 0;                    ///< how much better the best is than the runner-up, 0..1
  bool doubtful = false;                ///< the whole matching should be looked at by a person
  double same_building = 0;             ///< 0..1, calibrated: that both are maps of one building at all
  std::optional<int> next_pin_label_a;  ///< the region whose tap would tell most
  Eigen::Matrix2d turn_b_a =
      Eigen::Matrix2d::Identity();  ///< how map a is turned (and mirrored) over b, pictures with y down
};

/// Where a point of one map lies on another. No place is an answer; a place without its error is not.
struct Transferred {
  std::optional<Point2> p;
  double sigma = 0;       ///< one standard deviation per coordinate, unit of p
  double confidence = 0;  ///< 0..1 that it is in the right room
  std::string reason;     ///< why there is no place, for people
};

}  // namespace smokemap
