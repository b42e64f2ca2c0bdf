#include "recording/layout_json.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

LayoutDocument random_document(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto at = [&] { return Point2(std::round(uniform(random, 0, 1000)), std::round(uniform(random, 0, 800))); };
  LayoutDocument document;
  LayoutMap& layout = document.layout;
  layout.width_px = 1000, layout.height_px = 800;
  for (int i = 0; i < 20; ++i) layout.corners.push_back({at(), 0, 0.5});
  for (int i = 0; i + 1 < 20; ++i) {
    layout.walls.push_back({i, i + 1, 4.5, 0.25, i % 2 == 0});
    ++layout.corners[static_cast<std::size_t>(i)].degree;
    ++layout.corners[static_cast<std::size_t>(i + 1)].degree;
  }
  for (const OpeningKind kind : {OpeningKind::kDoor, OpeningKind::kWindow, OpeningKind::kPassage})
    layout.openings.push_back({Segment2{at(), at()}, kind, 0.75});
  layout.rooms_px.push_back({at(), at(), at()});
  layout.signs.push_back({at(), 7, "green", 0.5});
  layout.you_are_here_px = at();
  layout.scale = LayoutScale{0.0125, 0.1, true};
  layout.drawings = {{{1, 2}, {300.5, 200}, 1, true}, {{310, 2}, {400, 90}, 0.25, false}};
  layout.warnings = {"the sheet is \"tilted\""};
  document.homography.H_layout_photo = {1, 0.5, 3, 0, 1, 4, 1e-5, 0, 1};
  document.sheet_corners = {{at(), at(), at(), at()}};
  return document;
}

class LayoutRoundTrip : public testing::TestWithParam<std::uint64_t> {};

TEST_P(LayoutRoundTrip, KeepsEverything) {
  const LayoutDocument sent = random_document(GetParam());
  const auto read = layout_from_json(to_json(sent));
  ASSERT_THAT(read, test::IsOk());
  const LayoutMap &a = sent.layout, &b = read->layout;
  EXPECT_EQ(to_json(*read), to_json(sent));
  ASSERT_EQ(b.walls.size(), a.walls.size());
  for (std::size_t i = 0; i < a.walls.size(); ++i) {
    EXPECT_EQ(b.walls[i].corner_a, a.walls[i].corner_a);
    EXPECT_EQ(b.walls[i].corner_b, a.walls[i].corner_b);
    EXPECT_EQ(b.walls[i].thickness_px, a.walls[i].thickness_px);
    EXPECT_EQ(b.walls[i].confidence, a.walls[i].confidence);
    EXPECT_EQ(b.walls[i].by_person, a.walls[i].by_person);
  }
  for (std::size_t i = 0; i < a.corners.size(); ++i) {
    EXPECT_THAT(b.corners[i].p_px, test::IsNearPoint(a.corners[i].p_px, 0));
    EXPECT_EQ(b.corners[i].degree, a.corners[i].degree);
  }
  EXPECT_EQ(b.openings[2].kind, OpeningKind::kPassage);
  EXPECT_EQ(b.signs[0].colour, "green");
  EXPECT_EQ(b.scale->metres_per_pixel, 0.0125);
  EXPECT_TRUE(b.scale->by_person);
  EXPECT_EQ(read->homography.H_layout_photo, sent.homography.H_layout_photo);
  EXPECT_EQ(b.warnings, a.warnings);
}

INSTANTIATE_TEST_SUITE_P(Seeds, LayoutRoundTrip, testing::Range<std::uint64_t>(1, 6));

TEST(LayoutJson, KeepsTheDrawingsOfTheSheetAndWhichOneIsMeant) {
  const auto read = layout_from_json(to_json(random_document(3)));
  ASSERT_TRUE(read.ok());
  ASSERT_EQ(read->layout.drawings.size(), 2U);
  EXPECT_EQ(read->layout.drawings[0].high_px, Point2(300.5, 200));
  EXPECT_TRUE(read->layout.drawings[0].chosen);
  EXPECT_DOUBLE_EQ(read->layout.drawings[1].score, 0.25);
  EXPECT_FALSE(layout_from_json(R"({"size":[9,9],"walls":[],"drawings":[{"score":1}]})").ok());
  EXPECT_FALSE(layout_from_json(R"({"size":[9,9],"walls":[],"drawings":[{"box":[1,2,3]}]})").ok());
}

TEST(LayoutJson, JoinsTheEndsOfWallsThatTouchWhereCornersAreNotGiven) {
  const auto read = layout_from_json(
      R"({"size": [100, 80], "walls": [[0,0,50,0,3], [50.5,0.5,50,40], [50,41,0,0.2,2], [9,9,9.5,9]]})");
  ASSERT_THAT(read, test::IsOk());
  EXPECT_EQ(read->layout.walls.size(), 3u) << "what is shorter than a corner is no wall";
  EXPECT_EQ(read->layout.corners[0].degree, 2);
  EXPECT_EQ(read->layout.walls[2].corner_b, 0);
  EXPECT_FALSE(read->layout.scale.has_value());
}

TEST(LayoutJson, NamesTheFieldThatIsWrong) {
  const auto complaint = [](const std::string& fields) {
    const auto read = layout_from_json("{\"size\": [10, 10], \"walls\": [[0,0,5,5,1]]" + fields + "}");
    return read.ok() ? std::string("fine") : read.error().message;
  };
  EXPECT_EQ(complaint(""), "fine");
  EXPECT_THAT(complaint(R"(, "wall_corners": [[0, 1]])"), testing::HasSubstr("wall_corners names a corner"));
  EXPECT_THAT(complaint(R"(, "corners": [[1,1],[2,2]], "wall_corners": [[0, 0.5]])"),
              testing::HasSubstr("wall_corners"));
  EXPECT_THAT(complaint(R"(, "corners": [[1,1],[2,2]], "wall_corners": [[1, 1]])"), testing::HasSubstr("to itself"));
  EXPECT_THAT(complaint(R"(, "doors": [[1,2,3]])"), testing::HasSubstr("doors"));
  EXPECT_THAT(complaint(R"(, "metres_per_pixel": -1)"), testing::HasSubstr("metres_per_pixel"));
  EXPECT_THAT(complaint(R"(, "metres_per_pixel": "wide")"), testing::HasSubstr("metres_per_pixel"));
  EXPECT_THAT(complaint(R"(, "rooms": [7])"), testing::HasSubstr("rooms"));
  EXPECT_THAT(complaint(R"(, "homography": [1])"), testing::HasSubstr("homography"));
  EXPECT_THAT(complaint(R"(, "doors": [[1,2,3,1e300]])"), testing::HasSubstr("out of range"));
}

TEST(LayoutJson, RefusesWhatIsNoDocument) {
  for (const char* text : {"", "{", "[]", "7", "{}", R"({"size": [10,10]})", R"({"size": [0,10], "walls": []})"})
    EXPECT_THAT(layout_from_json(text), test::Fails(Errc::kCorrupt)) << text;
  EXPECT_THAT(layout_from_json(R"({"size": [1000000,10], "walls": []})"), test::Fails(Errc::kTooLarge));
}

}  // namespace
}  // namespace smokemap
