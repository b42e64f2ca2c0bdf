#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/random.hpp"
#include "layout/sheet.hpp"

namespace smokemap {
namespace {

const SheetCorners kSeenAskew{Point2(120, 90), Point2(830, 150), Point2(790, 560), Point2(160, 500)};

/// Where a place of the unit square is seen.
class Askew {
 public:
  explicit Askew(const SheetCorners& corners) {
    const cv::Point2f from[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    cv::Point2f to[4];
    for (std::size_t i = 0; i < 4; ++i)
      to[i] = {static_cast<float>(corners[i].x()), static_cast<float>(corners[i].y())};
    H_ = cv::getPerspectiveTransform(from, to);
  }
  Point2 operator()(double x, double y) const {
    const cv::Mat p = H_ * (cv::Mat_<double>(3, 1) << x, y, 1);
    return {p.at<double>(0) / p.at<double>(2), p.at<double>(1) / p.at<double>(2)};
  }

 private:
  cv::Mat H_;
};

/// Walls along both directions of the sheet, out to its rim, and some oblique ones.
std::vector<Segment2> plan_lines(const Askew& seen, int oblique, std::uint64_t seed) {
  auto random = random_stream(seed, 0);
  std::vector<Segment2> lines;
  for (const double at : {0.0, 0.2, 0.45, 0.7, 1.0}) {
    lines.push_back({seen(0, at), seen(1, at)});
    lines.push_back({seen(at, 0), seen(at, 1)});
  }
  for (int i = 0; i < oblique; ++i)
    lines.push_back({seen(uniform(random, 0.2, 0.8), uniform(random, 0.2, 0.8)),
                     seen(uniform(random, 0.2, 0.8), uniform(random, 0.2, 0.8))});
  return lines;
}

TEST(VanishingPoints, GiveTheRectangleAroundTheDrawing) {
  const auto proposal = propose_by_vanishing_points(plan_lines(Askew(kSeenAskew), 0, 1), {1000, 700});
  ASSERT_TRUE(proposal.has_value());
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((proposal->corners_px[i] - kSeenAskew[i]).norm(), 2) << i;
  EXPECT_GT(proposal->confidence, 0.3);
  EXPECT_LT(proposal->confidence, 0.9) << "this is not the rim of the sheet";
}

TEST(VanishingPoints, SurviveObliqueWalls) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto proposal = propose_by_vanishing_points(plan_lines(Askew(kSeenAskew), 4, seed), {1000, 700});
    ASSERT_TRUE(proposal.has_value()) << seed;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((proposal->corners_px[i] - kSeenAskew[i]).norm(), 12) << seed;
  }
}

TEST(VanishingPoints, OfAPictureTakenStraightOnAreNone) {
  const SheetCorners straight{Point2(100, 100), Point2(900, 100), Point2(900, 600), Point2(100, 600)};
  EXPECT_FALSE(propose_by_vanishing_points(plan_lines(Askew(straight), 2, 1), {1000, 700}).has_value());
}

TEST(VanishingPoints, NeedTwoFamiliesOfLines) {
  EXPECT_FALSE(propose_by_vanishing_points({}, {1000, 700}).has_value());
  std::vector<Segment2> rows;
  for (int i = 0; i < 8; ++i) rows.push_back({Point2(100, 80 * i), Point2(900, 80 * i + 8 * i)});
  EXPECT_FALSE(propose_by_vanishing_points(rows, {1000, 700}).has_value());
}

TEST(VanishingPoints, OfRandomLinesAreNone) {
  auto random = random_stream(9, 0);
  std::vector<Segment2> lines;
  for (int i = 0; i < 60; ++i)
    lines.push_back({Point2(uniform(random, 0, 1000), uniform(random, 0, 700)),
                     Point2(uniform(random, 0, 1000), uniform(random, 0, 700))});
  EXPECT_FALSE(propose_by_vanishing_points(lines, {1000, 700}).has_value());
}

/// White paper on a gray wall with a hairline along its rim.
cv::Mat paper_with_hairline(const SheetCorners& corners, double inset) {
  cv::Mat photo(1000, 1400, CV_8UC3, cv::Scalar(150, 160, 165));
  const Askew seen(corners);
  const auto at = [&](double x, double y) {
    const Point2 p = seen(x, y);
    return cv::Point(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  };
  cv::fillConvexPoly(photo, std::vector<cv::Point>{at(0, 0), at(1, 0), at(1, 1), at(0, 1)}, cv::Scalar(240, 240, 240),
                     cv::LINE_AA);
  const double i = inset;
  cv::polylines(photo, std::vector<std::vector<cv::Point>>{{at(i, i), at(1 - i, i), at(1 - i, 1 - i), at(i, 1 - i)}},
                true, cv::Scalar(90, 90, 90), 1, cv::LINE_AA);
  return photo;
}

const SheetCorners kPaper{Point2(150, 120), Point2(1260, 160), Point2(1230, 880), Point2(180, 860)};

// Regression: the hairline printed along the rim of our own plans was taken for the rim.
TEST(RefineSheet, GoesFromTheHairlineToTheRim) {
  const cv::Mat photo = paper_with_hairline(kPaper, 0.009);
  const Askew seen(kPaper);
  const double i = 0.009;
  const SheetCorners hairline{seen(i, i), seen(1 - i, i), seen(1 - i, 1 - i), seen(i, 1 - i)};
  const auto refined = refine_sheet(photo, hairline);
  for (std::size_t c = 0; c < 4; ++c) EXPECT_LT((refined.corners_px[c] - kPaper[c]).norm(), 2.5) << c;
}

TEST(RefineSheet, MovesARoughGuessToTheRim) {
  auto random = random_stream(4, 0);
  const cv::Mat photo = paper_with_hairline(kPaper, 0.02);
  for (int trial = 0; trial < 4; ++trial) {
    SheetCorners rough = kPaper;
    for (auto& p : rough) p += Point2(uniform(random, -6, 6), uniform(random, -6, 6));
    const auto refined = refine_sheet(photo, rough);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_LT((refined.corners_px[c] - kPaper[c]).norm(), 2.5) << trial;
  }
}

TEST(RefineSheet, LeavesSidesWithoutARimWhereTheyAre) {
  const cv::Mat blank(600, 800, CV_8UC3, cv::Scalar(200, 200, 200));
  const SheetCorners guess{Point2(100, 100), Point2(700, 100), Point2(700, 500), Point2(100, 500)};
  const auto refined = refine_sheet(blank, guess);
  for (std::size_t c = 0; c < 4; ++c) EXPECT_LT((refined.corners_px[c] - guess[c]).norm(), 1e-6);
  const SheetCorners tiny{Point2(1, 1), Point2(9, 1), Point2(9, 9), Point2(1, 9)};
  EXPECT_EQ(refine_sheet(blank, tiny).corners_px, tiny);
}

double worst_of(const RefinedSheet& refined) {
  double worst = 0;
  for (std::size_t c = 0; c < 4; ++c) worst = std::max(worst, (refined.corners_px[c] - kPaper[c]).norm());
  return worst;
}

/// Paper on a wall, with a strip of a colour around it (beyond its rim) or inside it.
cv::Mat bordered_paper(const cv::Scalar& strip, double outside, double inside,
                       const cv::Scalar& wall = cv::Scalar(150, 160, 165)) {
  cv::Mat photo(1000, 1400, CV_8UC3, wall);
  const Askew seen(kPaper);
  const auto fill = [&](double i, const cv::Scalar& colour) {
    std::vector<cv::Point> ring;
    for (const auto& [x, y] : {std::pair(i, i), {1 - i, i}, {1 - i, 1 - i}, {i, 1 - i}}) {
      const Point2 p = seen(x, y) * 16;
      ring.emplace_back(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
    }
    cv::fillConvexPoly(photo, ring, colour, cv::LINE_AA, 4);
  };
  fill(-outside, strip);
  fill(inside, cv::Scalar(222, 225, 228));
  cv::Mat noise(photo.size(), CV_16SC3), deep;
  cv::RNG(5).fill(noise, cv::RNG::NORMAL, 0, 4);
  photo.convertTo(deep, CV_16SC3);
  deep += noise;
  deep.convertTo(photo, CV_8UC3);
  return photo;
}

TEST(RefineSheet, FindsTheRimToHalfAPixel) {
  const auto refined = refine_sheet(bordered_paper(cv::Scalar(), 0, 0, cv::Scalar(90, 95, 100)), kPaper);
  EXPECT_LT(worst_of(refined), 0.8);
  EXPECT_GT(refined.agreement, 0.9);
  EXPECT_LT(refined.sigma_px, 1);
}

// Regression: a frame printed less than a percent inside the rim was taken for it, on half of all photographs.
TEST(RefineSheet, IsNotMovedToAFramePrintedInsideTheRim) {
  for (const double inset : {0.006, 0.009, 0.012})
    EXPECT_LT(worst_of(refine_sheet(paper_with_hairline(kPaper, inset), kPaper)), 2) << inset;
}

TEST(RefineSheet, APictureFrameIsNotPaper) {
  for (const auto& frame : {cv::Scalar(45, 40, 38), cv::Scalar(60, 95, 130)}) {  // black, wood
    const auto refined = refine_sheet(bordered_paper(frame, 0.012, 0), kPaper);
    EXPECT_LT(worst_of(refined), 1.5) << frame;
    EXPECT_GT(refined.agreement, 0.8);
  }
}

// Regression: a green border at the rim was left outside, as if it were a frame.
TEST(RefineSheet, APrintedBorderIsPartOfTheSheet) {
  for (const auto& border : {cv::Scalar(80, 132, 0), cv::Scalar(40, 30, 200)})
    for (const double width : {0.007, 0.011}) {
      const auto refined = refine_sheet(bordered_paper(border, 0, width), kPaper);
      EXPECT_LT(worst_of(refined), 2.5) << border << width;
    }
}

// A silver frame around paper behind glass looks like a margin around a tinted drawing.
TEST(RefineSheet, IsNotSureWhereAFrameIsBrighterThanPaper) {
  const auto refined =
      refine_sheet(bordered_paper(cv::Scalar(250, 252, 254), 0.014, 0, cv::Scalar(90, 95, 100)), kPaper);
  EXPECT_TRUE(worst_of(refined) < 3 || refined.agreement < 0.7) << worst_of(refined) << " " << refined.agreement;
}

// Regression: the outer edge of a picture frame as bright as paper was the sheet's rim, and sure.
TEST(ProposeSheet, IsNotSureOfAFrameAsBrightAsPaper) {
  for (const int frame : {250, 212, 190})
    for (const double width : {0.008, 0.02}) {
      const auto picture = bordered_paper(cv::Scalar(frame, frame + 2, frame + 4), width, 0, cv::Scalar(90, 95, 100));
      const auto proposal = propose_sheet(picture);
      double worst = 0;
      for (std::size_t c = 0; c < 4; ++c) worst = std::max(worst, (proposal.corners_px[c] - kPaper[c]).norm());
      EXPECT_TRUE(worst < 4 || proposal.confidence < 0.7) << frame << " " << width << ": " << worst;
    }
}

TEST(FramedSheet, HasAStepInsideSeveralSides) {
  EXPECT_FALSE(may_be_framed(bordered_paper(cv::Scalar(), 0, 0), kPaper));
  EXPECT_FALSE(may_be_framed(paper_with_hairline(kPaper, 0.012), kPaper)) << "a printed line is no step";
  EXPECT_FALSE(may_be_framed(bordered_paper(cv::Scalar(80, 132, 0), 0, 0.012), kPaper))
      << "a coloured border is printed";
  EXPECT_TRUE(may_be_framed(bordered_paper(cv::Scalar(250, 252, 254), 0, 0.012), kPaper));
  EXPECT_FALSE(may_be_framed(cv::Mat(40, 40, CV_8UC3), {Point2(1, 1), Point2(9, 1), Point2(9, 9), Point2(1, 9)}));
}

TEST(ProposeSheet, SaysHowFarItsCornersMayBeOff) {
  const auto clear = propose_sheet(bordered_paper(cv::Scalar(), 0, 0, cv::Scalar(70, 75, 80)));
  EXPECT_GT(clear.confidence, 0.9);
  for (std::size_t c = 0; c < 4; ++c)
    EXPECT_LT((clear.corners_px[c] - kPaper[c]).norm(), 3 * clear.sigma_px) << clear.sigma_px;
  const auto faint = propose_sheet(bordered_paper(cv::Scalar(), 0, 0, cv::Scalar(210, 213, 216)));
  EXPECT_LE(faint.confidence, 0.6) << "a wall as white as paper";
}

// Regression: a side just outside the picture was looked up outside its memory.
TEST(ProposeSheet, SurvivesSheetsThatLeaveThePicture) {
  auto random = random_stream(21, 0);
  for (int trial = 0; trial < 6; ++trial) {
    SheetCorners corners = kPaper;
    for (auto& p : corners) p = (p - Point2(700, 500)) * uniform(random, 1.15, 1.4) + Point2(700, 500);
    const auto proposal = propose_sheet(paper_with_hairline(corners, 0.01));
    for (const auto& p : proposal.corners_px) EXPECT_TRUE(p.allFinite());
  }
}

}  // namespace
}  // namespace smokemap
