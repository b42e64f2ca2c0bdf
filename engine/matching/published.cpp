#include "matching/published.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "matching/assignment.hpp"
#include "matching/planar_match.hpp"
#include "matching/region_graph.hpp"
#include "topology/voronoi_graph.hpp"

namespace smokemap {
namespace {

constexpr double kUnknownConfidence = 0.5;
constexpr int kHeatTimes = 16;
constexpr double kHeatStep = 0.2;

Eigen::VectorXd standardised(const Eigen::VectorXd& values) {
  const Eigen::VectorXd centred = values.array() - values.mean();
  const double spread =
      std::sqrt(centred.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, values.size())));
  return spread > 1e-12 ? Eigen::VectorXd(centred / spread) : Eigen::VectorXd::Zero(values.size());
}

/// 1 - ratio of the eigenvalues of a region's second moments.
Eigen::VectorXd elongations(const Segmentation& map) {
  const auto n = static_cast<Eigen::Index>(map.regions.size());
  std::vector<Eigen::Matrix2d> moments(map.regions.size(), Eigen::Matrix2d::Zero());
  for (int y = 0; y < map.labels.rows; ++y)
    for (int x = 0; x < map.labels.cols; ++x)
      if (const int label = map.labels.at<unsigned short>(y, x); label != 0) {
        const Point2 away = Point2(x, y) - map.regions[static_cast<size_t>(label - 1)].centroid_px;
        moments[static_cast<size_t>(label - 1)] += away * away.transpose();
      }
  Eigen::VectorXd result(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d axes =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(moments[static_cast<size_t>(i)]).eigenvalues();
    result(i) = axes(1) > 1e-9 ? 1 - std::max(0.0, axes(0)) / axes(1) : 0;
  }
  return result;
}

/// Neighbours in the order of their directions.
PlanarGraph planar_graph(const RegionGraph& regions) {
  PlanarGraph graph{regions.beside};
  for (size_t i = 0; i < graph.around.size(); ++i) {
    const auto direction = [&](int k) {
      const Point2 way = regions.middles_px[static_cast<size_t>(k)] - regions.middles_px[i];
      return std::atan2(way.y(), way.x());
    };
    std::stable_sort(graph.around[i].begin(), graph.around[i].end(),
                     [&](int one, int two) { return direction(one) < direction(two); });
  }
  return graph;
}

/// Anchor pairs: unique regions assigned at least cost, cheapest first.
std::vector<std::pair<int, int>> anchor_pairs(const UrsimRegions& a, const UrsimRegions& b) {
  Eigen::MatrixXd gain(a.unique.size(), b.unique.size());
  for (Eigen::Index x = 0; x < gain.rows(); ++x)
    for (Eigen::Index y = 0; y < gain.cols(); ++y) {
      const int i = a.unique[static_cast<size_t>(x)], j = b.unique[static_cast<size_t>(y)];
      const double cost = (std::abs(a.size(i) - b.size(j)) + std::abs(a.elongation(i) - b.elongation(j))) / 2;
      gain(x, y) = 1.01 - std::min(1.0, cost);  // never zero: the smaller side is paired wholly
    }
  std::vector<std::pair<int, int>> pairs;
  const std::vector<int> partner = best_assignment(gain);
  for (size_t x = 0; x < partner.size(); ++x)
    if (partner[x] >= 0) pairs.emplace_back(a.unique[x], b.unique[static_cast<size_t>(partner[x])]);
  return pairs;
}

PlanarGraph planar_graph(const VoronoiGraph& voronoi) {
  PlanarGraph graph;
  for (size_t v = 0; v < voronoi.nodes.size(); ++v) {
    auto& around = graph.around.emplace_back();
    for (const int e : voronoi.nodes[v].edges) {
      const VoronoiEdge& edge = voronoi.edges[static_cast<size_t>(e)];
      const int other = edge.from == static_cast<int>(v) ? edge.to : edge.from;
      const bool known = std::find(around.begin(), around.end(), other) != around.end();
      if (other != static_cast<int>(v) && !known) around.push_back(other);
    }
  }
  return graph;
}

int label_at_node(const Segmentation& map, const VoronoiNode& node) {
  const int x = std::clamp(static_cast<int>(std::lround(node.p_px.x())), 0, map.labels.cols - 1);
  const int y = std::clamp(static_cast<int>(std::lround(node.p_px.y())), 0, map.labels.rows - 1);
  return map.labels.at<unsigned short>(y, x);
}

}  // namespace

