#include "recording/picture_file.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "core/random.hpp"
#include "recording/limited_child.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using FileBytes = std::vector<std::uint8_t>;

/// Left half red, right half blue, one green pixel at the top left.
cv::Mat flag(int width = 64, int height = 32) {
  cv::Mat picture(height, width, CV_8UC3, cv::Scalar(0, 0, 255));
  picture.colRange(width / 2, width).setTo(cv::Scalar(255, 0, 0));
  picture.rowRange(0, 8).colRange(0, 8).setTo(cv::Scalar(0, 255, 0));
  return picture;
}

FileBytes encoded(const char* extension, const cv::Mat& picture) {
  FileBytes bytes;
  cv::imencode(extension, picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 100});
  return bytes;
}

void expect_colour(const cv::Mat& picture, int x, int y, const cv::Vec3b& bgr) {
  const cv::Vec3b got = picture.at<cv::Vec3b>(y, x);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], bgr[c], 12) << "at " << x << ", " << y;
}

const cv::Vec3b kRed(0, 0, 255), kBlue(255, 0, 0), kGreen(0, 255, 0), kWhite(255, 255, 255);

class PictureOf : public testing::TestWithParam<const char*> {};

TEST_P(PictureOf, TellsItsSizeBeforeItIsDecodedAndComesAsBgr) {
  const FileBytes bytes = encoded(GetParam(), flag());
  const auto header = read_picture_header(bytes);
  ASSERT_THAT(header, test::IsOk());
  EXPECT_EQ(header->width_px, 64);
  EXPECT_EQ(header->height_px, 32);
  const auto picture = decode_picture(bytes);
  ASSERT_THAT(picture, test::IsOk());
  ASSERT_EQ(picture->type(), CV_8UC3);
  ASSERT_EQ(picture->size(), cv::Size(64, 32));
  expect_colour(*picture, 3, 3, kGreen);
  expect_colour(*picture, 20, 20, kRed);
  expect_colour(*picture, 50, 20, kBlue);
}

TEST_P(PictureOf, IsRefusedByItsHeaderWhenTooLarge) {
  const FileBytes bytes = encoded(GetParam(), flag());
  PictureLimits few_pixels, few_bytes;
  few_pixels.max_megapixels = few_pixels.pdf_megapixels = 0.002;
  few_bytes.max_bytes = 50;
  EXPECT_THAT(read_picture_header(bytes, few_pixels), test::Fails(Errc::kTooLarge));
  EXPECT_THAT(decode_picture(bytes, few_bytes), test::Fails(Errc::kTooLarge));
}

