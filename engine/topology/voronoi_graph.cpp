#include "topology/voronoi_graph.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <tuple>

#include "core/check.hpp"
#include "topology/graph_trace.hpp"
#include "topology/thinning.hpp"

namespace smokemap {
namespace {

/// A graph that loses branches; edges and nodes that are gone stay in place, marked.
class Trimmer {
 public:
  Trimmer(VoronoiGraph graph, const cv::Mat& clearance, double trim_ratio)
      : graph_(std::move(graph)),
        clearance_(clearance),
        trim_ratio_(trim_ratio),
        node_is_there_(graph_.nodes.size(), true),
        edge_is_there_(graph_.edges.size(), true) {}

  VoronoiGraph run() {
    while (const std::optional<size_t> branch = shortest_twig()) cut(*branch);
    for (size_t n = 0; n < graph_.nodes.size(); ++n) join_if_passing(static_cast<int>(n));
    return compact();
  }

 private:
  std::vector<size_t> edges_at(int node) const {
    std::vector<size_t> found;
    for (size_t e = 0; e < graph_.edges.size(); ++e) {
      if (!edge_is_there_[e]) continue;
      if (graph_.edges[e].from == node) found.push_back(e);
      if (graph_.edges[e].to == node) found.push_back(e);
    }
    return found;
  }

  const VoronoiNode& node(int index) const { return graph_.nodes[static_cast<size_t>(index)]; }

  /// How far a dead end sticks out of the disc of the junction it hangs on, in radii of that disc.
  double protrusion(const VoronoiEdge& edge, int tip, int base) const {
    const double reach = (node(tip).p_px - node(base).p_px).norm() + node(tip).clearance_px;
    const double along = edge.length_px + node(tip).clearance_px;
    return (std::max(reach, 0.8 * along) - node(base).clearance_px) / std::max(1.0, node(base).clearance_px);
  }

  std::optional<size_t> shortest_twig() const {
    std::vector<int> degree(graph_.nodes.size(), 0);
    for (size_t e = 0; e < graph_.edges.size(); ++e)
      if (edge_is_there_[e])
        ++degree[static_cast<size_t>(graph_.edges[e].from)], ++degree[static_cast<size_t>(graph_.edges[e].to)];
    std::optional<size_t> best;
    double least = trim_ratio_;
    for (size_t e = 0; e < graph_.edges.size(); ++e) {
      if (!edge_is_there_[e]) continue;
      const VoronoiEdge& edge = graph_.edges[e];
      const int from = degree[static_cast<size_t>(edge.from)], to = degree[static_cast<size_t>(edge.to)];
      if (edge.from == edge.to || std::min(from, to) != 1) continue;
      // Of a lone line both ends are tips: it goes as a whole into its wider end if it is short.
      const bool from_is_tip = from == 1 && (to != 1 || node(edge.from).clearance_px < node(edge.to).clearance_px);
      const double out = protrusion(edge, from_is_tip ? edge.from : edge.to, from_is_tip ? edge.to : edge.from);
      if (out < least) least = out, best = e;
    }
    return best;
  }

  void cut(size_t e) {
    const VoronoiEdge edge = graph_.edges[e];
    const bool from_is_tip =
        edges_at(edge.from).size() == 1 &&
        (edges_at(edge.to).size() != 1 || node(edge.from).clearance_px < node(edge.to).clearance_px);
    edge_is_there_[e] = false;
    node_is_there_[static_cast<size_t>(from_is_tip ? edge.from : edge.to)] = false;
    join_if_passing(from_is_tip ? edge.to : edge.from);
  }

  /// A junction that has lost all but two ways becomes part of one way.
  void join_if_passing(int index) {
    if (!node_is_there_[static_cast<size_t>(index)]) return;
    const std::vector<size_t> ways = edges_at(index);
    if (ways.size() != 2 || ways[0] == ways[1]) return;
    VoronoiEdge one = graph_.edges[ways[0]], two = graph_.edges[ways[1]];
    if (one.to != index) std::swap(one.from, one.to), std::reverse(one.path_px.begin(), one.path_px.end());
    if (two.from != index) std::swap(two.from, two.to), std::reverse(two.path_px.begin(), two.path_px.end());
    one.to = two.to;
    one.path_px.insert(one.path_px.end(), two.path_px.begin() + 1, two.path_px.end());
    measure(one, clearance_);
    graph_.edges[ways[0]] = std::move(one);
    edge_is_there_[ways[1]] = false;
    node_is_there_[static_cast<size_t>(index)] = false;
  }

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
      index_of[static_cast<size_t>(old)] = static_cast<int>(result.nodes.size());
      result.nodes.push_back(node(old));
    }
    for (size_t e = 0; e < graph_.edges.size(); ++e) {
      if (!edge_is_there_[e]) continue;
      VoronoiEdge edge = graph_.edges[e];
      edge.from = index_of[static_cast<size_t>(edge.from)];
      edge.to = index_of[static_cast<size_t>(edge.to)];
      if (edge.from > edge.to) std::swap(edge.from, edge.to), std::reverse(edge.path_px.begin(), edge.path_px.end());
      result.edges.push_back(std::move(edge));
    }
    std::stable_sort(result.edges.begin(), result.edges.end(), [](const VoronoiEdge& one, const VoronoiEdge& two) {
      return std::tie(one.from, one.to, one.length_px) < std::tie(two.from, two.to, two.length_px);
    });
    return result;
  }

