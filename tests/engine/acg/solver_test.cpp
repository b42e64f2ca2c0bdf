#include "acg/solver.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "acg/association.hpp"
#include "core/random.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;
using test::IsOk;

/// A room of 6 x 4 m whose plan is drawn a fifth too long along x; `right` is where its corners are.
struct StretchedRoom {
  PlanModel plan;
  std::vector<Point2> right{{0, 0}, {6, 0}, {6, 4}, {0, 4}};
  SolveInput input;
  GraphState state;

  explicit StretchedRoom(double stretch = 1.2) {
    plan.scale_sigma = 0.02;
    for (const Point2& p : right) plan.corners.push_back({stretch * p.x(), p.y()});
    for (int i = 0; i < 4; ++i) {
      const Segment2 s{plan.corners[static_cast<std::size_t>(i)], plan.corners[static_cast<std::size_t>((i + 1) % 4)]};
      plan.walls.push_back({i, (i + 1) % 4, s.length(), s.heading(), 0.05, true});
    }
    plan.degree.assign(4, 2);
    plan.lines = {std::vector<double>{0, 6 * stretch}, std::vector<double>{0, 4}};
    plan.line_of_corner = {std::vector<int>{0, 1, 1, 0}, std::vector<int>{0, 0, 1, 1}};
    for (const Point2& p : plan.corners) state.corners.push_back({p.x(), p.y()});
    state.lines = plan.lines;
    input.plan = &plan;
    input.wall_firmness.assign(4, 1);
    input.iterations = 50;
  }

  /// A pose inside, and what it sees of each wall's inner face.
  void look_from(const Pose2& pose) {
    const std::size_t node = state.poses.size();
    state.poses.push_back({pose.x(), pose.y(), pose.heading()});
    for (int w = 0; w < 4; ++w) {
      const Point2 a = right[static_cast<std::size_t>(w)], b = right[static_cast<std::size_t>((w + 1) % 4)];
      const Segment2 wall{a, b};
      const Point2 inward = 0.05 * wall.normal();
      PieceLink link;
      link.node = node;
      link.wall = w;
      link.part_robot = {pose.inverse() * Point2(a + 0.5 * wall.direction() + inward),
                         pose.inverse() * Point2(b - 0.5 * wall.direction() + inward)};
      input.links.push_back(link);
    }
  }

  double worst_corner_m() const {
    double worst = 0;
    for (int c = 0; c < 4; ++c) worst = std::max(worst, (state.corner(c) - right[static_cast<std::size_t>(c)]).norm());
    return worst;
  }
};

TEST(AcgSolver, PutsTheCornersOfAStretchedRoomWhereItsFacesWereSeen) {
  StretchedRoom room;
  for (int i = 0; i < 10; ++i) room.look_from(Pose2(1 + 0.4 * i, 2, 0.3 * i));
  ASSERT_THAT(solve(room.input, {}, {}, room.state), IsOk());
  EXPECT_LT(room.worst_corner_m(), 0.03);
}

TEST(AcgSolver, GetsOverPlantedWrongLinksByTighteningWeights) {
  // Four in ten links of each wall say that it stands 0.9 m further in: a cupboard before it.
  StretchedRoom room(1.03);
  auto random = random_stream(3, 9);
  for (int i = 0; i < 20; ++i)
    room.look_from(Pose2(uniform(random, 1, 5), uniform(random, 1, 3), uniform(random, -3, 3)));
  std::size_t wrong = 0;
  for (PieceLink& link : room.input.links) {
    if (uniform01(random) > 0.4) continue;
    const Pose2 pose = room.state.pose(link.node);
    const Segment2 wall{room.right[static_cast<std::size_t>(link.wall)],
                        room.right[static_cast<std::size_t>((link.wall + 1) % 4)]};
    for (Point2* p : {&link.part_robot.a, &link.part_robot.b})
      *p = pose.inverse() * Point2(pose * *p + 0.9 * wall.normal());
    ++wrong;
  }
  ASSERT_GT(wrong, 20u);
  for (double width = 0.5; width > 0.08; width *= 0.6) {
    for (PieceLink& link : room.input.links) {
      link.misfit_m = misfit_m(link, room.plan, room.state);
      link.weight = robust_weight(link.misfit_m, width);
    }
    ASSERT_THAT(solve(room.input, {}, {}, room.state), IsOk());
  }
  EXPECT_LT(room.worst_corner_m(), 0.05);
}