TEST_P(PictureOf, NeverHarmsUsWhenItIsDamaged) {
  const FileBytes whole = encoded(GetParam(), flag());
  std::mt19937_64 random(11);
  for (int i = 0; i < 25; ++i) {
    FileBytes bytes = whole;
    for (int wound = 0; wound < 3; ++wound)
      bytes[uniform_index(random, bytes.size())] = static_cast<std::uint8_t>(random());
    if (i % 3 == 0) bytes.resize(uniform_index(random, bytes.size()));
    const auto picture = decode_picture(bytes);
    if (picture.ok())
      EXPECT_EQ(picture->type(), CV_8UC3);
    else
      EXPECT_FALSE(picture.error().message.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Types, PictureOf, testing::Values(".png", ".jpg", ".webp"));

TEST(PictureFile, TakesGrayAndSixteenBitAndLaysTransparencyOnWhite) {
  const auto gray = decode_picture(encoded(".png", cv::Mat(4, 4, CV_8UC1, cv::Scalar(200))));
  ASSERT_THAT(gray, test::IsOk());
  expect_colour(*gray, 1, 1, {200, 200, 200});
  const auto deep = decode_picture(encoded(".png", cv::Mat(4, 4, CV_16UC3, cv::Scalar(0, 32768, 65535))));
  ASSERT_THAT(deep, test::IsOk());
  expect_colour(*deep, 1, 1, {0, 128, 255});
  cv::Mat glass(4, 4, CV_8UC4, cv::Scalar(0, 0, 0, 0));
  glass.at<cv::Vec4b>(1, 1) = {0, 0, 255, 255};
  glass.at<cv::Vec4b>(2, 2) = {0, 0, 0, 128};
  const auto clear = decode_picture(encoded(".png", glass));
  ASSERT_THAT(clear, test::IsOk());
  expect_colour(*clear, 0, 0, kWhite);
  expect_colour(*clear, 1, 1, kRed);
  expect_colour(*clear, 2, 2, {127, 127, 127});
}

/// A JPEG with an EXIF segment that asks for a turn.
FileBytes turned_jpeg(std::uint8_t orientation) {
  const FileBytes plain = encoded(".jpg", flag());
  const FileBytes exif{0xFF, 0xE1, 0, 34, 'E', 'x', 'i', 'f', 0, 0, 'M', 'M',         0, 42, 0, 0, 0, 8,
                       0,    1,    1, 18, 0,   3,   0,   0,   0, 1, 0,   orientation, 0, 0,  0, 0, 0, 0};
  FileBytes bytes(plain.begin(), plain.begin() + 2);
  bytes.insert(bytes.end(), exif.begin(), exif.end());
  bytes.insert(bytes.end(), plain.begin() + 2, plain.end());
  return bytes;
}

TEST(PictureFile, StandsUprightAsExifAsks) {
  const auto quarter = decode_picture(turned_jpeg(6));  // to be turned clockwise by 90 degrees
  ASSERT_THAT(quarter, test::IsOk());
  ASSERT_EQ(quarter->size(), cv::Size(32, 64));
  expect_colour(*quarter, 28, 3, kGreen);
  expect_colour(*quarter, 10, 20, kRed);
  expect_colour(*quarter, 10, 50, kBlue);
  const auto half = decode_picture(turned_jpeg(3));
  ASSERT_THAT(half, test::IsOk());
  expect_colour(*half, 60, 28, kGreen);
}

/// One page of 144 x 72 points with a red box in its lower left quarter.
FileBytes pdf() {
  const std::string text =
      "%PDF-1.4\n1 0 obj<</Type/Catalog/Pages 2 0 R>>endobj\n2 0 obj<</Type/Pages/Kids[3 0 R]/Count 1>>endobj\n"
      "3 0 obj<</Type/Page/Parent 2 0 R/MediaBox[0 0 144 72]/Contents 4 0 R>>endobj\n"
      "4 0 obj<</Length 27>>stream\n1 0 0 rg 0 0 72 36 re f    \nendstream endobj\ntrailer<</Root 1 0 R>>\n%%EOF\n";
  return {text.begin(), text.end()};
}

TEST(PictureFile, DrawsAPageOfAPdfAtTheAskedResolution) {
  PictureLimits limits;
  limits.pdf_megapixels = 0.5;
  const auto page = decode_picture(pdf(), limits);
  ASSERT_THAT(page, test::IsOk());
  EXPECT_NEAR(static_cast<double>(page->total()), 0.5e6, 0.01e6);
  EXPECT_EQ(page->cols, 2 * page->rows);
  expect_colour(*page, page->cols / 4, page->rows * 3 / 4, kRed);
  expect_colour(*page, page->cols * 3 / 4, page->rows / 4, kWhite);
  EXPECT_THAT(decode_picture(pdf(), limits, 1), test::Fails(Errc::kNotFound));
  FileBytes broken = pdf();
  broken.resize(60);
  EXPECT_THAT(decode_picture(broken), test::Fails(Errc::kCorrupt));
}

TEST(PictureFile, CutJpegsAreReadWithAWarning) {
  cv::Mat noise(200, 300, CV_8UC3);
  cv::RNG(5).fill(noise, cv::RNG::UNIFORM, 0, 256);
  for (const bool progressive : {false, true}) {
    FileBytes whole;
    cv::imencode(".jpg", noise, whole, {cv::IMWRITE_JPEG_PROGRESSIVE, progressive});
    EXPECT_TRUE(picture_warnings(whole).empty()) << progressive;
    FileBytes with_more = whole;  // cameras put previews and the like behind the picture
    with_more.insert(with_more.end(), {1, 2, 3, 0xFF, 0xDA, 9});
    EXPECT_TRUE(picture_warnings(with_more).empty()) << progressive;
    FileBytes cut = whole;
    cut.resize(cut.size() * 2 / 3);
    EXPECT_EQ(picture_warnings(cut).size(), 1U) << progressive;
    EXPECT_THAT(decode_picture(cut), test::IsOk());
  }
  EXPECT_TRUE(picture_warnings(encoded(".png", noise)).empty());
  EXPECT_TRUE(picture_warnings(FileBytes{}).empty());
}

TEST(PictureFile, WarningsNeverReadBeyondTheFile) {
  const FileBytes whole = turned_jpeg(6);
  for (std::size_t length = 0; length <= whole.size(); ++length) (void)picture_warnings(std::span(whole).first(length));
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    FileBytes bytes = whole;
    for (int wound = 0; wound < 4; ++wound)
      bytes[uniform_index(random, bytes.size())] = static_cast<std::uint8_t>(random());
    (void)picture_warnings(bytes);
  }
}

TEST(PictureFile, SaysOfATiffWhatToDo) {
  for (const std::string& head : {std::string("II*\0\x08\0\0\0", 8), std::string("MM\0*\0\0\0\x08", 8)}) {
    const auto picture = decode_picture(FileBytes(head.begin(), head.end()));
    ASSERT_THAT(picture, test::Fails(Errc::kUnsupported));
    EXPECT_NE(picture.error().message.find("TIFF"), std::string::npos);
  }
}

TEST(PictureFile, TakesNothingElse) {
  for (const std::string& text :
       {std::string("GIF89a......"), std::string("<svg/>"), std::string("BM6"), std::string()})
    EXPECT_THAT(read_picture_header(FileBytes(text.begin(), text.end())), test::Fails(Errc::kUnsupported)) << text;
  EXPECT_THAT(decode_picture(encoded(".png", flag()), {}, 3), test::Fails(Errc::kNotFound));
}

TEST(PictureFile, RefusesABombByItsHeaderWithinMilliseconds) {
  FileBytes bytes = encoded(".png", flag());
  bytes[16] = 0, bytes[17] = 0, bytes[18] = 0x75, bytes[19] = 0x30;  // 30 000 across
  bytes[20] = 0, bytes[21] = 0, bytes[22] = 0x75, bytes[23] = 0x30;
  EXPECT_THAT(decode_picture(bytes), test::Fails(Errc::kTooLarge));
}

TEST(LimitedChild, SaysWhenItsWorkCrashesThrowsOrNeverEnds) {
  EXPECT_THAT(run_in_limited_child({}, [] {}), test::IsOk());
  EXPECT_THAT(run_in_limited_child({}, [] { std::abort(); }), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(run_in_limited_child({}, [] { throw 7; }), test::Fails(Errc::kCorrupt));
  const auto endless = run_in_limited_child({0.2, 5, 1 << 30}, [] {
    for (std::atomic<int> i = 0;; ++i) continue;
  });
  ASSERT_THAT(endless, test::Fails(Errc::kTooLarge));
  EXPECT_EQ(endless.error().message, "took longer than it may");
}

TEST(LimitedChild, MayNotTakeMoreMemoryThanItsShare) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers own the address space";
#endif
  const auto greedy = run_in_limited_child({5, 5, 64 << 20}, [] {
    std::vector<std::uint8_t> much(std::size_t{512} << 20, 1);
    if (much[7] != 1) std::abort();
  });
  EXPECT_THAT(greedy, test::Fails(Errc::kCorrupt));
}

TEST(LimitedChild, LeavesItsAnswerInSharedMemory) {
  const SharedMemory memory(16);
  ASSERT_THAT(run_in_limited_child({}, [&] { memory.bytes()[3] = 42; }), test::IsOk());
  EXPECT_EQ(memory.bytes()[3], 42);
}

TEST(PictureFile, IsDecodedByManyThreadsAtOnce) {
  const FileBytes bytes = encoded(".png", flag());
  std::vector<std::thread> threads;
  std::atomic<int> good = 0;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      for (int round = 0; round < 5; ++round) good += decode_picture(bytes).ok();
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(good, 40);
}

}  // namespace
}  // namespace smokemap
