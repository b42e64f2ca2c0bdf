#include "acg/anchors.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/delaunay.hpp"

namespace smokemap {
namespace {

constexpr double kFinger_m = 0.5;      ///< how far people point beside the same place without meaning another
constexpr double kLocalStretch = 0.2;  ///< two sigma of a plan's local stretch, over the distance from a known pair
constexpr double kMaxScale = 1.8;      ///< of a pair of pairs against the plan's own scale; more is no plan to scale
constexpr double kMinApart_m = 1.0;
constexpr std::size_t kEnough = 3;  ///< pairs that agree

/// What agrees with the similarity through pairs i and j.
struct Consensus {
  std::vector<bool> agrees;
  std::size_t count = 0;
  double error_m = 0;
};

std::optional<Consensus> consensus(const std::vector<PointPair>& pairs, std::size_t i, std::size_t j) {
  if ((pairs[i].p_a - pairs[j].p_a).norm() < kMinApart_m || (pairs[i].p_b - pairs[j].p_b).norm() < kMinApart_m)
    return std::nullopt;
  const auto through = fit_similarity({pairs[i], pairs[j]});
  if (!through || std::max(through->scale, 1 / through->scale) > kMaxScale) return std::nullopt;
  Consensus out;
  for (const PointPair& p : pairs) {
    const double away = std::min((p.p_a - pairs[i].p_a).norm(), (p.p_a - pairs[j].p_a).norm());
    const double error = (*through * p.p_b - p.p_a).norm();
    out.agrees.push_back(error < kFinger_m + kLocalStretch * away);
    out.count += out.agrees.back();
    out.error_m += out.agrees.back() ? error : 0;
  }
  return out;
}

}  // namespace

std::vector<bool> outlying_pairs(const std::vector<PointPair>& judged, const std::optional<PointPair>& witness) {
  std::vector<PointPair> pairs = judged;
  if (witness) pairs.push_back(*witness);
  Consensus best;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      auto c = consensus(pairs, i, j);
      if (c && (c->count > best.count || (c->count == best.count && c->error_m < best.error_m))) best = std::move(*c);
    }
  std::vector<bool> out(judged.size(), false);
  if (best.count < kEnough || 2 * best.count <= pairs.size()) return out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = !best.agrees[i];
  return out;
}

std::vector<PointPair> trusted_pairs(const std::vector<PointPair>& pairs, const std::vector<bool>& outlying) {
  std::vector<PointPair> out;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (!outlying[i]) out.push_back(pairs[i]);
  return out;
}

std::optional<AnchorLink> anchor_link(const PlanModel& plan, const Point2& p, const Point2& p_map) {
  std::vector<int> order(plan.corners.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  const auto at = [&](int i) -> const Point2& { return plan.corners[static_cast<std::size_t>(i)]; };
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return (at(i) - p).norm() < (at(j) - p).norm(); });
  for (std::size_t k = 2; k < order.size(); ++k) {
    const Point2 u = at(order[1]) - at(order[0]), v = at(order[k]) - at(order[0]);
    if (u.norm() < 0.05 || std::abs(u.x() * v.y() - u.y() * v.x()) < 0.3 * u.norm() * v.norm()) continue;
    return AnchorLink{{order[0], order[1], order[k]}, barycentric(p, at(order[0]), at(order[1]), at(order[k])), p_map};
  }
  return std::nullopt;
}

double residual_m(const AnchorLink& link, const GraphState& state) {
  Point2 p = Point2::Zero();
  for (int k = 0; k < 3; ++k) p += link.shares[k] * state.corner(link.corners[static_cast<std::size_t>(k)]);
  return (p - link.p_map).norm();
}

}  // namespace smokemap