TEST(AcgSolver, ChangesNothingWhenThePlanIsRightAndNothingElseIsKnown) {
  StretchedRoom room(1.0);
  room.look_from(Pose2(2, 2, 0));
  room.input.links.clear();
  ASSERT_THAT(solve(room.input, {}, {}, room.state), IsOk());
  EXPECT_LT(room.worst_corner_m(), 1e-6);
}

TEST(AcgSolver, MovesOnlyThePosesThatAreFreeAndNeverTheFirst) {
  StretchedRoom room(1.0);
  for (int i = 0; i < 4; ++i) room.look_from(Pose2(1.0 + i, 2, 0));
  const auto off = room.state.poses;
  for (auto& pose : room.state.poses) pose[1] += 0.05;
  const auto before = room.state.poses;
  room.input.free_poses = {0, 3};
  ASSERT_THAT(solve(room.input, {}, {}, room.state), IsOk());
  EXPECT_EQ(room.state.poses[0], before[0]);
  EXPECT_EQ(room.state.poses[3], before[3]);
  EXPECT_NE(room.state.poses[1], before[1]);
}

TEST(AcgSolver, LetsAPersonWinOverEveryLink) {
  StretchedRoom room(1.0);
  for (int i = 0; i < 30; ++i) room.look_from(Pose2(1 + 0.1 * i, 2, 0));
  room.input.pins.push_back({2, {6.2, 4.1}});
  room.input.lengths.push_back({3, 3.8});
  ASSERT_THAT(solve(room.input, {}, {}, room.state), IsOk());
  EXPECT_LT((room.state.corner(2) - Point2(6.2, 4.1)).norm(), 0.05);
  EXPECT_NEAR((room.state.corner(3) - room.state.corner(0)).norm(), 3.8, 0.05);
}

TEST(AcgSolver, GivesTheSameBytesTwiceAndStopsWhenAsked) {
  StretchedRoom one, two;
  for (StretchedRoom* room : {&one, &two}) {
    for (int i = 0; i < 5; ++i) room->look_from(Pose2(1 + 0.5 * i, 2, 0.1));
    room->input.free_poses = {0, 5};
    ASSERT_THAT(solve(room->input, {}, {}, room->state), IsOk());
  }
  EXPECT_EQ(one.state.corners, two.state.corners);
  EXPECT_EQ(one.state.poses, two.state.poses);
  std::stop_source stop;
  stop.request_stop();
  const auto before = one.state.corners;
  EXPECT_THAT(solve(one.input, {}, {{}, stop.get_token()}, one.state), Fails(Errc::kCancelled));
  EXPECT_EQ(one.state.corners, before);
}

TEST(CornerSigmas, ShrinkWithEvidenceAndAreLargeWhereNothingWasSeen) {
  StretchedRoom blind, seen;
  blind.look_from(Pose2(2, 2, 0));
  blind.input.links.clear();
  for (int i = 0; i < 10; ++i) seen.look_from(Pose2(1 + 0.4 * i, 2, 0));
  const auto wide = sigmas_at(blind.input, {}, blind.state), narrow = sigmas_at(seen.input, {}, seen.state);
  ASSERT_THAT(wide, IsOk());
  ASSERT_THAT(narrow, IsOk());
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_LT(narrow->corners_m[c], 0.05);
    EXPECT_GT(wide->corners_m[c], 3 * narrow->corners_m[c]);
  }
  SolveInput nothing;
  EXPECT_THAT(sigmas_at(nothing, {}, GraphState{}), IsOk());
}

