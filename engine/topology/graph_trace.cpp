#include "topology/graph_trace.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace smokemap {
namespace {

constexpr std::array<std::array<int, 2>, 8> kSteps = {
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};  ///< sides before corners

/// Walks lines of a picture in which every node pixel carries its node's number.
class Tracer {
 public:
  Tracer(const cv::Mat& line, const cv::Mat& clearance)
      : line_(line),
        clearance_(clearance),
        node_of_(line.size(), CV_32SC1, cv::Scalar(-1)),
        used_(line.size(), CV_8UC1, cv::Scalar(0)) {}

  VoronoiGraph run() {
    find_nodes();
    for (int y = 0; y < line_.rows; ++y)
      for (int x = 0; x < line_.cols; ++x)
        if (node_of_.at<int>(y, x) >= 0) leave_node({x, y});
    for (int y = 0; y < line_.rows; ++y)
      for (int x = 0; x < line_.cols; ++x)
        if (is_line({x, y}) && node_of_.at<int>(y, x) < 0 && !used_.at<unsigned char>(y, x)) trace_ring({x, y});
    return std::move(graph_);
  }

 private:
  bool is_line(const cv::Point& p) const {
    return p.x >= 0 && p.y >= 0 && p.x < line_.cols && p.y < line_.rows && line_.at<unsigned char>(p) != 0;
  }

  int count_around(const cv::Point& p) const {
    int count = 0;
    for (const auto& step : kSteps) count += is_line(p + cv::Point(step[0], step[1]));
    return count;
  }

  void add_node(const std::vector<cv::Point>& pixels) {
    VoronoiNode node;
    for (const cv::Point& p : pixels) {
      node_of_.at<int>(p) = static_cast<int>(graph_.nodes.size());
      if (clearance_.at<float>(p) <= node.clearance_px) continue;
      node.clearance_px = clearance_.at<float>(p);
      node.p_px = Point2(p.x, p.y);
    }
    graph_.nodes.push_back(node);
  }

  /// Touching pixels that do not have exactly two neighbours are one node.
  void find_nodes() {
    std::vector<cv::Point> stack, pixels;
    for (int y = 0; y < line_.rows; ++y)
      for (int x = 0; x < line_.cols; ++x) {
        const cv::Point seed(x, y);
        if (!is_line(seed) || node_of_.at<int>(seed) >= 0 || count_around(seed) == 2) continue;
        stack.assign(1, seed);
        pixels.clear();
        node_of_.at<int>(seed) = std::numeric_limits<int>::max();
        while (!stack.empty()) {
          const cv::Point p = stack.back();
          stack.pop_back();
          pixels.push_back(p);
          for (const auto& step : kSteps) {
            const cv::Point n = p + cv::Point(step[0], step[1]);
            if (!is_line(n) || node_of_.at<int>(n) >= 0 || count_around(n) == 2) continue;
            node_of_.at<int>(n) = std::numeric_limits<int>::max();
            stack.push_back(n);
          }
        }
        add_node(pixels);
      }
  }

  void leave_node(const cv::Point& from) {
    for (const auto& step : kSteps) {
      const cv::Point first = from + cv::Point(step[0], step[1]);
      if (is_line(first) && node_of_.at<int>(first) < 0 && !used_.at<unsigned char>(first))
        follow(node_of_.at<int>(from), first);
    }
  }

  void follow(int node, cv::Point at) {
    VoronoiEdge edge;
    edge.from = node;
    edge.to = -1;
    edge.path_px.push_back(graph_.nodes[static_cast<size_t>(node)].p_px);
    while (edge.to < 0) {
      used_.at<unsigned char>(at) = 1;
      edge.path_px.emplace_back(at.x, at.y);
      cv::Point next(-1, -1);
      for (const auto& step : kSteps) {
        const cv::Point n = at + cv::Point(step[0], step[1]);
        if (!is_line(n)) continue;
        const int there = node_of_.at<int>(n);
        if (there >= 0 && (there != node || edge.path_px.size() > 3)) edge.to = there;
        if (there < 0 && !used_.at<unsigned char>(n) && next.x < 0) next = n;
      }
      if (edge.to >= 0) break;
      if (next.x < 0) edge.to = node;  // a knot of two pixels back to where it began
      at = next;
    }
    edge.path_px.push_back(graph_.nodes[static_cast<size_t>(edge.to)].p_px);
    graph_.edges.push_back(std::move(edge));
  }

  void trace_ring(const cv::Point& start) {
    add_node({start});
    leave_node(start);
  }

  const cv::Mat& line_;
  const cv::Mat& clearance_;
  cv::Mat node_of_, used_;
  VoronoiGraph graph_;
};

}  // namespace

void measure(VoronoiEdge& edge, const cv::Mat& clearance) {
  edge.length_px = 0;
  edge.min_clearance_px = std::numeric_limits<double>::infinity();
  double sum = 0;
  for (size_t i = 0; i < edge.path_px.size(); ++i) {
    const Point2& p = edge.path_px[i];
    const double here = clearance.at<float>(static_cast<int>(p.y()), static_cast<int>(p.x()));
    edge.min_clearance_px = std::min(edge.min_clearance_px, here);
    sum += here;
    if (i > 0) edge.length_px += (p - edge.path_px[i - 1]).norm();
  }
  edge.mean_clearance_px = sum / static_cast<double>(edge.path_px.size());
}

VoronoiGraph trace_lines(const cv::Mat& line, const cv::Mat& clearance) {
  VoronoiGraph graph = Tracer(line, clearance).run();
  for (VoronoiEdge& edge : graph.edges) measure(edge, clearance);
  return graph;
}

}  // namespace smokemap
