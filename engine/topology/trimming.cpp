#include "topology/trimming.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "topology/graph_trace.hpp"

namespace smokemap {
namespace {

constexpr double kCornerSlope = 0.4;   ///< clearance falls faster than this, per pixel of way, into a corner
constexpr double kPinch = 0.7;         ///< a place narrower than this share of what was passed is a door
constexpr double kStraightWays = 0.8;  ///< a winding branch counts by this share of its length

/// A graph that loses branches; edges and nodes that are gone stay in place, marked.
class Trimmer {
 public:
  Trimmer(VoronoiGraph graph, const cv::Mat& clearance, const VoronoiParams& params)
      : graph_(std::move(graph)),
        clearance_(clearance),
        params_(params),
        node_is_there_(graph_.nodes.size(), true),
        edge_is_there_(graph_.edges.size(), true),
        edges_at_(graph_.nodes.size()) {
    for (size_t e = 0; e < graph_.edges.size(); ++e) {
      edges_at_[index(graph_.edges[e].from)].push_back(e);
      edges_at_[index(graph_.edges[e].to)].push_back(e);
    }
  }

  VoronoiGraph run() {
    for (size_t n = 0; n < graph_.nodes.size(); ++n) leave_corner(static_cast<int>(n));
    cut_twigs();
    contract_junctions();
    cut_twigs();  // short beside the wider junction that they hang on now
    return compact();
  }

 private:
  static size_t index(int node) { return static_cast<size_t>(node); }
  VoronoiNode& node(int n) { return graph_.nodes[index(n)]; }
  const VoronoiNode& node(int n) const { return graph_.nodes[index(n)]; }
  size_t degree(int n) const { return edges_at_[index(n)].size(); }
  double clearance_at(const Point2& p) const {
    return clearance_.at<float>(static_cast<int>(p.y()), static_cast<int>(p.x()));
  }

  void turn_round(VoronoiEdge& edge) {
    std::swap(edge.from, edge.to);
    std::reverse(edge.path_px.begin(), edge.path_px.end());
  }

  void detach(size_t e, int n) {
    std::vector<size_t>& edges = edges_at_[index(n)];
    edges.erase(std::find(edges.begin(), edges.end(), e));
  }

  /// A dead end in a corner moves back to where the clearance no longer rises, but not through a door: it goes where
  /// the clearance is most above a line that rises more slowly than into corners, as noise would stop a climb.
  void leave_corner(int tip) {
    if (degree(tip) != 1) return;
    VoronoiEdge& edge = graph_.edges[edges_at_[index(tip)].front()];
    if (edge.from == edge.to) return;
    if (edge.from != tip) turn_round(edge);
    const std::vector<Point2>& path = edge.path_px;
    size_t best = 0;
    double way = 0, most = clearance_at(path[0]), widest = most;
    for (size_t i = 1; i < path.size(); ++i) {
      way += (path[i] - path[i - 1]).norm();
      const double own = clearance_at(path[i]);
      widest = std::max(widest, own);
      if (own < kPinch * widest - 1) break;
      if (own - kCornerSlope * way > most) most = own - kCornerSlope * way, best = i;
    }
    if (best == 0) return;
    node(tip).p_px = path[best];
    node(tip).clearance_px = clearance_at(path[best]);
    edge.path_px.erase(edge.path_px.begin(), edge.path_px.begin() + static_cast<std::ptrdiff_t>(best));
    measure(edge, clearance_);
  }

  /// The end of a twig that would go; of a lone line the narrower one. -1 for what is no twig.
  int tip_of(const VoronoiEdge& edge) const {
    if (edge.from == edge.to || std::min(degree(edge.from), degree(edge.to)) != 1) return -1;
    const bool from_is_tip =
        degree(edge.from) == 1 && (degree(edge.to) != 1 || node(edge.from).clearance_px < node(edge.to).clearance_px);
    return from_is_tip ? edge.from : edge.to;
  }

  /// How far a dead end sticks out of the disc of the junction it hangs on, in radii of that disc.
  double protrusion(const VoronoiEdge& edge, int tip) const {
    const VoronoiNode &end = node(tip), &base = node(edge.from == tip ? edge.to : edge.from);
    const double reach = (end.p_px - base.p_px).norm() + end.clearance_px;
    const double along = edge.length_px + end.clearance_px;
    return (std::max(reach, kStraightWays * along) - base.clearance_px) / std::max(1.0, base.clearance_px);
  }

  /// Least protruding twigs first, since what they leave behind may be a twig, too.
  void cut_twigs() {
    using Entry = std::pair<double, size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    const auto consider = [&](size_t e) {
      const int tip = tip_of(graph_.edges[e]);
      if (tip < 0) return;
      const double out = protrusion(graph_.edges[e], tip);
      if (out < params_.trim_ratio) queue.emplace(out, e);
    };
    for (size_t e = 0; e < graph_.edges.size(); ++e)
      if (edge_is_there_[e]) consider(e);
    while (!queue.empty()) {
      const auto [out, e] = queue.top();
      queue.pop();
      if (!edge_is_there_[e]) continue;
      const int tip = tip_of(graph_.edges[e]);
      if (tip < 0 || protrusion(graph_.edges[e], tip) != out) continue;  // it changed and was entered again if short
      const int base = graph_.edges[e].from == tip ? graph_.edges[e].to : graph_.edges[e].from;
      edge_is_there_[e] = false;
      node_is_there_[index(tip)] = false;
      detach(e, tip), detach(e, base);
      const std::vector<size_t> ways = edges_at_[index(base)];
      join_if_passing(base);
      for (const size_t way : ways)
        if (edge_is_there_[way]) consider(way);
    }
    for (size_t n = 0; n < graph_.nodes.size(); ++n) join_if_passing(static_cast<int>(n));
  }

