#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "recording/limited_child.hpp"
#include "recording/picture_file.hpp"
#include "tests/support/cmyk_jpeg.hpp"
#include "tests/support/pdf_files.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using PictureBytes = std::vector<std::uint8_t>;

std::span<const std::uint8_t> text_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kSlower = 10;
#else
constexpr double kSlower = 1;
#endif

/// Processor time of all children so far.
double children_s() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

// Regression: a page made to keep the renderer busy was drawn for ten seconds before it was refused.
TEST(HostilePdf, IsAnsweredOrRefusedWithinItsProcessorTime) {
  PictureLimits limits;
  limits.pdf_processor_s = 0.12;  // a tenth of a second tells as much as one, in a tenth of the time
  for (const auto& [name, bytes] : test::hostile_pdfs()) {
    const double before = children_s();
    const auto picture = decode_picture(text_bytes(bytes), limits);
    EXPECT_LT(children_s() - before, 0.12 + 0.08 * kSlower) << name;
    EXPECT_TRUE(picture.ok() || !picture.error().message.empty()) << name;
  }
}

TEST(HostilePdf, RefusedForItsTimeIsToldApartFromABrokenOne) {
  PictureLimits limits;
  limits.pdf_processor_s = 0.05;
  const auto slow = decode_picture(text_bytes(test::pdf::nested_forms(12, 10, "")), limits);
  ASSERT_THAT(slow, test::Fails(Errc::kTooLarge));
  EXPECT_NE(slow.error().message.find("patience"), std::string::npos);
  EXPECT_THAT(decode_picture(text_bytes("%PDF-1.4 nothing")), test::Fails(Errc::kCorrupt));
}

TEST(HeavyPdf, IsDrawnForWhoeverHasPatience) {
  const std::string plan = test::pdf::strokes(60'000);
  PictureLimits hasty;
  hasty.pdf_processor_s = 0.03;
  EXPECT_THAT(decode_picture(text_bytes(plan), hasty), test::Fails(Errc::kTooLarge));
  const auto picture = decode_picture(text_bytes(plan), PictureLimits::patient());
  ASSERT_THAT(picture, test::IsOk());
  EXPECT_NEAR(static_cast<double>(picture->total()), 8.2e6, 0.1e6);
}

TEST(HeavyPdf, AnyPageOfManyIsDrawn) {
  PictureLimits limits;
  limits.pdf_megapixels = 0.05;
  const std::string book = test::pdf::pages(500);
  EXPECT_THAT(decode_picture(text_bytes(book), limits, 0), test::IsOk());
  EXPECT_THAT(decode_picture(text_bytes(book), limits, 499), test::IsOk());
  const auto beyond = decode_picture(text_bytes(book), limits, 500);
  ASSERT_THAT(beyond, test::Fails(Errc::kNotFound));
  EXPECT_EQ(beyond.error().message, "this PDF has 500 pages");
}

TEST(LimitedChild, IsEndedAfterItsProcessorTimeAndNotLater) {
  const double before = children_s();
  const auto endless = run_in_limited_child({30, 0.1, 1 << 30}, [] {
    for (volatile int i = 0;;) i = i + 1;
  });
  ASSERT_THAT(endless, test::Fails(Errc::kTooLarge));
  EXPECT_NEAR(children_s() - before, 0.1, 0.05);
}

/// A progressive JPEG whose last pass comes again and again.
PictureBytes jpeg_with_passes(int more) {
  cv::Mat noise(64, 64, CV_8UC3);
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 256);
  PictureBytes bytes;
  cv::imencode(".jpg", noise, bytes, {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  const PictureBytes mark{0xFF, 0xDA};
  const auto last = std::find_end(bytes.begin(), bytes.end(), mark.begin(), mark.end());
  const PictureBytes pass(last, bytes.end() - 2);
  bytes.resize(bytes.size() - 2);
  for (int i = 0; i < more; ++i) bytes.insert(bytes.end(), pass.begin(), pass.end());
  bytes.insert(bytes.end(), {0xFF, 0xD9});
  return bytes;
}

TEST(HostileJpeg, WithMorePassesThanAnyCameraMakesIsRefusedByItsMarks) {
  EXPECT_THAT(read_picture_header(jpeg_with_passes(0)), test::IsOk());
  EXPECT_THAT(decode_picture(jpeg_with_passes(0)), test::IsOk());
  const auto header = read_picture_header(jpeg_with_passes(100));
  ASSERT_THAT(header, test::Fails(Errc::kTooLarge));
  EXPECT_NE(header.error().message.find("passes"), std::string::npos);
}

void expect_flag(const cv::Mat& picture) {
  ASSERT_EQ(picture.size(), cv::Size(32, 16));
  const auto near = [&](int x, int y, const cv::Vec3b& bgr) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.at<cv::Vec3b>(y, x)[c], bgr[c], 16) << x << ", " << y;
  };
  near(3, 3, {0, 255, 0});
  near(12, 12, {0, 0, 255});
  near(24, 8, {255, 0, 0});
}

