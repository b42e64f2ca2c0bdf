#include "acg/corner_links.hpp"

#include <gtest/gtest.h>

#include "acg/association.hpp"
#include "geometry/angle.hpp"

namespace smokemap {
namespace {

/// A room of 6 x 4 m, walls 20 cm thick, drawn where it is.
struct Room {
  PlanModel plan;
  GraphState state;

  Room() {
    plan.corners = {{0, 0}, {6, 0}, {6, 4}, {0, 4}};
    for (int i = 0; i < 4; ++i) {
      const Segment2 s{plan.corners[static_cast<std::size_t>(i)], plan.corners[static_cast<std::size_t>((i + 1) % 4)]};
      plan.walls.push_back({i, (i + 1) % 4, s.length(), s.heading(), 0.1, true});
    }
    plan.degree.assign(4, 2);
    for (const Point2& p : plan.corners) state.corners.push_back({p.x(), p.y()});
  }
};

/// What a robot in the room sees of its four corners.
NodeView view_from(const Pose2& pose) {
  NodeView view;
  const Point2 inner[4] = {{0.1, 0.1}, {5.9, 0.1}, {5.9, 3.9}, {0.1, 3.9}};
  for (int i = 0; i < 4; ++i) {
    Corner c;
    c.position = pose.inverse() * inner[i];
    c.orientation_rad = wrap_angle(kPi / 4 + i * kPi / 2 - pose.heading());
    c.opening_rad = kPi / 2;
    view.corners.push_back(c);
  }
  return view;
}

std::vector<CornerLink> links_of(Room& room, const NodeView& view, const Pose2& pose, double gate_m = 0.5) {
  room.state.poses = {{pose.x(), pose.y(), pose.heading()}};
  return link_corners({view}, {true}, room.plan, room.state, std::vector<double>(4, gate_m));
}

TEST(CornerSectors, OfARoomAreFourInsideAndFourOutside) {
  const Room room;
  int inside = 0, outside = 0;
  for (const CornerSector& s : corner_sectors(room.plan, room.state)) {
    const bool in = s.opening_rad < kPi;
    (in ? inside : outside) += 1;
    const Point2 crossing = room.state.corner(s.corner) - s.offset_map, middle(3, 2);
    const Point2 away = room.state.corner(s.corner) - middle;
    EXPECT_NEAR(s.opening_rad, in ? kPi / 2 : 3 * kPi / 2, 1e-9);
    EXPECT_NEAR(std::abs((crossing - middle).x()), std::abs(away.x()) + (in ? -0.1 : 0.1), 1e-9);
    EXPECT_NEAR(std::abs((crossing - middle).y()), std::abs(away.y()) + (in ? -0.1 : 0.1), 1e-9);
  }
  EXPECT_EQ(inside, 4);
  EXPECT_EQ(outside, 4);
}

TEST(CornerSectors, LeaveOutWallsThatRunOnStraight) {
  Room room;
  room.plan.corners.push_back({3, 0});
  room.state.corners.push_back({3, 0});
  room.plan.walls[0].corner_b = 4;
  room.plan.walls.push_back({4, 1, 3, 0, 0.1, true});
  for (const CornerSector& s : corner_sectors(room.plan, room.state)) EXPECT_NE(s.corner, 4);
}

TEST(LinkCorners, FindsEveryCornerFromAPoseThatIsALittleOff) {
  Room room;
  const NodeView view = view_from({2, 1.5, 0.4});
  const auto links = links_of(room, view, {2.15, 1.4, 0.42});
  ASSERT_EQ(links.size(), 4u);
  for (const CornerLink& l : links) {
    EXPECT_EQ(l.borne_out, 1);
    EXPECT_LT(l.misfit_m, 0.3);
    EXPECT_EQ((l.seen_robot - view.corners[static_cast<std::size_t>(l.corner)].position).norm(), 0);
  }
}

TEST(LinkCorners, RefusesWhatIsTurnedEitherWayOrOpensOtherwise) {
  Room room;
  const Pose2 pose(2, 1.5, 0.4);
  for (const double turn : {1.0, -1.0}) {  // the published test let negative differences pass
    NodeView view = view_from(pose);
    view.corners[0].orientation_rad = wrap_angle(view.corners[0].orientation_rad + turn);
    EXPECT_EQ(links_of(room, view, pose).size(), 3u);
  }
  NodeView view = view_from(pose);
  view.corners[1].opening_rad = 3 * kPi / 2;
  EXPECT_EQ(links_of(room, view, pose).size(), 3u);
}

TEST(LinkCorners, TakesTheNearestOfTwoAndGivesOneCornerOnce) {
  Room room;
  const Pose2 pose(2, 1.5, 0);
  NodeView view = view_from(pose);
  view.corners.push_back(view.corners[0]);
  view.corners.back().position += Point2(0.3, 0);
  const auto links = links_of(room, view, pose);
  EXPECT_EQ(links.size(), 4u);
  for (const CornerLink& l : links) EXPECT_LT(l.misfit_m, 0.01);
}

TEST(LinkCorners, DoubtsALinkThatNoOtherBearsOut) {
  Room room;
  const Pose2 pose(2, 1.5, 0);
  NodeView view = view_from(pose);
  view.corners[2].position += Point2(-0.4, 0.1);  // the edge of a cupboard in the corner
  for (const CornerLink& l : links_of(room, view, pose, 0.6))
    EXPECT_EQ(l.borne_out < 1, l.corner == 2) << "corner " << l.corner;
}

TEST(LinkCorners, LeavesOutCornersOfWallsTakenOut) {
  Room room;
  const Pose2 pose(2, 1.5, 0);
  room.state.poses = {{pose.x(), pose.y(), pose.heading()}};
  const auto links = link_corners({view_from(pose)}, {true}, room.plan, room.state, {0, 0.5, 0.5, 0.5});
  for (const CornerLink& l : links) EXPECT_TRUE(l.corner == 2 || l.corner == 3);
  EXPECT_EQ(links.size(), 2u);
  EXPECT_TRUE(link_corners({view_from(pose)}, {false}, room.plan, room.state, {1, 1, 1, 1}).empty());
}

TEST(RobustWeight, IsOneAtNoMisfitAndAQuarterAtItsWidth) {
  EXPECT_EQ(robust_weight(0, 0.2), 1);
  EXPECT_NEAR(robust_weight(0.2, 0.2), 0.25, 1e-12);
  EXPECT_GT(robust_weight(0.1, 0.2), robust_weight(0.3, 0.2));
  EXPECT_LT(robust_weight(2, 0.2), 1e-3);
}

}  // namespace
}  // namespace smokemap
