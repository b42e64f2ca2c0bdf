#include "app/picture_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "tests/support/result_matchers.hpp"

namespace smokemap::app {
namespace {

/// White with a black upper left corner, 48 x 32.
cv::Mat marked() {
  cv::Mat picture(32, 48, CV_8UC3, cv::Scalar(255, 255, 255));
  picture.rowRange(0, 16).colRange(0, 16).setTo(0);
  return picture;
}

std::string encoded_as(const char* extension) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, marked(), bytes);
  return {bytes.begin(), bytes.end()};
}

std::string segment(char marker, const std::string& data) {
  const std::size_t length = data.size() + 2;
  return std::string{'\xFF', marker, static_cast<char>(length >> 8), static_cast<char>(length & 0xFF)} + data;
}

/// As a telephone writes it: to be turned by a quarter, with a place, a note and a maker's block.
std::string telephone_jpeg() {
  const std::string exif("Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0", 32);
  std::string bytes = encoded_as(".jpg");
  bytes.insert(2, segment('\xE1', exif + "GPSLatitude 52.3744") +
                      segment('\xE1', "http://ns.adobe.com/xap/1.0/ <exif:GPSLongitude>9.7385") +
                      segment('\xFE', "taken by somebody"));
  return bytes;
}

void expect_nothing_private(const std::string& bytes) {
  for (const char* trace : {"Exif", "GPS", "adobe", "somebody", "tEXt", "eXIf"})
    EXPECT_EQ(bytes.find(trace), std::string::npos) << trace;
}

cv::Mat decoded(const std::string& bytes) {
  return cv::imdecode(std::vector<std::uint8_t>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
}

TEST(PictureReader, KeepsAPictureWithoutThePlaceWhereItWasTaken) {
  const auto kept = PictureReader().clean(telephone_jpeg(), 1, false);
  ASSERT_THAT(kept, test::IsOk());
  EXPECT_EQ(kept->media_type, "image/jpeg");
  expect_nothing_private(kept->bytes);
}

TEST(PictureReader, KeepsItUprightSinceNothingTellsTheTurnAnyMore) {
  const auto kept = PictureReader().clean(telephone_jpeg(), 1, false);
  ASSERT_THAT(kept, test::IsOk());
  EXPECT_EQ(kept->width_px, 32);
  EXPECT_EQ(kept->height_px, 48);
  const cv::Mat picture = decoded(kept->bytes);
  ASSERT_EQ(picture.size(), cv::Size(32, 48));
  EXPECT_LT(picture.at<cv::Vec3b>(8, 24)[0], 60) << "turned clockwise, the corner is at the top right";
  EXPECT_GT(picture.at<cv::Vec3b>(8, 8)[0], 200);
}

TEST(PictureReader, KeepsADrawingWithoutItsNotes) {
  std::string png = encoded_as(".png");
  // with a wrong checksum: decoders skip it or refuse
  const std::string chunk = std::string("\0\0\0\x0C", 4) + "tEXtby somebody " + std::string(4, '\0');
  png.insert(33, chunk);
  const auto kept = PictureReader().clean(png, 1, false);
  if (kept) expect_nothing_private(kept->bytes);
  const auto plain = PictureReader().clean(encoded_as(".png"), 1, false);
  ASSERT_THAT(plain, test::IsOk());
  EXPECT_EQ(plain->media_type, "image/png");
  EXPECT_EQ(cv::norm(decoded(plain->bytes), marked(), cv::NORM_INF), 0);
}

TEST(PictureReader, SaysThatAPictureIsCutOff) {
  std::string bytes = encoded_as(".jpg");
  EXPECT_TRUE(PictureReader().clean(bytes, 1, false)->warnings.empty());
  bytes.resize(bytes.size() - 10);
  const auto kept = PictureReader().clean(bytes, 1, false);
  ASSERT_THAT(kept, test::IsOk());
  EXPECT_EQ(kept->warnings.size(), 1U);
}

TEST(PictureReader, PassesOnWhyAFileIsRefused) {
  PictureReader reader;
  EXPECT_THAT(reader.clean("GIF89a", 1, false), test::Fails(Errc::kUnsupported));
  EXPECT_THAT(reader.clean(encoded_as(".png"), 2, true), test::Fails(Errc::kNotFound));
  EXPECT_THAT(reader.read_layout("GIF89a", {}), test::Fails(Errc::kUnsupported));
  EXPECT_THAT(reader.read_sketch_photo(""), test::Fails(Errc::kUnsupported));
  EXPECT_THAT(reader.read_layout(encoded_as(".png"), {}), test::Fails(Errc::kDegenerate)) << "no walls in it";
}

TEST(PictureReader, GivesTheSameBytesEveryTime) {
  const std::string bytes = telephone_jpeg();
  EXPECT_EQ(PictureReader().clean(bytes, 1, false)->bytes, PictureReader().clean(bytes, 1, false)->bytes);
}

}  // namespace
}  // namespace smokemap::app
