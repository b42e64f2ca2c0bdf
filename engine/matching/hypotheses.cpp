#include "matching/hypotheses.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "matching/explained.hpp"
#include "matching/region_graph.hpp"

namespace smokemap {
namespace {

constexpr int kCoarse_cells = 44;
constexpr int kFine_cells = 72;
constexpr double kCoarseSlope_cells = 3;
constexpr double kFineSlope_cells = 4;
constexpr int kRefined = 3;                 ///< of the best hypotheses, laid again as their pairs ask
constexpr double kWarpWeight = 0.5;         ///< of the likeness after bending beside the energy of the structure
constexpr double kCoverWeight = 0.35;       ///< of the share of b that has a partner
constexpr double kMatchedWeight = 0.18;     ///< of the share of a that has a partner
constexpr double kSizeSpreadWeight = 0.09;  ///< of how unevenly rooms were drawn larger or smaller than they are
constexpr double kScalePrior = 3;  ///< weight of the former scale against what the pairs say, in their total weight
constexpr double kMostRescaling = 1.6;

Eigen::Matrix2d turn_of(const Eigen::Matrix2d& linear) {
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

void sort_best_first(std::vector<Hypothesis>& all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Hypothesis& one, const Hypothesis& two) { return one.score > two.score; });
}

/// Two alignments may lead to the same pairs: the better one stays.
void add_hypothesis(Hypothesis hypothesis, std::vector<Hypothesis>& all) {
  for (Hypothesis& other : all)
    if (other.structure.partner == hypothesis.structure.partner) {
      if (hypothesis.score > other.score) other = std::move(hypothesis);
      return;
    }
  all.push_back(std::move(hypothesis));
}

}  // namespace

HypothesisFinder::HypothesisFinder(const Segmentation& a, const Segmentation& b, const MatchParams& params)
    : a_(a),
      b_(b),
      params_(params),
      alignments_(make_raster(a, kCoarse_cells, kCoarseSlope_cells), make_raster(b, kCoarse_cells, kCoarseSlope_cells),
                  params.allow_mirror ? Facing::kEither : Facing::kAsDrawn),
      bending_(make_raster(a, kFine_cells, kFineSlope_cells), make_raster(b, kFine_cells, kFineSlope_cells)),
      graph_a_(make_region_graph(a)),
      graph_b_(make_region_graph(b)) {
  const AlignmentSearch mirrored(make_raster(a, kCoarse_cells, kCoarseSlope_cells),
                                 make_raster(b, kCoarse_cells, kCoarseSlope_cells), Facing::kMirrored);
  const Eigen::MatrixXi none = Eigen::MatrixXi::Zero(graph_a_.size(), graph_b_.size());
  mirrored_score_ = find_among(mirrored, {}, {none, none}).front().score;
  untapped_ = find_among(alignments_, {}, {none, none});
}

std::vector<Hypothesis> HypothesisFinder::find(const std::vector<Pin>& pins, const PairRules& rules) const {
  if (pins.empty() && rules.forced.isZero() && rules.forbidden.isZero()) return untapped_;
  return find_among(alignments_, pins, rules);
}

FitEvidence HypothesisFinder::weigh_fit(const std::vector<Hypothesis>& all) const {
  const Hypothesis& best = all.front();
  FitEvidence fit;
  const double matched = matched_share(graph_a_, best.structure.partner);
  double likeness = 0;
  for (int i = 0; i < graph_a_.size(); ++i)
    if (const int j = best.structure.partner[static_cast<size_t>(i)]; j >= 0)
      likeness += graph_a_.importance(i) * best.scores.likeness(i, j);
  fit.likeness = matched > 0 ? likeness / matched : 0;
  fit.explained = matched * covered_share(graph_b_, best.structure.partner);
  // The wrong side of the sheet: the mirror image, or the drawing as it is if the answer is mirrored itself.
  const bool is_mirrored = best.turn_b_a.determinant() < 0;
  double wrong_side = is_mirrored ? 0 : mirrored_score_;
  for (const Hypothesis& other : all)
    if ((other.turn_b_a.determinant() < 0) != is_mirrored) wrong_side = std::max(wrong_side, other.score);
  fit.lead = best.score - wrong_side;
  fit.regions = std::min(graph_a_.size(), graph_b_.size());
  fit.ratio = static_cast<double>(std::max(graph_a_.size(), graph_b_.size())) / fit.regions;
  return fit;
}