  /// A junction that has lost all but two ways becomes part of one way.
  void join_if_passing(int passed) {
    if (!node_is_there_[index(passed)] || degree(passed) != 2) return;
    const size_t kept = edges_at_[index(passed)][0], gone = edges_at_[index(passed)][1];
    if (kept == gone) return;
    VoronoiEdge &one = graph_.edges[kept], &two = graph_.edges[gone];
    if (one.to != passed) turn_round(one);
    if (two.from != passed) turn_round(two);
    one.path_px.insert(one.path_px.end(), two.path_px.begin() + 1, two.path_px.end());
    one.to = two.to;
    detach(gone, two.to);
    edges_at_[index(two.to)].push_back(kept);
    edges_at_[index(passed)].clear();
    node_is_there_[index(passed)] = false;
    edge_is_there_[gone] = false;
    measure(one, clearance_);
  }

  /// Junctions within each other's discs are one place: the wider one takes over the ways of the other.
  void contract_junctions() {
    std::vector<std::pair<double, size_t>> shortest;
    for (size_t e = 0; e < graph_.edges.size(); ++e)
      if (edge_is_there_[e]) shortest.emplace_back(graph_.edges[e].length_px, e);
    std::sort(shortest.begin(), shortest.end());
    for (const auto& [length, e] : shortest) {
      VoronoiEdge& bridge = graph_.edges[e];
      if (bridge.from == bridge.to || std::min(degree(bridge.from), degree(bridge.to)) < 3) continue;
      const double narrower = std::min(node(bridge.from).clearance_px, node(bridge.to).clearance_px);
      if (bridge.length_px > params_.merge_ratio * narrower) continue;
      if (node(bridge.from).clearance_px < node(bridge.to).clearance_px) turn_round(bridge);
      move_ways(e, bridge.to, bridge.from);
    }
  }

  /// Ways of `gone` lead on over `bridge` (which goes from `kept` to `gone`).
  void move_ways(size_t bridge_index, int gone, int kept) {
    const std::vector<Point2> bridge = graph_.edges[bridge_index].path_px;
    edge_is_there_[bridge_index] = false;
    node_is_there_[index(gone)] = false;
    detach(bridge_index, gone), detach(bridge_index, kept);
    const std::vector<size_t> ways = std::exchange(edges_at_[index(gone)], {});
    for (const size_t way : ways) {  // a ring is listed, and moved, twice
      VoronoiEdge& edge = graph_.edges[way];
      if (edge.from != gone) turn_round(edge);
      edge.path_px.insert(edge.path_px.begin(), bridge.begin(), bridge.end() - 1);
      edge.from = kept;
      edges_at_[index(kept)].push_back(way);
      measure(edge, clearance_);
    }
  }

  /// Numbers what is left by row, then column.
  VoronoiGraph compact() {
    std::vector<int> order;
    for (size_t n = 0; n < graph_.nodes.size(); ++n)
      if (node_is_there_[n]) order.push_back(static_cast<int>(n));
    std::sort(order.begin(), order.end(), [&](int one, int two) {
      const Point2 &p = node(one).p_px, &q = node(two).p_px;
      return std::make_pair(p.y(), p.x()) < std::make_pair(q.y(), q.x());
    });
    VoronoiGraph result;
    std::vector<int> index_of(graph_.nodes.size(), -1);
    for (const int old : order) {
      index_of[index(old)] = static_cast<int>(result.nodes.size());
      result.nodes.push_back(node(old));
    }
    for (size_t e = 0; e < graph_.edges.size(); ++e) {
      if (!edge_is_there_[e]) continue;
      VoronoiEdge edge = std::move(graph_.edges[e]);
      edge.from = index_of[index(edge.from)];
      edge.to = index_of[index(edge.to)];
      if (edge.from > edge.to) turn_round(edge);
      result.edges.push_back(std::move(edge));
    }
    std::stable_sort(result.edges.begin(), result.edges.end(), [](const VoronoiEdge& one, const VoronoiEdge& two) {
      return std::tie(one.from, one.to, one.length_px) < std::tie(two.from, two.to, two.length_px);
    });
    return result;
  }

  VoronoiGraph graph_;
  const cv::Mat& clearance_;
  const VoronoiParams& params_;
  std::vector<bool> node_is_there_, edge_is_there_;
  std::vector<std::vector<size_t>> edges_at_;  ///< a ring is listed twice
};

}  // namespace

VoronoiGraph trim(VoronoiGraph graph, const cv::Mat& clearance, const VoronoiParams& params) {
  return Trimmer(std::move(graph), clearance, params).run();
}

}  // namespace smokemap
