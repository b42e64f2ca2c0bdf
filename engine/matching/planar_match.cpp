#include "matching/planar_match.hpp"

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <limits>
#include <set>

namespace smokemap {
namespace {

using VertexPair = std::pair<int, int>;

/// One hypothesis: pairs spread from a seed through the neighbourhoods.
class Spread {
 public:
  Spread(const PlanarGraph& a, const PlanarGraph& b, const Eigen::MatrixXi& alike)
      : a_(a), b_(b), alike_(alike), of_a_(a.around.size(), -1), of_b_(b.around.size(), -1) {}

  std::vector<VertexPair> from(const VertexPair& seed) {
    take(seed);
    while (!queue_.empty()) {
      const VertexPair here = queue_.front();
      queue_.pop_front();
      compare(here);
    }
    std::sort(pairs_.begin(), pairs_.end());
    return pairs_;
  }

 private:
  void take(const VertexPair& pair) {
    int &to = of_a_[static_cast<size_t>(pair.first)], &back = of_b_[static_cast<size_t>(pair.second)];
    if (to >= 0 || back >= 0) return;
    to = pair.second, back = pair.first;
    pairs_.push_back(pair), queue_.push_back(pair);
  }

  void compare(const VertexPair& here) {
    const std::vector<int>& around_a = a_.around[static_cast<size_t>(here.first)];
    const std::vector<int>& around_b = b_.around[static_cast<size_t>(here.second)];
    std::vector<std::pair<size_t, size_t>> fixed;  // places in the two rings that are matched already
    for (size_t x = 0; x < around_a.size(); ++x) {
      const int partner = of_a_[static_cast<size_t>(around_a[x])];
      const auto y = std::find(around_b.begin(), around_b.end(), partner);
      if (partner >= 0 && y != around_b.end()) fixed.emplace_back(x, static_cast<size_t>(y - around_b.begin()));
    }
    if (fixed.empty()) return align_rings(around_a, around_b);
    for (size_t k = 0; k < fixed.size(); ++k) {
      const auto& [from_x, from_y] = fixed[k];
      const auto& [to_x, to_y] = fixed[(k + 1) % fixed.size()];
      align(between(around_a, from_x, to_x), between(around_b, from_y, to_y));
    }
  }

  /// The part of a ring after place `from` and before place `to`.
  static std::vector<int> between(const std::vector<int>& ring, size_t from, size_t to) {
    std::vector<int> part;
    for (size_t x = (from + 1) % ring.size(); x != to; x = (x + 1) % ring.size()) {
      if (x == from) break;
      part.push_back(ring[x]);
    }
    return part;
  }

  void align_rings(const std::vector<int>& ring_a, const std::vector<int>& ring_b) {
    int least = std::numeric_limits<int>::max();
    std::vector<int> best = ring_a, turned = ring_a;
    for (size_t turn = 0; turn < ring_a.size(); ++turn) {
      if (const int cost = edit_script(likes(turned, ring_b)).first; cost < least) least = cost, best = turned;
      std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    }
    align(best, ring_b);
  }

  void align(const std::vector<int>& part_a, const std::vector<int>& part_b) {
    for (const auto& [x, y] : edit_script(likes(part_a, part_b)).second)
      take({part_a[static_cast<size_t>(x)], part_b[static_cast<size_t>(y)]});
  }

  Eigen::MatrixXi likes(const std::vector<int>& part_a, const std::vector<int>& part_b) const {
    Eigen::MatrixXi result(part_a.size(), part_b.size());
    for (Eigen::Index x = 0; x < result.rows(); ++x)
      for (Eigen::Index y = 0; y < result.cols(); ++y)
        result(x, y) = alike_(part_a[static_cast<size_t>(x)], part_b[static_cast<size_t>(y)]);
    return result;
  }

  const PlanarGraph &a_, &b_;
  const Eigen::MatrixXi& alike_;
  std::vector<int> of_a_, of_b_;
  std::vector<VertexPair> pairs_;
  std::deque<VertexPair> queue_;
};

/// Edges between vertices that keep a partner; both directions of an edge are in the rings.
int edges_kept(const PlanarGraph& graph, const std::set<int>& kept) {
  int count = 0;
  for (const int v : kept)
    for (const int w : graph.around[static_cast<size_t>(v)]) count += kept.contains(w) && v < w;
  return count;
}

int edit_distance(const PlanarGraph& a, const PlanarGraph& b, const std::vector<VertexPair>& pairs) {
  std::set<int> kept_a, kept_b;
  for (const auto& [v, w] : pairs) kept_a.insert(v), kept_b.insert(w);
  const int edges_a = edges_kept(a, kept_a), edges_b = edges_kept(b, kept_b);
  const int vertices = a.size() + b.size() - 2 * static_cast<int>(pairs.size());
  return vertices + (a.edges() - edges_a) + (b.edges() - edges_b) + std::abs(edges_a - edges_b);
}

}  // namespace

int PlanarGraph::edges() const {
  int count = 0;
  for (int v = 0; v < size(); ++v)
    for (const int w : around[static_cast<size_t>(v)]) count += v < w;
  return count;
}

std::pair<int, std::vector<std::pair<int, int>>> edit_script(const Eigen::MatrixXi& alike) {
  const Eigen::Index n = alike.rows(), m = alike.cols();
  Eigen::MatrixXi cost(n + 1, m + 1);
  for (Eigen::Index x = 0; x <= n; ++x)
    for (Eigen::Index y = 0; y <= m; ++y) {
      if (x == 0 || y == 0) {
        cost(x, y) = static_cast<int>(x + y);
        continue;
      }
      const int against = cost(x - 1, y - 1) + (alike(x - 1, y - 1) ? 0 : 1);
      cost(x, y) = std::min(against, 1 + std::min(cost(x - 1, y), cost(x, y - 1)));
    }
  std::vector<std::pair<int, int>> pairs;
  for (Eigen::Index x = n, y = m; x > 0 && y > 0;) {
    if (cost(x, y) == cost(x - 1, y - 1) + (alike(x - 1, y - 1) ? 0 : 1))
      --x, --y, pairs.emplace_back(static_cast<int>(x), static_cast<int>(y));
    else if (cost(x, y) == cost(x - 1, y) + 1)
      --x;
    else
      --y;
  }
  std::reverse(pairs.begin(), pairs.end());
  return {cost(n, m), pairs};
}

PlanarMatch match_planar(const PlanarGraph& a, const PlanarGraph& b, const Eigen::MatrixXi& alike) {
  PlanarMatch best;
  best.edit_distance = edit_distance(a, b, {});
  std::set<VertexPair> used;
  for (int v = 0; v < a.size(); ++v)
    for (int w = 0; w < b.size(); ++w) {
      if (!alike(v, w) || used.contains({v, w})) continue;
      const std::vector<VertexPair> pairs = Spread(a, b, alike).from({v, w});
      used.insert(pairs.begin(), pairs.end());
      if (const int distance = edit_distance(a, b, pairs); distance < best.edit_distance) best = {pairs, distance};
    }
  return best;
}

}  // namespace smokemap
