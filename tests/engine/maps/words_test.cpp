// The words that maps use on the wire, in files and in the log: closed sets, each word one meaning.
#include <gtest/gtest.h>

#include <set>

#include "core/random.hpp"
#include "maps/goal.hpp"
#include "maps/layout_map.hpp"
#include "maps/merged_map.hpp"
#include "maps/point_of_interest.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

TEST(Words, EveryKindOfPointComesBackFromItsWord) {
  std::set<std::string> words;
  for (int k = 0; k <= static_cast<int>(PoiKind::kNote); ++k) {
    const auto kind = static_cast<PoiKind>(k);
    ASSERT_TRUE(poi_kind(to_string(kind))) << to_string(kind);
    EXPECT_EQ(*poi_kind(to_string(kind)), kind);
    words.insert(to_string(kind));
  }
  EXPECT_EQ(words.size(), 9u);
  for (const char* other : {"", "Gas_bottle", "gas bottle", "bomb"}) EXPECT_FALSE(poi_kind(other)) << other;
}

TEST(Words, GoalStatesAreTenseAndFourOfThemAreFinal) {
  std::set<std::string> words;
  int final_states = 0;
  for (int s = 0; s <= static_cast<int>(GoalState::kFailed); ++s) {
    words.insert(to_string(static_cast<GoalState>(s)));
    final_states += is_final(static_cast<GoalState>(s));
  }
  EXPECT_EQ(words.size(), 7u);
  EXPECT_EQ(final_states, 4);
  EXPECT_FALSE(is_final(GoalState::kDriving));
}

TEST(Words, WallStatesAreDistinct) {
  std::set<std::string> words;
  for (int s = 0; s <= static_cast<int>(WallState::kNew); ++s) words.insert(to_string(static_cast<WallState>(s)));
  EXPECT_EQ(words, (std::set<std::string>{"confirmed", "moved", "unseen", "missing", "new"}));
}

TEST(LayoutMap, PixelsAndMetresGoThereAndBack) {
  auto random = random_stream(9, 1);
  for (int i = 0; i < 100; ++i) {
    LayoutMap layout;
    layout.height_px = 1 + static_cast<int>(uniform_index(random, 5000));
    layout.scale = LayoutScale{uniform(random, 0.001, 0.2), 0.1, false};
    const Point2 p_px(uniform(random, -100, 6000), uniform(random, -100, 6000));
    EXPECT_THAT(layout.frame().to_pixels(layout.frame().to_metres(p_px)), test::IsNearPoint(p_px, 1e-6));
  }
}

TEST(LayoutMap, WallsInMetresHaveYUpAndTheScalesLength) {
  LayoutMap layout;
  layout.width_px = layout.height_px = 101;
  layout.corners = {{{0, 100}, 1, 1}, {{50, 0}, 1, 1}};
  layout.walls = {{0, 1, 4, 1, false}};
  EXPECT_EQ(layout.frame().metres_per_pixel, 1) << "without a scale a pixel is a metre";
  layout.scale = LayoutScale{0.02, 0.1, true};
  const Segment2 wall = layout.wall_m(0);
  EXPECT_THAT(wall.a, test::IsNearPoint(Point2(0, 0), 1e-12));
  EXPECT_THAT(wall.b, test::IsNearPoint(Point2(1, 2), 1e-12));
  EXPECT_NEAR(wall.length(), 0.02 * layout.wall_px(0).length(), 1e-12);
}

}  // namespace
}  // namespace smokemap