// A robot that had driven through smoke for a minute said 5 cm at .3 m: what drift left on the way was not counted.
TEST(PoseSigmas, GrowWithTheWayDrivenUntilWallsAreSeen) {
  StretchedRoom blind(1.0);
  constexpr double kStep_m = 0.03;
  for (int i = 0; i < 17; ++i) {
    blind.look_from(Pose2(1 + 0.25 * i, 2, 0));
    if (i == 0) continue;
    PoseEdge step;
    step.from = i - 1;
    step.to = i;
    step.T_from_to = Pose2(0.25, 0, 0);
    step.sqrt_information = Eigen::Vector3d(1 / kStep_m, 1 / kStep_m, 1e4).asDiagonal();
    blind.input.edges.push_back(step);
  }
  blind.input.free_poses = {0, 17};
  StretchedRoom seen = blind;
  seen.input.plan = &seen.plan;
  blind.input.links.clear();
  const auto drifted = sigmas_at(blind.input, {}, blind.state, {0, 4, 16});
  const auto held = sigmas_at(seen.input, {}, seen.state, {0, 4, 16});
  ASSERT_THAT(drifted, IsOk());
  ASSERT_THAT(held, IsOk());
  EXPECT_EQ(drifted->poses_m[0], 0) << "the first pose is the frame";
  EXPECT_NEAR(drifted->poses_m[1], 2 * kStep_m, 1e-3);
  EXPECT_NEAR(drifted->poses_m[2], 4 * kStep_m, 2e-3);
  EXPECT_LT(held->poses_m[2], kStep_m);
}

TEST(AcgSolver, LeavesAPlanAtItsStartWhenOneWallIsAllThatIsSeen) {
  // The wall says nothing about places along it: plans slid by metres before walls around the corner were seen.
  StretchedRoom room(1.0);
  for (int i = 0; i < 4; ++i) room.look_from(Pose2(1 + 0.5 * i, 2, 0));
  std::erase_if(room.input.links, [](const PieceLink& link) { return link.wall != 0; });
  room.input.start = StartHold{room.state.pose(0), Pose2(1.1, 1.9, 0.02), 0.2, 0.05};
  for (auto& corner : room.state.corners) corner[0] += 0.8;
  for (double& line : room.state.lines[0]) line += 0.8;
  ASSERT_THAT(solve(room.input, {}, {}, room.state), IsOk());
  EXPECT_LT(room.worst_corner_m(), 0.15);
}

TEST(AcgSolver, BelievesWallsRatherThanAStartThatIsFarOff) {
  StretchedRoom room(1.05);
  for (int i = 0; i < 10; ++i) room.look_from(Pose2(1 + 0.4 * i, 2, 0.3 * i));
  room.input.start = StartHold{room.state.pose(0), Pose2(2.5, 3.2, 0.3), 0.2, 0.05};
  ASSERT_THAT(solve(room.input, {}, {}, room.state), IsOk());
  EXPECT_LT(room.worst_corner_m(), 0.03);
}

TEST(AcgSolver, KnowsAStartOutsideOfAllDrawnLines) {
  StretchedRoom room(1.0);
  room.state.poses.push_back({-2, 7, 0});
  room.input.start = StartHold{room.state.pose(0), Pose2(-2, 7, 0), 0.2, 0.05};
  for (auto& corner : room.state.corners) corner[1] -= 1.5;
  for (double& line : room.state.lines[1]) line -= 1.5;
  ASSERT_THAT(solve(room.input, {}, {}, room.state), IsOk());
  EXPECT_LT(room.worst_corner_m(), 0.02);
}

TEST(AcgSolver, DoesNotShrinkAPlanBecauseItWasDrawnUnevenly) {
  // Corners up to 9 cm off their lines pulled the whole plan together: the smaller, the nearer.
  auto random = random_stream(3, 12);
  StretchedRoom room(1.0);
  room.plan.scale_sigma = 0.2;
  for (Point2& p : room.plan.corners) p += Point2(uniform(random, -0.09, 0.09), uniform(random, -0.09, 0.09));
  ASSERT_THAT(even_out({}, room.plan), IsOk());
  ASSERT_EQ(room.plan.even_corners.size(), 4u);
  for (const auto& corner : room.plan.even_corners) EXPECT_TRUE(corner.allFinite());
  room.state.poses.push_back({3, 2, 0});
  room.input.start = StartHold{room.state.pose(0), Pose2(3, 2, 0), 0.2, 0.05};
  ASSERT_THAT(solve(room.input, {}, {}, room.state), IsOk());
  EXPECT_NEAR(room.state.log_scale, 0, 0.002);
  for (std::size_t c = 0; c < 4; ++c)
    EXPECT_LT((room.state.corner(static_cast<int>(c)) - room.plan.corners[c]).norm(), 0.12);
}

}  // namespace
}  // namespace smokemap
