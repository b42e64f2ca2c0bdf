#include "acg/read_out.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "geometry/angle.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

using test::IsNearPoint;

WallEvidence random_evidence(std::mt19937_64& random) {
  WallEvidence evidence;
  const auto bins = 1 + uniform_index(random, 40);
  for (std::size_t i = 0; i < bins; ++i) {
    evidence.hit.push_back(static_cast<int>(uniform_index(random, 4)));
    evidence.through.push_back(static_cast<int>(uniform_index(random, 12)));
  }
  return evidence;
}

TEST(WallEvidence, NeverCountsTheSameStretchBothForAWallAndAgainstIt) {
  auto random = random_stream(42, 1);
  for (int i = 0; i < 300; ++i) {
    const WallEvidence evidence = random_evidence(random);
    EXPECT_LE(evidence.hit_m() + evidence.through_m(), evidence.length_m() + 1e-9);
  }
  const WallEvidence by_hand{{2, 1, 1, 0, 1, 0}, {3, 2, 1, 1, 5, 2}, 0.2};
  EXPECT_NEAR(by_hand.hit_m(), 0.4, 1e-12);      // the first and the third
  EXPECT_NEAR(by_hand.through_m(), 0.4, 1e-12);  // the last two; one beam alone says nothing
}

TEST(JudgeWallState, IsNotLessOfAWallForAnotherEchoNorMoreForAnotherBeamThrough) {
  const auto rank = [](WallState s) { return s == WallState::kMissing ? 0 : s == WallState::kUnseen ? 1 : 2; };
  auto random = random_stream(42, 2);
  for (int i = 0; i < 500; ++i) {
    WallEvidence evidence = random_evidence(random);
    const double linked = uniform(random, 0, 1), near = linked + uniform(random, 0, 1);
    const int before = rank(judge_wall_state(evidence, linked, near, {}));
    const auto bin = uniform_index(random, evidence.hit.size());
    WallEvidence more = evidence;
    ++more.hit[bin];
    EXPECT_GE(rank(judge_wall_state(more, linked, near, {})), before);
    EXPECT_GE(rank(judge_wall_state(evidence, linked + 0.5, near + 0.5, {})), before);
    ++evidence.through[bin];
    EXPECT_LE(rank(judge_wall_state(evidence, linked, near, {})), before);
  }
}

/// A drawn square of 6 m with its four walls, laid down by a similarity; every wall was seen.
struct SolvedSquare {
  LayoutMap layout;
  PlanModel plan;
  GraphState state;
  SolvedPlan solved;

  explicit SolvedSquare(const Similarity2& map_from_layout = {}) {
    layout.height_px = 100;
    plan.corners = {{0, 0}, {6, 0}, {6, 6}, {0, 6}};
    for (int i = 0; i < 4; ++i) {
      const Point2 p = map_from_layout * plan.corners[static_cast<std::size_t>(i)];
      state.corners.push_back({p.x(), p.y()});
      layout.corners.push_back({{10.0 * i, 5}, 2, 1});
      plan.walls.push_back({i, (i + 1) % 4, 6, wrap_angle(i * kPi / 2), 0.05, true});
      solved.evidence.push_back({std::vector<int>(60, 2), std::vector<int>(60, 0), 0.1});
    }
    state.poses = {{1, 2, kPi / 2}};
    solved.linked_m.assign(4, 6);
    solved.wall_states.assign(4, WallState::kConfirmed);
    solved.corner_sigma_m.assign(4, 0.07);
  }
  MergedMap read() {
    solved.layout = &layout, solved.plan = &plan, solved.state = &state;
    MergedMap out;
    read_out_plan(solved, {}, out);
    return out;
  }
};

