#include "app/merge_preview.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace smokemap::app {
namespace {

cv::Scalar colour(WallState state) {
  switch (state) {
    case WallState::kConfirmed:
      return {40, 140, 30};
    case WallState::kMoved:
      return {0, 140, 240};
    case WallState::kUnseen:
      return {220, 120, 30};
    case WallState::kMissing:
      return {40, 40, 220};
    case WallState::kNew:
      return {190, 30, 190};
  }
  return {0, 0, 0};
}

}  // namespace

cv::Mat draw_merged(const MergedMap& merged, const PoseGraph& graph, double pixels_per_metre) {
  Point2 low = Point2::Zero(), high = Point2::Zero();
  const auto widen = [&](const Point2& p) { low = low.cwiseMin(p), high = high.cwiseMax(p); };
  for (const MergedWall& w : merged.walls) widen(w.segment_map.a), widen(w.segment_map.b);
  for (const StampedPose& p : merged.trajectory) widen(p.T_map_robot.translation());
  low.array() -= 1, high.array() += 1;
  const double k = std::min(pixels_per_metre, 4000 / std::max(1.0, (high - low).maxCoeff()));
  cv::Mat picture(static_cast<int>((high - low).y() * k) + 1, static_cast<int>((high - low).x() * k) + 1, CV_8UC3,
                  cv::Scalar::all(255));
  const auto at = [&](const Point2& p) {
    return cv::Point(static_cast<int>((p.x() - low.x()) * k),
                     picture.rows - 1 - static_cast<int>((p.y() - low.y()) * k));
  };
  const std::size_t nodes = std::min(graph.nodes.size(), merged.trajectory.size());
  for (std::size_t i = 0; i < nodes; ++i) {
    if (!graph.nodes[i].hits_robot) continue;
    for (const Point2& hit : *graph.nodes[i].hits_robot)
      cv::circle(picture, at(merged.trajectory[i].T_map_robot * hit), 1, cv::Scalar::all(200), cv::FILLED);
  }
  for (std::size_t i = 1; i < nodes; ++i)
    cv::line(picture, at(merged.trajectory[i - 1].T_map_robot.translation()),
             at(merged.trajectory[i].T_map_robot.translation()), {160, 220, 160}, 2, cv::LINE_AA);
  for (const MergedWall& w : merged.walls)
    cv::line(picture, at(w.segment_map.a), at(w.segment_map.b), colour(w.state), 3, cv::LINE_AA);
  for (const MergedCorner& c : merged.corners)
    cv::circle(picture, at(c.p_map), std::clamp(static_cast<int>(2 * c.sigma_m * k), 2, 200), {90, 90, 90}, 1,
               cv::LINE_AA);
  return picture;
}

}  // namespace smokemap::app
