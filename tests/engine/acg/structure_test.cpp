#include <gtest/gtest.h>

#include <cmath>

#include "acg/association.hpp"
#include "acg/new_walls.hpp"
#include "acg/read_out.hpp"
#include "acg/scan_pieces.hpp"
#include "core/random.hpp"
#include "geometry/angle.hpp"

namespace smokemap {
namespace {

/// One wall from (0, 0) to (8, 0), 20 cm thick.
struct LongWall {
  PlanModel plan;
  GraphState state;
  LongWall() {
    plan.corners = {{0, 0}, {8, 0}};
    plan.walls = {{0, 1, 8, 0, 0.1, true}};
    plan.degree = {1, 1};
    state.corners = {{0, 0}, {8, 0}};
  }
};

NodeView sees(const Pose2& pose, const Segment2& piece_map) {
  NodeView view;
  ScanPiece piece{{pose.inverse() * piece_map.a, pose.inverse() * piece_map.b}, 30};
  if (signed_line_distance(piece.segment, Point2::Zero()) < 0) std::swap(piece.segment.a, piece.segment.b);
  view.pieces.push_back(piece);
  return view;
}

std::vector<PieceLink> links_of(LongWall& wall, const Pose2& pose, const Segment2& piece, double gate_m) {
  wall.state.poses = {{pose.x(), pose.y(), pose.heading()}};
  return link_pieces({sees(pose, piece)}, {true}, wall.plan, wall.state, {gate_m}, {});
}

TEST(LinkPieces, LinksTheFaceOnTheRobotsSideWhateverItsPose) {
  auto random = random_stream(12, 1);
  for (int i = 0; i < 100; ++i) {
    LongWall wall;
    const double side = uniform01(random) < 0.5 ? -1 : 1;
    const Pose2 pose(uniform(random, 1, 7), side * uniform(random, 0.8, 5), uniform(random, -kPi, kPi));
    const auto links = links_of(wall, pose, {{2, side * 0.1}, {6, side * 0.1}}, 0.5);
    ASSERT_EQ(links.size(), 1u);
    EXPECT_EQ(links[0].side, side);
    EXPECT_NEAR(links[0].misfit_m, 0, 1e-9);
    EXPECT_NEAR(misfit_m(links[0], wall.plan, wall.state), 0, 1e-9);
    wall.state.corners = {{0, side * 0.05}, {8, side * 0.05}};
    EXPECT_NEAR(misfit_m(links[0], wall.plan, wall.state), 0.05, 1e-9);
  }
}

TEST(LinkPieces, LeavesOutWhatIsTooFarTurnedBesideOrTakenOut) {
  LongWall wall;
  const Pose2 robot(4, 2, 0);
  EXPECT_EQ(links_of(wall, robot, {{2, 0.5}, {6, 0.5}}, 0.5).size(), 1u);
  EXPECT_TRUE(links_of(wall, robot, {{2, 0.9}, {6, 0.9}}, 0.5).empty());
  EXPECT_TRUE(links_of(wall, robot, {{3, 0.1}, {4.5, 1.0}}, 1.0).empty());
  EXPECT_TRUE(links_of(wall, robot, {{9, 0.1}, {11, 0.1}}, 0.5).empty());
  EXPECT_TRUE(links_of(wall, robot, {{2, 0.1}, {6, 0.1}}, 0).empty());
}

TEST(LinkPieces, CutsAPieceAtTheWallsEnd) {
  LongWall wall;
  const auto links = links_of(wall, Pose2(7, 2, 0.4), {{6, 0.1}, {12, 0.1}}, 0.5);
  ASSERT_EQ(links.size(), 1u);
  const Pose2 pose = wall.state.pose(0);
  const double reach = std::max((pose * links[0].part_robot.a).x(), (pose * links[0].part_robot.b).x());
  EXPECT_GT(reach, 7.9);
  EXPECT_LT(reach, 8.3);
}

TEST(LinkedLength, CountsOnlyWhatTwoNodesSay) {
  LongWall wall;
  wall.state.poses = {{2, 2, 0}, {4, 2, 0}};
  const std::vector<NodeView> views{sees(Pose2(2, 2, 0), {{1, 0.1}, {4, 0.1}}),
                                    sees(Pose2(4, 2, 0), {{3, 0.1}, {6, 0.1}})};
  const auto links = link_pieces(views, {true, true}, wall.plan, wall.state, {0.5}, {});
  EXPECT_NEAR(linked_length_m(links, wall.plan, wall.state)[0], 1.0, 0.15);
  const auto one = link_pieces(views, {true, false}, wall.plan, wall.state, {0.5}, {});
  EXPECT_EQ(linked_length_m(one, wall.plan, wall.state)[0], 0);
}

/// Two nodes that see the same face, and one wall of a plan elsewhere.
std::vector<NewWall> new_walls_of(const Segment2& face, int nodes, const PlanModel* plan = nullptr,
                                  const GraphState& corners = {}) {
  GraphState state = corners;
  std::vector<NodeView> views;
  const Point2 n = face.normal();
  for (int i = 0; i < nodes; ++i) {
    const Pose2 pose(face.midpoint() + 2 * n + 0.3 * i * face.direction(), 0.2 * i);
    views.push_back(sees(pose, face));
    state.poses.push_back({pose.x(), pose.y(), pose.heading()});
  }
  const std::vector<bool> all(views.size(), true), there(plan == nullptr ? 0 : plan->walls.size(), true);
  return find_new_walls(views, all, plan, state, there, {});
}

TEST(FindNewWalls, NeedsTwoNodesAndLength) {
  EXPECT_EQ(new_walls_of({{0, 0}, {4, 0}}, 2).size(), 1u);
  EXPECT_TRUE(new_walls_of({{0, 0}, {4, 0}}, 1).empty());
  EXPECT_TRUE(new_walls_of({{0, 0}, {0.8, 0}}, 3).empty());
}

TEST(FindNewWalls, FindsNothingOnWallsThatThePlanHas) {
  LongWall wall;
  EXPECT_TRUE(new_walls_of({{8, 0.1}, {0, 0.1}}, 3, &wall.plan, wall.state).empty());
  EXPECT_EQ(new_walls_of({{8, 3}, {0, 3}}, 3, &wall.plan, wall.state).size(), 1u);
}

TEST(FindNewWalls, MovesWithTheWorld) {
  auto random = random_stream(12, 2);
  for (int i = 0; i < 20; ++i) {
    const Pose2 T(uniform(random, -9, 9), uniform(random, -9, 9), uniform(random, -kPi, kPi));
    const auto walls = new_walls_of({T * Point2(0, 0), T * Point2(4, 0)}, 3);
    ASSERT_EQ(walls.size(), 1u);
    EXPECT_NEAR(walls[0].segment_map.length(), 4, 0.15);
    EXPECT_NEAR((walls[0].segment_map.midpoint() - T * Point2(2, -0.06)).norm(), 0, 0.1);
  }
}

TEST(Stubs, GoWithTheMissingWallBeyondTheirDoorUnlessTheyAreLongOrMeetAnother) {
  PlanModel plan;
  plan.corners = {{0, 0}, {0.4, 0}, {1.4, 0}, {5, 0}, {0, 3}};
  plan.walls = {{0, 1, 0.4, 0, 0.07, true}, {2, 3, 3.6, 0, 0.07, true}, {0, 4, 3, kPi / 2, 0.07, true}};
  plan.gaps = {{1, 2, 1.0, 0, 0.07, true}};
  plan.degree = {2, 1, 1, 1, 1};
  const auto after = [&](std::vector<WallState> states) {
    stubs_go_with_their_walls(plan, states);
    return states;
  };
  using enum WallState;
  EXPECT_EQ(after({kConfirmed, kMissing, kConfirmed}), (std::vector{kMissing, kMissing, kConfirmed}));
  EXPECT_EQ(after({kConfirmed, kUnseen, kConfirmed}), (std::vector{kConfirmed, kUnseen, kConfirmed}));
  EXPECT_EQ(after({kMissing, kConfirmed, kConfirmed}), (std::vector{kMissing, kConfirmed, kConfirmed}));
  plan.walls[0].length_m = 0.9;
  EXPECT_EQ(after({kConfirmed, kMissing, kConfirmed}), (std::vector{kConfirmed, kMissing, kConfirmed}));
}

/// A node in the middle of a square room, hits every degree.
PoseNode in_a_square(double half_m, double turn_rad) {
  PoseNode node;
  auto hits = std::make_shared<std::vector<Point2>>();
  for (int i = 0; i < 360; ++i) {
    const double b = i * kPi / 180 + 0.003, c = std::cos(b), s = std::sin(b);
    const double range = half_m / std::max(std::abs(c), std::abs(s));
    hits->push_back(Pose2(0, 0, turn_rad) * Point2(range * c, range * s));
  }
  node.hits_robot = hits;
  return node;
}

TEST(ScanPieces, OfASquareRoomAreItsFourFacesWithTheRobotOnTheirLeft) {
  for (const double turn : {0.0, 0.4, 1.1, 2.9}) {
    const NodeView view = view_of(in_a_square(2, turn), {});
    EXPECT_LE(view.pieces.size(), 5u) << turn;  // a room without a door is cut once, where the bearings wrap
    double length = 0;
    for (const ScanPiece& p : view.pieces) {
      EXPECT_NEAR(signed_line_distance(p.segment, Point2::Zero()), 2, 0.01);
      length += p.segment.length();
    }
    EXPECT_GT(length, 15.0);
    EXPECT_EQ(view.corners.size(), 4u);
    EXPECT_TRUE(std::is_sorted(view.rays.begin(), view.rays.end(),
                               [](const ScanRay& a, const ScanRay& b) { return a.bearing_rad < b.bearing_rad; }));
  }
}

TEST(ScanPieces, AreNoneInScatteredHitsAndBadNumbersDoNoHarm) {
  auto random = random_stream(12, 3);
  PoseNode node;
  auto hits = std::make_shared<std::vector<Point2>>();
  for (int i = 0; i < 200; ++i) hits->push_back({uniform(random, -5, 5), uniform(random, -5, 5)});
  hits->push_back({std::nan(""), 1});
  hits->push_back({0, 0});
  node.hits_robot = hits;
  const NodeView view = view_of(node, {});
  double length = 0;
  for (const ScanPiece& p : view.pieces) length += p.segment.length();
  EXPECT_LT(length, 2);
  EXPECT_TRUE(view_of(PoseNode{}, {}).pieces.empty());
}

}  // namespace
}  // namespace smokemap