  VoronoiGraph graph_;
  const cv::Mat& clearance_;
  double trim_ratio_;
  std::vector<bool> node_is_there_, edge_is_there_;
};

/// Heading in which an edge leaves a node, seen some pixels on.
double leaving_angle(const VoronoiGraph& graph, int edge, int node, bool at_end) {
  const std::vector<Point2>& path = graph.edges[static_cast<size_t>(edge)].path_px;
  const size_t ahead = std::min<size_t>(path.size() - 1, 8);
  const Point2 d = (at_end ? path[path.size() - 1 - ahead] : path[ahead]) - graph.nodes[static_cast<size_t>(node)].p_px;
  return std::atan2(-d.y(), d.x());  // y down: this is counter-clockwise as seen
}

void name_nodes(VoronoiGraph& graph) {
  for (size_t n = 0; n < graph.nodes.size(); ++n) {
    VoronoiNode& node = graph.nodes[n];
    std::vector<std::pair<double, int>> leaving;
    int degree = 0;
    bool has_ring = false;
    for (size_t e = 0; e < graph.edges.size(); ++e) {
      const VoronoiEdge& edge = graph.edges[e];
      const bool starts = edge.from == static_cast<int>(n), ends = edge.to == static_cast<int>(n);
      if (!starts && !ends) continue;
      degree += starts + ends;
      has_ring |= starts && ends;
      leaving.emplace_back(leaving_angle(graph, static_cast<int>(e), static_cast<int>(n), !starts),
                           static_cast<int>(e));
    }
    std::sort(leaving.begin(), leaving.end());
    for (const auto& [angle, edge] : leaving) node.edges.push_back(edge);
    node.kind = degree == 0               ? VoronoiNodeKind::kIsolated
                : degree == 1             ? VoronoiNodeKind::kDeadEnd
                : degree == 2 && has_ring ? VoronoiNodeKind::kLoop
                                          : VoronoiNodeKind::kJunction;
  }
}

cv::Point2d cv_point(const Point2& p) { return {p.x(), p.y()}; }

}  // namespace

Result<Ok> VoronoiParams::validate() const {
  return ParamCheck("VoronoiParams")
      .in_range("trim_ratio", trim_ratio, 0, 100)
      .in_range("min_clearance_px", min_clearance_px, 0, 1000)
      .result();
}

Result<VoronoiGraph> voronoi_graph(const cv::Mat& free_space, const VoronoiParams& params) {
  if (const Result<Ok> valid = params.validate(); !valid) return valid.error();
  if (free_space.empty() || free_space.type() != CV_8UC1)
    return fail(Errc::kInvalidArgument, "topology needs an 8 bit picture of free space with one channel");
  const cv::Mat clearance = free_clearance(free_space);
  const cv::Mat line = thin_by_clearance(clearance, params.min_clearance_px);
  if (cv::countNonZero(line) == 0) return fail(Errc::kDegenerate, "the map has no free space to walk through");
  VoronoiGraph graph = Trimmer(trace_lines(line, clearance), clearance, params.trim_ratio).run();
  name_nodes(graph);
  return graph;
}

cv::Mat draw_voronoi_graph(const VoronoiGraph& graph, const cv::Mat& free_space) {
  cv::Mat canvas(free_space.size(), CV_8UC3, cv::Scalar(58, 52, 48));
  canvas.setTo(cv::Scalar(236, 236, 236), free_space == 255);
  double widest = 1;
  for (const VoronoiNode& node : graph.nodes) widest = std::max(widest, node.clearance_px);
  for (const VoronoiEdge& edge : graph.edges)
    for (size_t i = 1; i < edge.path_px.size(); ++i) {
      const double share = std::min(1.0, edge.mean_clearance_px / widest);
      cv::line(canvas, cv_point(edge.path_px[i - 1]), cv_point(edge.path_px[i]),
               cv::Scalar(200 - 150 * share, 110, 60 + 150 * share), 2, cv::LINE_AA);
    }
  for (const VoronoiNode& node : graph.nodes) {
    const bool is_end = node.kind == VoronoiNodeKind::kDeadEnd;
    cv::circle(canvas, cv_point(node.p_px), is_end ? 4 : 5, is_end ? cv::Scalar(70, 70, 220) : cv::Scalar(60, 150, 40),
               cv::FILLED, cv::LINE_AA);
  }
  return canvas;
}

}  // namespace smokemap
