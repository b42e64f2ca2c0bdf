#include "layout/doors.hpp"

#include <gtest/gtest.h>

namespace smokemap {
namespace {

TEST(Doors, AreTheOpeningsWithLeaves) {
  LayoutMap map;
  map.openings.push_back({{{0, 0}, {30, 40}}, OpeningKind::kDoor, 1});
  map.openings.push_back({{{0, 0}, {90, 0}}, OpeningKind::kWindow, 1});
  map.openings.push_back({{{0, 0}, {70, 0}}, OpeningKind::kPassage, 1});
  EXPECT_EQ(door_widths(map), std::vector<double>{50});
  EXPECT_TRUE(door_widths({}).empty());
}

TEST(Doors, TheirUsualWidthIsKnownFromThreeAndLittleMovedByOneThatIsWrong) {
  EXPECT_FALSE(usual_door_width({}));
  EXPECT_FALSE(usual_door_width({40, 41}));
  EXPECT_EQ(usual_door_width({41, 40, 400}), 41);
  EXPECT_EQ(usual_door_width({44, 41, 40, 42, 1}), 41);
}

}  // namespace
}  // namespace smokemap