std::vector<Hypothesis> HypothesisFinder::find_among(const AlignmentSearch& alignments, const std::vector<Pin>& pins,
                                                     const PairRules& rules) const {
  std::vector<Hypothesis> all;
  for (const MapAlignment& alignment : alignments.best(pins, params_.candidates))
    add_hypothesis(solve(alignment, pins, rules), all);
  sort_best_first(all);
  const size_t count = std::min(all.size(), static_cast<size_t>(kRefined));
  for (size_t i = 0; i < count; ++i) {
    Hypothesis refined = solve(laid_by_pairs(all[i]), pins, rules);
    if (refined.score > all[i].score) all[i] = std::move(refined);
  }
  sort_best_first(all);
  return all;
}

Hypothesis HypothesisFinder::solve(const MapAlignment& alignment, const std::vector<Pin>& pins,
                                   const PairRules& rules) const {
  Hypothesis result;
  result.alignment = alignment;
  result.turn_b_a = turn_of(alignment.T_b_a_px.linear());
  result.warp = bending_.bend(alignment, pins);
  result.scores = score_pairs(a_, b_, bending_.a(), bending_.b(), result.warp);
  StructureProblem problem;
  problem.a = &graph_a_, problem.b = &graph_b_, problem.turn_b_a = result.turn_b_a;
  problem.scale_b_a = std::sqrt(std::abs(alignment.T_b_a_px.linear().determinant()));
  problem.likeness = result.scores.likeness;
  problem.forced = rules.forced, problem.forbidden = rules.forbidden;
  problem.many_to_one = params_.allow_many_to_many;
  result.structure = match_structure(problem);
  const std::vector<int>& partner = result.structure.partner;
  result.score = result.structure.energy + kWarpWeight * result.warp.score +
                 kCoverWeight * covered_share(graph_b_, partner) + kMatchedWeight * matched_share(graph_a_, partner) -
                 kSizeSpreadWeight * size_spread(graph_a_, graph_b_, partner);
  return result;
}

/// Turn kept; scale along both wall directions of b and shift such that partners' middles meet, weighted.
MapAlignment HypothesisFinder::laid_by_pairs(const Hypothesis& hypothesis) const {
  const Eigen::Matrix2d axes_b = Eigen::Rotation2Dd(bending_.b().wall_direction_rad).toRotationMatrix();
  const Eigen::Matrix2d straight = axes_b.transpose() * hypothesis.turn_b_a;
  std::vector<std::pair<Point2, Point2>> meets;
  std::vector<double> weights;
  for (int i = 0; i < graph_a_.size(); ++i) {
    const int j = hypothesis.structure.partner[static_cast<size_t>(i)];
    if (j < 0) continue;
    meets.emplace_back(straight * graph_a_.middles_px[static_cast<size_t>(i)],
                       axes_b.transpose() * graph_b_.middles_px[static_cast<size_t>(j)]);
    weights.push_back(graph_a_.importance(i) * (0.05 + hypothesis.structure.certainty(i, j)));
  }
  if (meets.size() < 2) return hypothesis.alignment;
  Point2 mean_a = Point2::Zero(), mean_b = Point2::Zero();
  double total = 0;
  for (size_t k = 0; k < meets.size(); ++k) {
    mean_a += weights[k] * meets[k].first, mean_b += weights[k] * meets[k].second;
    total += weights[k];
  }
  mean_a /= total, mean_b /= total;
  const double before = std::sqrt(std::abs(hypothesis.alignment.T_b_a_px.linear().determinant()));
  Eigen::Array2d moment = Eigen::Array2d::Zero(), spread = Eigen::Array2d::Zero();
  for (size_t k = 0; k < meets.size(); ++k) {
    const Eigen::Array2d from = meets[k].first - mean_a, to = meets[k].second - mean_b;
    moment += weights[k] * from * to, spread += weights[k] * from * from;
  }
  const double held = kScalePrior * spread.mean();
  const Eigen::Array2d scale =
      ((moment + held * before) / (spread + held).max(1e-9)).max(before / kMostRescaling).min(before * kMostRescaling);
  MapAlignment laid = hypothesis.alignment;
  laid.T_b_a_px.linear() = axes_b * scale.matrix().asDiagonal() * straight;
  laid.T_b_a_px.translation() = axes_b * (mean_b - (scale * mean_a.array()).matrix());
  return laid;
}

}  // namespace smokemap
