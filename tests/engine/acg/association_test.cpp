#include "acg/association.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/random.hpp"
#include "geometry/angle.hpp"

namespace smokemap {
namespace {

/// Random walls, and nodes that see random pieces near them.
struct RandomScene {
  PlanModel plan;
  GraphState state;
  std::vector<NodeView> views;

  explicit RandomScene(std::mt19937_64& random) {
    for (int w = 0; w < 6; ++w) {
      const Point2 a(uniform(random, -5, 5), uniform(random, -5, 5));
      const double heading = uniform(random, -kPi, kPi), length = uniform(random, 0.5, 6);
      const Point2 b = a + length * Point2(std::cos(heading), std::sin(heading));
      for (const Point2& p : {a, b}) state.corners.push_back({p.x(), p.y()});
      plan.walls.push_back({2 * w, 2 * w + 1, length, heading, uniform(random, 0.02, 0.15), true});
    }
    for (int i = 0; i < 4; ++i) {
      const Pose2 pose(uniform(random, -5, 5), uniform(random, -5, 5), uniform(random, -kPi, kPi));
      state.poses.push_back({pose.x(), pose.y(), pose.heading()});
      views.emplace_back();
      for (const PlanEdge& wall : plan.walls) {
        const Segment2 s = state.segment(wall);
        const auto near = [&](double share) -> Point2 {
          return s.a + share * (s.b - s.a) + Point2(uniform(random, -0.3, 0.3), uniform(random, -0.3, 0.3));
        };
        views.back().pieces.push_back({{pose.inverse() * near(-0.2), pose.inverse() * near(1.1)}, 20});
      }
    }
  }
  std::vector<PieceLink> links(double gate_m = 0.5) const {
    return link_pieces(views, std::vector<bool>(views.size(), true), plan, state,
                       std::vector<double>(plan.walls.size(), gate_m), {});
  }
  void move(const Pose2& T) {
    for (auto& c : state.corners) {
      const Point2 p = T * Point2(c[0], c[1]);
      c = {p.x(), p.y()};
    }
    for (auto& p : state.poses) {
      const Pose2 moved = T * Pose2(p[0], p[1], p[2]);
      p = {moved.x(), moved.y(), moved.heading()};
    }
  }
};

TEST(LinkPieces, KeepTheirGateAndTheMisfitTheyHadWhenLinked) {
  auto random = random_stream(41, 1);
  std::size_t all = 0;
  for (int i = 0; i < 50; ++i) {
    const RandomScene scene(random);
    const double gate = uniform(random, 0.1, 0.6);
    for (const PieceLink& link : scene.links(gate)) {
      EXPECT_LT(link.misfit_m, 1.5 * gate);
      EXPECT_NEAR(link.misfit_m, misfit_m(link, scene.plan, scene.state), 1e-9);
      EXPECT_EQ(link.weight, 1);
      const Segment2 wall = scene.state.segment(scene.plan.walls[static_cast<std::size_t>(link.wall)]);
      const Pose2 pose = scene.state.pose(link.node);
      EXPECT_GE(link.side * signed_line_distance(wall, pose.translation()), 0) << "seen from its own side";
      for (const Point2& end : {link.part_robot.a, link.part_robot.b}) {
        const double s = along(wall, pose * end) * wall.length();
        EXPECT_GE(s, -0.15 - 1e-9);
        EXPECT_LE(s, wall.length() + 0.15 + 1e-9);
      }
      ++all;
    }
  }
  EXPECT_GT(all, 300u);
}

TEST(LinkPieces, SayTheSameWhereverTheFrameLies) {
  auto random = random_stream(41, 2);
  for (int i = 0; i < 30; ++i) {
    RandomScene scene(random);
    const auto before = scene.links();
    const auto length_before = linked_length_m(before, scene.plan, scene.state);
    scene.move(Pose2(uniform(random, -90, 90), uniform(random, -90, 90), uniform(random, -kPi, kPi)));
    const auto after = scene.links();
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t k = 0; k < after.size(); ++k) {
      EXPECT_EQ(after[k].wall, before[k].wall);
      EXPECT_EQ(after[k].side, before[k].side);
      EXPECT_NEAR(after[k].misfit_m, before[k].misfit_m, 1e-9);
    }
    const auto length_after = linked_length_m(before, scene.plan, scene.state);
    for (std::size_t w = 0; w < length_after.size(); ++w) EXPECT_NEAR(length_after[w], length_before[w], 0.21);
  }
}

/// Walls along x, each 10 cm thick, from..to at a height.
struct Strip {
  PlanModel plan;
  GraphState state;
  void wall(double from, double to, double y, bool usable = true) {
    const int first = static_cast<int>(state.corners.size());
    state.corners.push_back({from, y}), state.corners.push_back({to, y});
    plan.walls.push_back({first, first + 1, to - from, 0, 0.05, usable});
  }
  /// Of one node at (0, -2) that sees a piece from..to at a height.
  std::vector<PieceLink> seen(double from, double to, double y) {
    state.poses = {{0, -2, 0}};
    NodeView view;
    view.pieces.push_back({{{from, y + 2}, {to, y + 2}}, 20});
    return link_pieces({view}, {true}, plan, state, std::vector<double>(plan.walls.size(), 0.5), {});
  }
};

TEST(LinkPieces, GiveALinkToEachOfTheWallsInLineAndItsOwnPartToEach) {
  Strip strip;
  strip.wall(-4, -1, 0), strip.wall(0, 3, 0), strip.wall(4, 6, 0);
  const auto links = strip.seen(-4, 6, -0.05);
  ASSERT_EQ(links.size(), 3u);
  std::set<int> walls;
  double length = 0;
  for (const PieceLink& l : links) walls.insert(l.wall), length += l.part_robot.length();
  EXPECT_EQ(walls.size(), 3u);
  EXPECT_NEAR(length, 8 + 4 * 0.15, 1e-9);  // the doors belong to nobody but for a hand's breadth
}

TEST(LinkPieces, GoToTheNearestOfWallsSideBySideAndPassOverStrokesWithoutLength) {
  Strip strip;
  strip.wall(-2, 2, 0.3), strip.wall(-2, 2, 0.02), strip.wall(-2, 2, 0, false), strip.wall(0, 0.01, 0);
  const auto links = strip.seen(-1.5, 1.5, -0.05);
  ASSERT_EQ(links.size(), 1u);
  EXPECT_EQ(links[0].wall, 1);
  EXPECT_NEAR(links[0].misfit_m, 0.02, 1e-9);
}

TEST(LinkedLength, IsWhatCountingNodesPerTenCentimetresGives) {
  auto random = random_stream(41, 3);
  for (int i = 0; i < 50; ++i) {
    Strip strip;
    strip.wall(0, 5.05, 0);
    std::vector<PieceLink> links;
    std::vector<std::set<std::size_t>> nodes(51);
    for (int k = 0; k < 8; ++k) {
      PieceLink link;
      link.node = uniform_index(random, 3);
      link.weight = uniform01(random);
      const auto from = uniform_index(random, 51), to = uniform_index(random, 51);
      link.part_robot = {{0.1 * static_cast<double>(from) + 0.05, 0}, {0.1 * static_cast<double>(to) + 0.05, 0}};
      if (link.weight >= 0.4)
        for (auto bin = std::min(from, to); bin <= std::max(from, to); ++bin) nodes[bin].insert(link.node);
      links.push_back(link);
    }
    strip.state.poses.assign(3, {0, 0, 0});
    double expected = 0;
    for (const auto& bin : nodes) expected += bin.size() >= 2 ? 0.1 : 0;
    EXPECT_NEAR(linked_length_m(links, strip.plan, strip.state, 0.4)[0], expected, 1e-9);
  }
}

}  // namespace
}  // namespace smokemap