TEST(ReadOut, CallsAWallMovedOnlyAgainstThePlanAsAWhole) {
  auto random = random_stream(42, 3);
  for (int i = 0; i < 20; ++i) {
    const Similarity2 s{uniform(random, 0.8, 1.2),
                        Pose2(uniform(random, -50, 50), uniform(random, -50, 50), uniform(random, -kPi, kPi))};
    SolvedSquare square(s);
    for (const MergedWall& w : square.read().walls) {
      EXPECT_EQ(w.state, WallState::kConfirmed);
      EXPECT_NEAR(w.displacement_m, 0, 1e-9);
    }
    const Point2 off = s * Point2(8, -2);  // the second corner, 2.8 m out
    square.state.corners[1] = {off.x(), off.y()};
    square.solved.wall_states[2] = WallState::kUnseen;
    const MergedMap moved = square.read();
    EXPECT_EQ(moved.walls[0].state, WallState::kMoved);
    EXPECT_EQ(moved.walls[2].state, WallState::kUnseen) << "nobody saw that it moved";
    EXPECT_GT(moved.walls[0].displacement_m, 0.3);
    EXPECT_THAT(moved.layout_to_map(square.plan.corners[1]), IsNearPoint(off, 1e-6));
  }
}

TEST(ReadOut, IsTheLessSureTheMoreDoubtThereIs) {
  SolvedSquare square;
  square.solved.wall_states = {WallState::kConfirmed, WallState::kMissing, WallState::kUnseen, WallState::kConfirmed};
  square.solved.evidence[1] = {std::vector<int>(60, 0), std::vector<int>(60, 3), 0.1};
  const MergedMap sure = square.read();
  EXPECT_NEAR(sure.walls[0].confidence, 0.98, 1e-12);
  EXPECT_NEAR(sure.walls[1].confidence, 0.98, 1e-12);
  EXPECT_LE(sure.walls[2].confidence, 0.6);
  EXPECT_NEAR(sure.walls[1].evidence_m, 6, 1e-9);
  square.solved.doubt = {0.25, 0.5, 1, 0};
  const MergedMap doubted = square.read();
  for (std::size_t w = 0; w < 4; ++w)
    EXPECT_NEAR(doubted.walls[w].confidence, sure.walls[w].confidence * (1 - square.solved.doubt[w]), 1e-12);
}

TEST(ReadOut, SaysThatACornerWasSeenOnlyWhenAWallWasSeenNearIt) {
  SolvedSquare square;
  for (WallEvidence& e : square.solved.evidence) std::fill(e.hit.begin(), e.hit.end(), 0);
  const auto seen = [&] {
    std::vector<bool> out;
    for (const MergedCorner& c : square.read().corners) out.push_back(c.seen);
    return out;
  };
  EXPECT_EQ(seen(), (std::vector<bool>{false, false, false, false}));
  square.solved.evidence[0].hit[30] = 5;  // the middle of a wall is near neither end
  EXPECT_EQ(seen(), (std::vector<bool>{false, false, false, false}));
  square.solved.evidence[0].hit[55] = 1;
  EXPECT_EQ(seen(), (std::vector<bool>{false, true, false, false}));
  square.solved.evidence[2].hit[2] = 1;
  EXPECT_EQ(seen(), (std::vector<bool>{false, true, true, false}));
  square.solved.wall_states[0] = WallState::kMissing;
  EXPECT_EQ(seen(), (std::vector<bool>{false, false, true, false}));
}

TEST(ReadOut, ShowsLinksWhereTheRobotSawThemAndNewWallsWithoutAPlaceInThePlan) {
  SolvedSquare square;
  for (const double weight : {0.9, 0.3, 0.05}) {
    CornerLink link;
    link.corner = 2, link.seen_robot = {3, 0}, link.weight = weight;
    square.solved.links.push_back(link);
  }
  MergedMap out = square.read();
  ASSERT_EQ(out.links.size(), 3u);
  EXPECT_EQ(out.links[0].state, LinkState::kKept);
  EXPECT_EQ(out.links[1].state, LinkState::kDoubtful);
  EXPECT_EQ(out.links[2].state, LinkState::kRejected);
  EXPECT_THAT(out.links[0].p_map, IsNearPoint(Point2(1, 5), 1e-9));
  read_out_new_walls({{{{1, 1}, {1, 4}}, 2.5, 0.7}}, out);
  ASSERT_EQ(out.walls.size(), 5u);
  EXPECT_FALSE(out.walls[4].layout_wall.has_value());
  EXPECT_EQ(out.walls[4].state, WallState::kNew);
  EXPECT_EQ(out.walls[4].evidence_m, 2.5);
}

}  // namespace
}  // namespace smokemap
