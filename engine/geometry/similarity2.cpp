#include "geometry/similarity2.hpp"

namespace smokemap {

Similarity2 Similarity2::inverse() const {
  const Pose2 turn(0, 0, -T_a_b.heading());
  return {1 / scale, Pose2(-(turn * T_a_b.translation()) / scale, -T_a_b.heading())};
}

Result<Similarity2> fit_similarity(const std::vector<PointPair>& pairs) {
  Point2 mean_a = Point2::Zero(), mean_b = Point2::Zero();
  double weight = 0;
  for (const PointPair& pair : pairs) {
    const double w = 1 / (pair.sigma_m * pair.sigma_m);
    mean_a += w * pair.p_a, mean_b += w * pair.p_b, weight += w;
  }
  if (pairs.size() < 2) return fail(Errc::kDegenerate, "a similarity needs two pairs of points");
  mean_a /= weight, mean_b /= weight;
  double dot = 0, cross = 0, spread_a = 0, spread_b = 0;
  for (const PointPair& pair : pairs) {
    const double w = 1 / (pair.sigma_m * pair.sigma_m);
    const Point2 a = pair.p_a - mean_a, b = pair.p_b - mean_b;
    dot += w * b.dot(a);
    cross += w * (b.x() * a.y() - b.y() * a.x());
    spread_a += w * a.squaredNorm(), spread_b += w * b.squaredNorm();
  }
  const double agreement = std::hypot(dot, cross);
  if (!(spread_b > 1e-12 * weight) || !(spread_a > 1e-12 * weight) || !(agreement > 0))
    return fail(Errc::kDegenerate, "the pairs of points all lie in one place");
  Similarity2 fit;
  fit.scale = agreement / spread_b;
  const Pose2 turn(0, 0, std::atan2(cross, dot));
  fit.T_a_b = Pose2(mean_a - fit.scale * (turn * mean_b), turn.heading());
  return fit;
}

}  // namespace smokemap
