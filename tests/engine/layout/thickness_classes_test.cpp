#include "layout/thickness_classes.hpp"

#include <gtest/gtest.h>

#include "layout/wall_strokes.hpp"

namespace smokemap {
namespace {

InkStroke piece(double x1, double y1, double x2, double y2, double thickness) {
  InkStroke s;
  s.axis = {Point2(x1, y1), Point2(x2, y2)};
  s.thickness_px = thickness, s.coverage = 1, s.darkness = 1;
  return s;
}

TEST(WeightedQuantile, IsTheValueBelowWhichTheShareOfTheWeightLies) {
  EXPECT_EQ(weighted_quantile({}, 0.5), 0);
  EXPECT_EQ(weighted_quantile({{7, 1}}, 0.9), 7);
  EXPECT_EQ(weighted_quantile({{3, 1}, {1, 5}, {2, 4}}, 0.5), 1);
  EXPECT_EQ(weighted_quantile({{3, 1}, {1, 5}, {2, 4}}, 0.6), 2);
  EXPECT_EQ(weighted_quantile({{3, 1}, {1, 5}, {2, 4}}, 1), 3);
}

TEST(ThicknessClasses, PartWallsFromThinLines) {
  std::vector<InkStroke> plan;
  for (int i = 0; i < 8; ++i) plan.push_back(piece(0, 100.0 * i, 700, 100.0 * i, 12));
  for (int i = 0; i < 20; ++i) plan.push_back(piece(50.0 * i, 0, 50.0 * i, 60, 1.5));
  const auto classes = thickness_classes(plan, LayoutParams{});
  EXPECT_NEAR(classes.usual_px, 12, 0.1);
  EXPECT_GT(classes.thin_limit_px, 1.6);
  EXPECT_LT(classes.thin_limit_px, 11);
}

// Regression: a property line close beside hollow outer walls was filled together with them; half of the plan was lost.
TEST(DashDotLines, OfAPictureAreFoundAndWallsAreNot) {
  std::vector<InkStroke> strokes{piece(100, 120, 1500, 120, 3), piece(100, 130, 1500, 130, 3)};
  std::size_t dashes = 0;
  for (double x = 100; x < 1400; x += 150, dashes += 2) {
    strokes.push_back(piece(x, 100, x + 100, 100, 10));
    strokes.push_back(piece(x + 118, 100, x + 132, 100, 10));
  }
  const auto found = dash_dot_lines(strokes, {1600, 1000}, LayoutParams{});
  EXPECT_EQ(found.size(), dashes);
  for (const auto& s : found) EXPECT_EQ(s.thickness_px, 10);
  EXPECT_EQ(without_dash_dot_lines(strokes).size(), 2U);
}

}  // namespace
}  // namespace smokemap
