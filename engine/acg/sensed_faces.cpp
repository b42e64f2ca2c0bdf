#include "acg/sensed_faces.hpp"

#include <algorithm>
#include <cmath>

#include "grids/ray.hpp"

namespace smokemap {
namespace {

constexpr double kAcross_m = 0.05, kAlong_m = 0.10;
constexpr double kSquare = 0.26;     ///< sine of how far a face may be from square to the direction
constexpr double kNearest_m = 0.1;   ///< to the sensor
constexpr double kBefore_m = 0.15;   ///< of a beam's end: free for sure
constexpr double kBeamReach_m = 12;  ///< beams are too far apart beyond
constexpr int kMost_cells = 40'000'000;

}  // namespace

SensedFaces::SensedFaces(const std::vector<NodeView>& views, const std::vector<bool>& use_node, const GraphState& state,
                         double heading_rad)
    : across_(std::cos(heading_rad), std::sin(heading_rad)), along_(-across_.y(), across_.x()) {
  Point2 low(1e9, 1e9), high(-1e9, -1e9);
  const auto span = [&](const Point2& p) {
    const Point2 q(across_.dot(p), along_.dot(p));
    low = low.cwiseMin(q), high = high.cwiseMax(q);
  };
  for (std::size_t node = 0; node < views.size(); ++node) {
    if (!use_node[node]) continue;
    span(state.pose(node).translation());
    for (const ScanPiece& piece : views[node].pieces)
      span(state.pose(node) * piece.segment.a), span(state.pose(node) * piece.segment.b);
  }
  if (low.x() > high.x()) return;
  low_across_m_ = low.x() - 0.5, low_along_m_ = low.y() - 0.5;
  const double rows = (high.x() - low.x() + 1) / kAcross_m, columns = (high.y() - low.y() + 1) / kAlong_m;
  if (rows * columns > kMost_cells) return;
  rows_ = static_cast<int>(rows) + 1, columns_ = static_cast<int>(columns) + 1;
  for (Layer* layer : {&from_above_, &from_below_, &through_}) {
    layer->nodes.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_), 0);
    layer->last.assign(layer->nodes.size(), 0);
  }
  for (std::size_t node = 0; node < views.size(); ++node) {
    if (!use_node[node]) continue;
    const Pose2 pose = state.pose(node);
    const auto stamp = static_cast<std::uint32_t>(node + 1);
    for (const ScanPiece& piece : views[node].pieces) {
      const Point2 a = pose * piece.segment.a, b = pose * piece.segment.b, u = (b - a).normalized();
      if (std::abs(u.dot(across_)) > kSquare) continue;
      count(across_.dot(pose.translation() - a) > 0 ? from_above_ : from_below_, a, b, stamp);
    }
    for (const ScanRay& ray : views[node].rays) {
      const double free_m = std::min(kBeamReach_m, ray.range_m - kBefore_m);
      const Point2 way = pose.rotation() * ray.way;
      if (free_m > kNearest_m)
        count(through_, pose.translation() + kNearest_m * way, pose.translation() + free_m * way, stamp);
    }
  }
}

int SensedFaces::row(double across_m) const {
  return static_cast<int>(std::floor((across_m - low_across_m_) / kAcross_m));
}

int SensedFaces::column(double along_m) const {
  return static_cast<int>(std::floor((along_m - low_along_m_) / kAlong_m));
}

/// Every cell on the way from a to b, for this node once. In units of cells, which are not square, the way is as
/// straight.
void SensedFaces::count(Layer& layer, const Point2& a, const Point2& b, std::uint32_t node) {
  const auto in_cells = [&](const Point2& p) {
    return Point2((across_.dot(p) - low_across_m_) / kAcross_m, (along_.dot(p) - low_along_m_) / kAlong_m);
  };
  const GridFrame cells{1, Point2::Zero(), rows_, columns_};
  walk_ray(cells, in_cells(a), in_cells(b), [&](Cell cell) {
    if (!cells.contains(cell)) return true;
    const auto i =
        static_cast<std::size_t>(cell.x) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(cell.y);
    if (layer.last[i] == node || layer.nodes[i] == 255) return true;
    layer.last[i] = node;
    ++layer.nodes[i];
    return true;
  });
}

/// In this cell or one beside it, across the wall.
SensedFaces::Count SensedFaces::seen(const Layer& layer, double across_m, int column) const {
  Count most = 0;
  const int middle = row(across_m);
  for (int r = std::max(0, middle - 1); r <= std::min(rows_ - 1, middle + 1); ++r)
    most = std::max(most, layer.nodes[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) +
                                      static_cast<std::size_t>(column)]);
  return most;
}

double SensedFaces::support(double at_m, double from_m, double to_m, double half_m) const {
  const int from = column(std::min(from_m, to_m)), to = column(std::max(from_m, to_m)), middle = row(at_m);
  double sum = 0;
  for (int c = std::max(0, from); c <= std::min(columns_ - 1, to); ++c) {
    const int faces = std::max(seen(from_above_, at_m + half_m, c), seen(from_below_, at_m - half_m, c));
    if (faces > 0) {
      sum += faces > 1 ? 1.0 : 0.5;
    } else if (middle >= 0 && middle < rows_) {
      const auto i =
          static_cast<std::size_t>(middle) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c);
      sum -= through_.nodes[i] > 1 ? 1.0 : 0.0;
    }
  }
  return sum / (to - from + 1);
}

}  // namespace smokemap
