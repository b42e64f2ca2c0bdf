#include <random>

#include "core/expect.hpp"
#include "maps/radar_image.hpp"
#include "recording/ros_messages.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;

/// Every decoder sees every input, so that one message taken for another is covered too.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  if (const auto scan = decode_scan(bytes)) {
    ENGINE_EXPECT(scan->scan.ranges_m.size() * sizeof(float) <= size);
    (void)check(scan->scan);
  }
  (void)decode_odometry(bytes);
  if (const auto transforms = decode_transforms(bytes)) ENGINE_EXPECT(transforms->size() <= size);
  if (const auto radar = decode_radar(bytes)) ENGINE_EXPECT(check(radar->sweep).ok());
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  LaserScan scan;
  scan.angle_increment_rad = 0.01;
  scan.range_max_m = 12;
  scan.ranges_m.assign(40, 3.f);
  scan.intensities.assign(40, 5.f);
  RadarSweep sweep;
  sweep.azimuths = 8;
  sweep.bins = 16;
  sweep.azimuth_increment_rad = 0.7;
  sweep.range_resolution_m = 0.05;
  sweep.power.assign(8 * 16, 1.f);
  const RosTransform transform{1, "base_link", "laser", {1, 2, 3}, Eigen::Quaterniond::Identity()};
  return {encode_scan(scan, "laser"), encode_odometry({1, "r", Pose2(1, 2, 3), 0, 0}, "odom", "base_link"),
          encode_transforms(std::vector{transform, transform}), encode_radar(sweep, "radar")};
}
