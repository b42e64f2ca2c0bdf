#include "geometry/deformation.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/delaunay.hpp"

namespace smokemap {

struct Deformation::Mesh {
  Similarity2 similarity;
  std::vector<Point2> source, target;  ///< the first four are the box
  std::vector<double> sigma_m;
  std::vector<TriangleIndices> triangles;
  TriangleLocator in_source, in_target;
  bool folded = false;
};

namespace {

constexpr double kSameNode_m = 1e-3;
constexpr double kSmallestArea = 0.05;  ///< of what the similarity would make of a triangle: below, it counts as folded

double twice_area(const std::vector<Point2>& p, const TriangleIndices& t) {
  const Point2& a = p[static_cast<std::size_t>(t[0])];
  const Point2 b = p[static_cast<std::size_t>(t[1])] - a, c = p[static_cast<std::size_t>(t[2])] - a;
  return b.x() * c.y() - b.y() * c.x();
}

std::vector<PointPair> without_doubles(const std::vector<PointPair>& pairs) {
  std::vector<PointPair> nodes;
  std::vector<int> merged;
  for (const PointPair& pair : pairs) {
    const auto same = std::find_if(nodes.begin(), nodes.end(),
                                   [&](const PointPair& n) { return (n.p_b - pair.p_b).norm() < kSameNode_m; });
    if (same == nodes.end()) {
      nodes.push_back(pair);
      merged.push_back(1);
      continue;
    }
    const double n = ++merged[static_cast<std::size_t>(same - nodes.begin())];
    same->p_a += (pair.p_a - same->p_a) / n;
    same->sigma_m = std::max(same->sigma_m, pair.sigma_m);
  }
  return nodes;
}

/// Four corners around all nodes, half as far out again as the nodes reach.
std::vector<Point2> box_around(const std::vector<PointPair>& nodes) {
  Point2 low = nodes.front().p_b, high = low;
  for (const PointPair& n : nodes) {
    low = low.cwiseMin(n.p_b);
    high = high.cwiseMax(n.p_b);
  }
  const double margin = 0.5 * (high - low).maxCoeff() + 0.01;
  low.array() -= margin;
  high.array() += margin;
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

/// Pulls the corners of folded triangles towards the similarity, harder each round, until none is folded.
bool unfold(const std::vector<Point2>& rigid, const std::vector<TriangleIndices>& triangles,
            std::vector<Point2>& target) {
  bool any = false;
  for (int round = 0; round < 40; ++round) {
    std::vector<bool> bad(target.size(), false);
    bool found = false;
    for (const TriangleIndices& t : triangles) {
      const double wanted = twice_area(rigid, t);
      if (twice_area(target, t) > kSmallestArea * wanted) continue;
      if (twice_area(target, t) > 0 && wanted < 1e-6) continue;
      found = true;
      for (const int i : t) bad[static_cast<std::size_t>(i)] = true;
    }
    if (!found) return any;
    any = true;
    const double pull = round < 39 ? 0.25 : 1.0;
    for (std::size_t i = 0; i < target.size(); ++i)
      if (bad[i]) target[i] += pull * (rigid[i] - target[i]);
  }
  return any;
}

}  // namespace

Deformation::Deformation() : mesh_(std::make_shared<Mesh>()) {}

Deformation Deformation::from_similarity(const Similarity2& similarity) {
  auto mesh = std::make_shared<Mesh>();
  mesh->similarity = similarity;
  Deformation out;
  out.mesh_ = std::move(mesh);
  return out;
}

Result<Deformation> Deformation::build(const std::vector<PointPair>& pairs) {
  for (const PointPair& pair : pairs)
    if (!pair.p_a.allFinite() || !pair.p_b.allFinite())
      return fail(Errc::kInvalidArgument, "deformation: a node is not finite");
  const std::vector<PointPair> nodes = without_doubles(pairs);
  std::vector<PointPair> equal = nodes;
  for (PointPair& n : equal) n.sigma_m = 1;
  const auto similarity = fit_similarity(equal);
  if (!similarity) return similarity.error();

  auto mesh = std::make_shared<Mesh>();
  mesh->similarity = *similarity;
  mesh->source = box_around(nodes);
  double worst_sigma = 0;
  for (const PointPair& n : nodes) {
    mesh->source.push_back(n.p_b);
    worst_sigma = std::max(worst_sigma, n.sigma_m);
  }
  std::vector<Point2> rigid;
  for (const Point2& p : mesh->source) rigid.push_back(*similarity * p);
  mesh->target = rigid;
  mesh->sigma_m.assign(mesh->source.size(), 2 * worst_sigma);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    mesh->target[i + 4] = nodes[i].p_a;
    mesh->sigma_m[i + 4] = nodes[i].sigma_m;
  }
  mesh->triangles = triangulate_in_box(mesh->source);
  mesh->folded = unfold(rigid, mesh->triangles, mesh->target);
  mesh->in_source = TriangleLocator(mesh->source, mesh->triangles);
  mesh->in_target = TriangleLocator(mesh->target, mesh->triangles);
  Deformation out;
  out.mesh_ = std::move(mesh);
  return out;
}

Point2 Deformation::operator()(const Point2& p_source) const {
  const auto hit = mesh_->in_source.find(p_source);
  if (!hit) return mesh_->similarity * p_source;
  Point2 p = Point2::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    p += hit->shares[static_cast<int>(k)] *
         mesh_->target[static_cast<std::size_t>(mesh_->triangles[static_cast<std::size_t>(hit->triangle)][k])];
  return p;
}

Point2 Deformation::inverse(const Point2& p_target) const {
  const auto hit = mesh_->in_target.find(p_target);
  if (!hit) return mesh_->similarity.inverse() * p_target;
  Point2 p = Point2::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    p += hit->shares[static_cast<int>(k)] *
         mesh_->source[static_cast<std::size_t>(mesh_->triangles[static_cast<std::size_t>(hit->triangle)][k])];
  return p;
}

double Deformation::sigma_m(const Point2& p_source) const {
  const auto hit = mesh_->in_source.find(p_source);
  if (!hit) return mesh_->sigma_m.empty() ? 0 : mesh_->sigma_m.front();
  double sigma = 0;
  for (std::size_t k = 0; k < 3; ++k)
    sigma += std::max(0.0, hit->shares[static_cast<int>(k)]) *
             mesh_->sigma_m[static_cast<std::size_t>(mesh_->triangles[static_cast<std::size_t>(hit->triangle)][k])];
  return sigma;
}

double Deformation::local_scale(const Point2& p_source) const {
  const auto hit = mesh_->in_source.find(p_source);
  if (!hit) return 1;
  const TriangleIndices& t = mesh_->triangles[static_cast<std::size_t>(hit->triangle)];
  const double before = twice_area(mesh_->source, t), after = twice_area(mesh_->target, t);
  if (before <= 0 || after <= 0) return 1;
  return std::sqrt(after / before) / mesh_->similarity.scale;
}

const Similarity2& Deformation::similarity() const { return mesh_->similarity; }
bool Deformation::folded() const { return mesh_->folded; }
const std::vector<Point2>& Deformation::mesh_source() const { return mesh_->source; }
const std::vector<Point2>& Deformation::mesh_target() const { return mesh_->target; }
const std::vector<std::array<int, 3>>& Deformation::mesh_triangles() const { return mesh_->triangles; }

}  // namespace smokemap
