#include "matching/region_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace smokemap {
namespace {

constexpr double kNoWayDetour = 1.5;

void add_neighbours(const Segmentation& map, RegionGraph& graph) {
  for (const RegionBorder& border : map.borders) {
    graph.beside[static_cast<size_t>(border.label_a - 1)].push_back(border.label_b - 1);
    graph.beside[static_cast<size_t>(border.label_b - 1)].push_back(border.label_a - 1);
  }
  for (std::vector<int>& list : graph.beside) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

/// All shortest ways (Floyd and Warshall).
void add_ways(const Segmentation& map, RegionGraph& graph) {
  const int n = graph.size();
  const double infinite = std::numeric_limits<double>::infinity();
  graph.walk = Eigen::MatrixXd::Constant(n, n, infinite);
  graph.hops = Eigen::MatrixXi::Constant(n, n, n);
  for (int i = 0; i < n; ++i) graph.walk(i, i) = 0, graph.hops(i, i) = 0;
  for (const RegionBorder& border : map.borders) {
    const int i = border.label_a - 1, k = border.label_b - 1;
    const Point2 middle = border.line_px.midpoint();
    const double way = (map.regions[static_cast<size_t>(i)].anchor_px - middle).norm() +
                       (map.regions[static_cast<size_t>(k)].anchor_px - middle).norm();
    graph.walk(i, k) = graph.walk(k, i) = std::min(graph.walk(i, k), way);
    graph.hops(i, k) = graph.hops(k, i) = 1;
  }
  for (int via = 0; via < n; ++via)
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) {
        graph.walk(i, k) = std::min(graph.walk(i, k), graph.walk(i, via) + graph.walk(via, k));
        graph.hops(i, k) = std::min(graph.hops(i, k), graph.hops(i, via) + graph.hops(via, k));
      }
}

}  // namespace

RegionGraph make_region_graph(const Segmentation& map) {
  RegionGraph graph;
  graph.beside.resize(map.regions.size());
  add_neighbours(map, graph);
  add_ways(map, graph);
  const int n = graph.size();
  graph.area.resize(n);
  for (int i = 0; i < n; ++i) {
    const Region& region = map.regions[static_cast<size_t>(i)];
    graph.middles_px.push_back(region.centroid_px);
    graph.area(i) = region.area_px;
  }
  const double total = std::max(1.0, graph.area.sum());
  graph.side_px = std::sqrt(total);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const double straight =
          (map.regions[static_cast<size_t>(i)].anchor_px - map.regions[static_cast<size_t>(k)].anchor_px).norm();
      if (!std::isfinite(graph.walk(i, k))) graph.walk(i, k) = kNoWayDetour * straight;
    }
  graph.area /= total;
  const Eigen::VectorXd roots = graph.area.cwiseSqrt();
  graph.importance = (0.5 / std::max(1, n)) * Eigen::VectorXd::Ones(n) + 0.5 * roots / std::max(1e-9, roots.sum());
  return graph;
}

}  // namespace smokemap
