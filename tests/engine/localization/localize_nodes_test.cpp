#include "localization/localize_nodes.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "geometry/angle.hpp"

namespace smokemap {
namespace {

/// A room of 8 x 5 m with a pillar, so that no turn looks like another.
std::vector<LocalizerWall> room_with_a_pillar() {
  const std::vector<Point2> p{{0, 0}, {8, 0}, {8, 5}, {0, 5}, {2, 3}, {3, 3}, {3, 5}};
  return {{{p[0], p[1]}, 0.1}, {{p[1], p[2]}, 0.1}, {{p[2], p[3]}, 0.1},
          {{p[3], p[0]}, 0.1}, {{p[4], p[5]}, 0.1}, {{p[5], p[6]}, 0.1}};
}

std::shared_ptr<const std::vector<Point2>> hits_from(const std::vector<LocalizerWall>& walls, const Pose2& pose) {
  auto hits = std::make_shared<std::vector<Point2>>();
  for (int i = 0; i < 120; ++i) {
    const double heading = pose.heading() + i * kPi / 60;
    const Point2 u(std::cos(heading), std::sin(heading));
    double nearest = 1e9;
    for (const LocalizerWall& w : walls) {
      const Point2 d = w.segment.b - w.segment.a, v = w.segment.a - pose.translation();
      const double cross = u.x() * d.y() - u.y() * d.x();
      if (std::abs(cross) < 1e-9) continue;
      const double range = (v.x() * d.y() - v.y() * d.x()) / cross, s = (v.x() * u.y() - v.y() * u.x()) / cross;
      if (range > 0 && s >= 0 && s <= 1) nearest = std::min(nearest, range);
    }
    if (nearest < 20) hits->push_back(pose.inverse() * Point2(pose.translation() + (nearest - 0.05) * u));
  }
  return hits;
}

TEST(LocalizeNodes, FollowsARunWhoseWheelsTurnTooFar) {
  const auto walls = room_with_a_pillar();
  PoseGraph graph;
  std::vector<Pose2> truth;
  Pose2 pose(1, 1, 0.1), odom;
  for (int i = 0; i < 25; ++i) {
    if (i > 0) {
      const Pose2 step(0.2, 0, 0.05);
      pose = pose * step;
      odom = odom * Pose2(0.22, 0, 0.06);  // ten and twenty percent wrong
    }
    PoseNode node;
    node.id = i;
    node.T_odom_robot = odom;
    node.hits_robot = hits_from(walls, pose);
    graph.nodes.push_back(node);
    truth.push_back(pose);
  }
  const auto found = localize_nodes(walls, graph, {1.1, 0.95, 0.1});
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t i = 5; i < found.size(); ++i) {
    EXPECT_LT((found[i].T_map_robot.translation() - truth[i].translation()).norm(), 0.2) << "node " << i;
    EXPECT_FALSE(found[i].lost);
  }
  const auto again = localize_nodes(walls, graph, {1.1, 0.95, 0.1});
  EXPECT_EQ(found.back().T_map_robot.x(), again.back().T_map_robot.x());
}

TEST(LocalizeNodes, IsLostWithoutWallsAndSurvivesNodesWithoutHits) {
  PoseGraph graph;
  graph.nodes.resize(3);
  for (const LocalizerEstimate& e : localize_nodes({}, graph, {})) EXPECT_TRUE(e.lost);
  EXPECT_EQ(localize_nodes(room_with_a_pillar(), graph, {1, 1, 0}).size(), 3u);
  EXPECT_TRUE(localize_nodes({}, {}, {}).empty());
}

}  // namespace
}  // namespace smokemap
