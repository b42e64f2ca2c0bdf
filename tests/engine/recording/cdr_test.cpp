#include "recording/cdr.hpp"

#include <gtest/gtest.h>

#include <array>

#include "core/random.hpp"
#include "recording/ros_messages.hpp"

namespace smokemap {
namespace {

TEST(Cdr, AlignsEveryNumberToItsOwnSizeBehindTheHeader) {
  CdrWriter writer;
  writer.number(std::uint8_t{1});
  writer.number(std::uint32_t{2});
  writer.string("ab");
  writer.number(3.0);
  const std::vector<std::uint8_t> expected{0, 1, 0,   0,   1, 0, 0, 0, 2, 0, 0, 0, 3, 0,
                                           0, 0, 'a', 'b', 0, 0, 0, 0, 0, 0, 0, 0, 8, 0x40};
  EXPECT_EQ(writer.bytes(), expected);
  CdrReader reader(writer.bytes());
  EXPECT_EQ(reader.number<std::uint8_t>(), 1);
  EXPECT_EQ(reader.number<std::uint32_t>(), 2u);
  EXPECT_EQ(reader.string(), "ab");
  EXPECT_EQ(reader.number<double>(), 3.0);
  EXPECT_TRUE(reader.ok());
}

TEST(Cdr, ReadsBigEndian) {
  const std::array<std::uint8_t, 16> bytes{0, 0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 2, 0x12, 0x34, 0x56, 0x78};
  CdrReader reader(bytes);
  EXPECT_EQ(reader.number<std::uint32_t>(), 258u);
  EXPECT_EQ(reader.numbers<std::uint16_t>(), (std::vector<std::uint16_t>{0x1234, 0x5678}));
  EXPECT_TRUE(reader.ok());
}

TEST(Cdr, KeepsItsFirstFaultAndReadsZeroFromThenOn) {
  const std::array<std::uint8_t, 12> bytes{0, 1, 0, 0, 255, 255, 255, 255, 7, 0, 0, 0};
  CdrReader reader(bytes);
  EXPECT_TRUE(reader.numbers<float>().empty());
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.number<std::uint32_t>(), 0u) << "although there are four bytes left";
  EXPECT_EQ(reader.string(), "");
  EXPECT_EQ(reader.length(1), 0u);
}

TEST(Cdr, RefusesStringsThatDoNotEnd) {
  for (const std::vector<std::uint8_t>& body :
       {std::vector<std::uint8_t>{0, 1, 0, 0, 2, 0, 0, 0, 'a', 'b'}, std::vector<std::uint8_t>{0, 1, 0, 0, 0, 0, 0, 0},
        std::vector<std::uint8_t>{0, 1, 0, 0, 9, 0, 0, 0, 'a', 0}}) {
    CdrReader reader(body);
    reader.string();
    EXPECT_FALSE(reader.ok());
  }
}

TEST(Cdr, RefusesHeadersOfOtherEncodings) {
  for (const std::vector<std::uint8_t>& header : {std::vector<std::uint8_t>{}, {0, 1}, {0, 2, 0, 0}, {1, 1, 0, 0}})
    EXPECT_FALSE(CdrReader(header).ok());
}

TEST(RosMessages, AreAsLongAsRosWritesThem) {
  LaserScan scan;
  scan.ranges_m.assign(360, 1);
  scan.intensities.assign(360, 1);
  EXPECT_EQ(encode_scan(scan, "laser_link").size(), 4u + 8 + 4 + 12 + 28 + 4 + 1440 + 4 + 1440);
  EXPECT_EQ(encode_odometry({}, "odom", "base_link").size(), 724u) << "as on every real robot's /odom";
}

TEST(RosMessages, AreNothingAtEveryLengthShortOfWhole) {
  const RosTransform transform{5, "base_link", "laser", {1, 2, 3}, Eigen::Quaterniond::Identity()};
  LaserScan scan;
  scan.ranges_m = {1, 2, 3};
  scan.intensities = {4, 5, 6};
  const auto scan_bytes = encode_scan(scan, "laser");
  const auto odometry_bytes = encode_odometry({}, "odom", "base_link");
  const auto transform_bytes = encode_transforms(std::array{transform, transform});
  for (std::size_t n = 0; n < scan_bytes.size(); ++n) EXPECT_FALSE(decode_scan({scan_bytes.data(), n})) << n;
  // The last covariance is not read: what is cut there is still a whole message to us.
  for (std::size_t n = 0; n < odometry_bytes.size() - 36 * 8; ++n)
    EXPECT_FALSE(decode_odometry({odometry_bytes.data(), n})) << n;
  for (std::size_t n = 0; n < transform_bytes.size(); ++n)
    EXPECT_FALSE(decode_transforms({transform_bytes.data(), n})) << n;
  EXPECT_TRUE(decode_scan(scan_bytes) && decode_odometry(odometry_bytes) && decode_transforms(transform_bytes));
}

TEST(RosMessages, SurviveFieldsThatNewerVersionsAppend) {
  auto bytes = encode_odometry({42, "", Pose2(1, 2, 0.5), 0.25, 0}, "odom", "base_link");
  bytes.resize(bytes.size() + 64);
  const auto read = decode_odometry(bytes);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->odometry.stamp, 42);
  EXPECT_NEAR(read->odometry.T_odom_robot.heading(), 0.5, 1e-12);
}

TEST(RosMessages, KeepStampsBefore1970) {
  Odometry odometry;
  odometry.stamp = -1'500'000'001;
  EXPECT_EQ(decode_odometry(encode_odometry(odometry, "odom", "base"))->odometry.stamp, -1'500'000'001);
}

}  // namespace
}  // namespace smokemap