TEST(CmykJpeg, KeepsItsColoursWhetherStoredAsInksOrAsLuminance) {
  for (const auto& bytes : {test::inverted_cmyk_jpeg(), test::ycck_jpeg()}) {
    const auto picture = decode_picture(bytes);
    ASSERT_THAT(picture, test::IsOk());
    expect_flag(*picture);
  }
}

// Regression: read the wrong way round, white paper was black.
TEST(CmykJpeg, IsRefusedWhenItDoesNotSayHowItsInksAreStored) {
  const auto picture = decode_picture(test::unmarked_cmyk_jpeg());
  ASSERT_THAT(picture, test::Fails(Errc::kUnsupported));
  EXPECT_NE(picture.error().message.find("CMYK"), std::string::npos);
}

TEST(CmykJpeg, CutShortIsReadWithAWarning) {
  auto bytes = test::inverted_cmyk_jpeg();
  bytes.resize(bytes.size() - 8);
  EXPECT_EQ(picture_warnings(bytes).size(), 1U);
  EXPECT_THAT(decode_picture(bytes), test::IsOk());
}

TEST(PictureOfManyMegapixels, IsTakenUpToFortyAndNoFurther) {
  const auto png = [](int width, int height) {
    PictureBytes bytes;
    cv::imencode(".png", cv::Mat(height, width, CV_8UC1, cv::Scalar(255)), bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
    return bytes;
  };
  const auto edge = decode_picture(png(8000, 5000));
  ASSERT_THAT(edge, test::IsOk());
  EXPECT_EQ(edge->size(), cv::Size(8000, 5000));
  const auto over = read_picture_header(png(8000, 5001));
  ASSERT_THAT(over, test::Fails(Errc::kTooLarge));
  EXPECT_NE(over.error().message.find("40 megapixels"), std::string::npos);
}

TEST(PictureWithAlpha, OfSixteenBitOrInWebpLiesOnWhite) {
  cv::Mat deep(4, 4, CV_16UC4, cv::Scalar(0, 0, 0, 0)), glass(16, 16, CV_8UC4, cv::Scalar(0, 0, 0, 0));
  deep.at<cv::Vec4w>(1, 1) = {0, 0, 65535, 65535};
  glass.colRange(8, 16).setTo(cv::Scalar(255, 0, 0, 255));
  PictureBytes png, webp;
  cv::imencode(".png", deep, png);
  cv::imencode(".webp", glass, webp, {cv::IMWRITE_WEBP_QUALITY, 101});
  const auto a = decode_picture(png), b = decode_picture(webp);
  ASSERT_THAT(a, test::IsOk());
  ASSERT_THAT(b, test::IsOk());
  EXPECT_EQ(a->at<cv::Vec3b>(0, 0), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(a->at<cv::Vec3b>(1, 1), cv::Vec3b(0, 0, 255));
  EXPECT_EQ(b->at<cv::Vec3b>(8, 2), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(b->at<cv::Vec3b>(8, 12), cv::Vec3b(255, 0, 0));
}

}  // namespace
}  // namespace smokemap
