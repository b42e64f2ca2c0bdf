#include "topology/voronoi_graph.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "core/check.hpp"
#include "topology/graph_trace.hpp"
#include "topology/thinning.hpp"
#include "topology/trimming.hpp"
#include "topology/walkable.hpp"

namespace smokemap {
namespace {

constexpr size_t kMostPixels = size_t{64} << 20;

/// Heading in which an edge leaves a node, seen some pixels on.
double leaving_angle(const VoronoiGraph& graph, int edge, int node, bool at_end) {
  const std::vector<Point2>& path = graph.edges[static_cast<size_t>(edge)].path_px;
  const size_t ahead = std::min<size_t>(path.size() - 1, 8);
  const Point2 d = (at_end ? path[path.size() - 1 - ahead] : path[ahead]) - graph.nodes[static_cast<size_t>(node)].p_px;
  return std::atan2(-d.y(), d.x());  // y down: this is counter-clockwise as seen
}

void name_nodes(VoronoiGraph& graph) {
  std::vector<std::vector<std::pair<double, int>>> leaving(graph.nodes.size());
  std::vector<int> degree(graph.nodes.size(), 0);
  for (size_t e = 0; e < graph.edges.size(); ++e) {
    const VoronoiEdge& edge = graph.edges[e];
    const auto from = static_cast<size_t>(edge.from), to = static_cast<size_t>(edge.to);
    ++degree[from], ++degree[to];
    leaving[from].emplace_back(leaving_angle(graph, static_cast<int>(e), edge.from, false), static_cast<int>(e));
    if (from != to)
      leaving[to].emplace_back(leaving_angle(graph, static_cast<int>(e), edge.to, true), static_cast<int>(e));
  }
  for (size_t n = 0; n < graph.nodes.size(); ++n) {
    VoronoiNode& node = graph.nodes[n];
    std::sort(leaving[n].begin(), leaving[n].end());
    for (const auto& [angle, edge] : leaving[n]) node.edges.push_back(edge);
    node.kind = degree[n] == 0                             ? VoronoiNodeKind::kIsolated
                : degree[n] == 1                           ? VoronoiNodeKind::kDeadEnd
                : degree[n] == 2 && leaving[n].size() == 1 ? VoronoiNodeKind::kLoop
                                                           : VoronoiNodeKind::kJunction;
  }
}

cv::Point2d cv_point(const Point2& p) { return {p.x(), p.y()}; }

}  // namespace

Result<Ok> VoronoiParams::validate() const {
  return ParamCheck("VoronoiParams")
      .in_range("trim_ratio", trim_ratio, 0, 100)
      .in_range("merge_ratio", merge_ratio, 0, 1)
      .in_range("clutter_ratio", clutter_ratio, 0, 10)
      .in_range("narrow_ratio", narrow_ratio, 0, 1)
      .in_range("part_ratio", part_ratio, 0, 1)
      .in_range("min_clearance_px", min_clearance_px, 0, 1000)
      .result();
}

Result<VoronoiGraph> voronoi_graph(const cv::Mat& free_space, const VoronoiParams& params) {
  if (const Result<Ok> valid = params.validate(); !valid) return valid.error();
  if (free_space.empty() || free_space.type() != CV_8UC1)
    return fail(Errc::kInvalidArgument, "topology needs an 8 bit picture of free space with one channel");
  if (free_space.total() > kMostPixels)
    return fail(Errc::kTooLarge, "the map has more than 64 megapixels: reduce it first");
  const cv::Mat clearance = walkable_clearance(free_space, params);
  const cv::Mat line = thin_by_clearance(clearance);
  if (cv::countNonZero(line) == 0) return fail(Errc::kDegenerate, "the map has no free space to walk through");
  VoronoiGraph graph = trim(trace_lines(line, clearance), clearance, params);
  name_nodes(graph);
  return graph;
}

cv::Mat draw_voronoi_graph(const VoronoiGraph& graph, const cv::Mat& free_space) {
  cv::Mat canvas(free_space.size(), CV_8UC3, cv::Scalar(58, 52, 48));
  canvas.setTo(cv::Scalar(236, 236, 236), free_space == 255);
  const int pen = std::max(2, std::max(canvas.rows, canvas.cols) / 500);
  double widest = 1;
  for (const VoronoiNode& node : graph.nodes) widest = std::max(widest, node.clearance_px);
  for (const VoronoiEdge& edge : graph.edges)
    for (size_t i = 1; i < edge.path_px.size(); ++i) {
      const double share = std::min(1.0, edge.mean_clearance_px / widest);
      cv::line(canvas, cv_point(edge.path_px[i - 1]), cv_point(edge.path_px[i]),
               cv::Scalar(200 - 150 * share, 110, 60 + 150 * share), pen, cv::LINE_AA);
    }
  for (const VoronoiNode& node : graph.nodes) {
    const bool is_end = node.kind == VoronoiNodeKind::kDeadEnd;
    cv::circle(canvas, cv_point(node.p_px), is_end ? 2 * pen : 5 * pen / 2,
               is_end ? cv::Scalar(70, 70, 220) : cv::Scalar(60, 150, 40), cv::FILLED, cv::LINE_AA);
  }
  return canvas;
}

}  // namespace smokemap
