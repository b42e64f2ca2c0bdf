#include "simulation/plan_drafting.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "simulation/plan_picture.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

double ink_share(const PlanCanvas& canvas, const cv::Rect& where) {
  cv::Mat gray;
  cv::cvtColor(canvas.picture(), gray, cv::COLOR_BGR2GRAY);
  return 1 - cv::mean(gray(where))[0] / 255;
}

TEST(PlanDrafting, ClipsALineToARing) {
  const Polygon square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  const Segment2 inside = clipped_line(square, {5, 5}, {1, 0});
  EXPECT_NEAR(inside.length(), 10, 1e-9);
  EXPECT_THAT(inside.midpoint(), test::IsNearPoint(Point2(5, 5), 1e-9));
  EXPECT_EQ(clipped_line(square, {5, 20}, {1, 0}).length(), 0);
}

TEST(PlanDrafting, HatchesBetweenTheFaces) {
  const std::vector<Polygon> wall{{{20, 40}, {180, 40}, {180, 60}, {20, 60}}};
  const cv::Rect body(30, 44, 140, 12);
  double share[3] = {};
  for (const WallFill fill : {WallFill::kSolid, WallFill::kHatched, WallFill::kHollow}) {
    PlanCanvas canvas(200, 100);
    draw_cut_walls(canvas, wall, fill, 2, 8);
    share[static_cast<int>(fill)] = ink_share(canvas, body);
    EXPECT_GT(ink_share(canvas, {30, 40, 140, 2}), 0.6) << "the face";
    EXPECT_NEAR(ink_share(canvas, {30, 70, 140, 20}), 0, 1e-9) << "nothing beside the wall";
  }
  EXPECT_GT(share[static_cast<int>(WallFill::kSolid)], 0.85);
  EXPECT_LT(share[static_cast<int>(WallFill::kHollow)], 0.01);
  EXPECT_NEAR(share[static_cast<int>(WallFill::kHatched)], 0.24, 0.08) << "1.6 of 8 pixels, and soft edges";
}

TEST(PlanDrafting, MeasuresFromTickToTick) {
  PlanCanvas canvas(400, 200);
  draw_dimensions(canvas, {{100, 150}, {300, 150}}, {{0, 100}, {1, 100}}, true, 1, 0.02);
  EXPECT_GT(ink_share(canvas, {120, 100, 160, 1}), 0.3) << "the line";
  EXPECT_GT(ink_share(canvas, {100, 115, 1, 25}), 0.3) << "what leads to it";
  EXPECT_NEAR(ink_share(canvas, {320, 90, 60, 20}), 0, 1e-9) << "it ends behind the last tick";
  draw_dimensions(canvas, {{100, 150}}, {{0, 40}, {1, 40}}, true, 1, 0.02);
  EXPECT_NEAR(ink_share(canvas, {0, 30, 400, 20}), 0, 1e-9) << "one place has no distance";
}

TEST(PlanDrafting, RulesTheWholePaper) {
  PlanCanvas plain(400, 300), lines(400, 300), squares(400, 300);
  rule_paper(plain, PaperRuling::kNone, 20, 1), rule_paper(lines, PaperRuling::kLines, 20, 1);
  rule_paper(squares, PaperRuling::kSquares, 20, 1);
  EXPECT_NEAR(ink_share(plain, {0, 0, 400, 300}), 0, 1e-9);
  EXPECT_GT(ink_share(lines, {0, 10, 400, 1}), 0.1);
  EXPECT_NEAR(ink_share(lines, {0, 15, 400, 10}), 0, 1e-9);
  EXPECT_GT(ink_share(squares, {0, 0, 400, 300}), 1.8 * ink_share(lines, {0, 0, 400, 300}));
}

TEST(PlanDrafting, OnlyWhatIsAskedForChangesThePicture) {
  const FloorPlan plan = two_room_building();
  const auto sheet = [&](const PlanPictureParams& params) {
    std::mt19937_64 random(4);
    const auto picture = draw_plan(plan, params, random);
    EXPECT_THAT(picture, test::IsOk());
    return picture ? picture->sheet : cv::Mat();
  };
  PlanPictureParams plain, hatched, ruled;
  hatched.wall_fill = WallFill::kHatched, ruled.ruling = PaperRuling::kLines;
  EXPECT_EQ(cv::norm(sheet(plain), sheet(plain), cv::NORM_L1), 0);
  EXPECT_GT(cv::norm(sheet(plain), sheet(hatched), cv::NORM_L1), 0);
  EXPECT_GT(cv::norm(sheet(plain), sheet(ruled), cv::NORM_L1), 0);
  PlanPictureParams bad;
  bad.hatch_spacing = 0;
  std::mt19937_64 random(4);
  EXPECT_FALSE(draw_plan(plan, bad, random));
}

}  // namespace
}  // namespace smokemap