UrsimRegions ursim_regions(const Segmentation& map, const UrsimParams& params) {
  const auto n = static_cast<Eigen::Index>(map.regions.size());
  Eigen::VectorXd areas(n);
  for (Eigen::Index i = 0; i < n; ++i) areas(i) = map.regions[static_cast<size_t>(i)].area_px;
  UrsimRegions result;
  result.size = standardised(areas);
  result.elongation = elongations(map);
  result.standard_elongation = standardised(result.elongation);
  for (int i = 0; i < n; ++i)
    if (std::abs(result.size(i)) >= params.unique_from || std::abs(result.standard_elongation(i)) >= params.unique_from)
      result.unique.push_back(i);
  return result;
}

Eigen::MatrixXd anchor_heat(const Segmentation& map, const std::vector<int>& anchors) {
  const RegionGraph graph = make_region_graph(map);
  const int n = graph.size();
  const Eigen::VectorXd weight = graph.area;
  Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i)
    for (const int k : graph.beside[static_cast<size_t>(i)]) {
      laplacian(i, i) += weight(k);
      laplacian(i, k) = -std::sqrt(weight(i) * weight(k));
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(laplacian);
  Eigen::MatrixXd heat = Eigen::MatrixXd::Zero(n, kHeatTimes);
  for (int k = 0; k < kHeatTimes; ++k) {
    const Eigen::VectorXd fade = (-kHeatStep * k * eigen.eigenvalues().array()).exp();
    const Eigen::MatrixXd kernel = eigen.eigenvectors() * fade.asDiagonal() * eigen.eigenvectors().transpose();
    for (const int anchor : anchors) heat.col(k) += kernel.col(anchor);
    if (anchors.empty()) heat.col(k) = kernel.diagonal();
  }
  return heat;
}

std::vector<RegionPair> match_ursim(const Segmentation& a, const Segmentation& b, const UrsimParams& params) {
  std::vector<int> anchors_a, anchors_b;
  for (const auto& [i, j] : anchor_pairs(ursim_regions(a, params), ursim_regions(b, params)))
    anchors_a.push_back(i), anchors_b.push_back(j);
  const Eigen::MatrixXd heat_a = anchor_heat(a, anchors_a), heat_b = anchor_heat(b, anchors_b);
  Eigen::MatrixXi alike(heat_a.rows(), heat_b.rows());
  for (Eigen::Index i = 0; i < alike.rows(); ++i)
    for (Eigen::Index j = 0; j < alike.cols(); ++j)
      alike(i, j) = (heat_a.row(i) - heat_b.row(j)).cwiseAbs().mean() <= params.threshold;
  const PlanarMatch match = match_planar(planar_graph(make_region_graph(a)), planar_graph(make_region_graph(b)), alike);
  std::vector<RegionPair> pairs;
  for (const auto& [i, j] : match.pairs) pairs.push_back({i + 1, j + 1, kUnknownConfidence, Verdict::kProposed});
  return pairs;
}

std::vector<RegionPair> match_voronoi(const Segmentation& a, const Segmentation& b) {
  const auto voronoi_a = voronoi_graph(a.labels != 0), voronoi_b = voronoi_graph(b.labels != 0);
  if (!voronoi_a || !voronoi_b) return {};
  Eigen::MatrixXi alike(voronoi_a->nodes.size(), voronoi_b->nodes.size());
  for (Eigen::Index v = 0; v < alike.rows(); ++v)
    for (Eigen::Index w = 0; w < alike.cols(); ++w)
      alike(v, w) = voronoi_a->nodes[static_cast<size_t>(v)].kind == voronoi_b->nodes[static_cast<size_t>(w)].kind;
  const PlanarMatch match = match_planar(planar_graph(*voronoi_a), planar_graph(*voronoi_b), alike);
  std::map<std::pair<int, int>, int> votes;
  for (const auto& [v, w] : match.pairs)
    ++votes[{label_at_node(a, voronoi_a->nodes[static_cast<size_t>(v)]),
             label_at_node(b, voronoi_b->nodes[static_cast<size_t>(w)])}];
  std::map<int, std::pair<int, int>> best;  // of each region of a: votes, region of b
  for (const auto& [labels, count] : votes)
    if (labels.first != 0 && labels.second != 0 && count > best[labels.first].first)
      best[labels.first] = {count, labels.second};
  std::vector<RegionPair> pairs;
  for (const auto& [label, winner] : best)
    if (winner.first > 0) pairs.push_back({label, winner.second, kUnknownConfidence, Verdict::kProposed});
  return pairs;
}

}  // namespace smokemap
