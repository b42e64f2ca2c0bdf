#include "core/expect.hpp"
#include "recording/carmen_log.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  (void)looks_like_carmen(text);
  const auto log = read_carmen(text);
  if (!log) return 0;
  for (const LogItem& item : log->items) {
    if (const auto* scan = std::get_if<LaserScan>(&item)) ENGINE_EXPECT(check(*scan).ok());
    if (const auto* odometry = std::get_if<Odometry>(&item)) ENGINE_EXPECT(odometry->T_odom_robot.is_finite());
  }
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  return {bytes_of("# CARMEN Logfile\nPARAM laser_front_laser_fov 180\nPARAM robot_front_laser_max 50.0\n"
                   "ODOM 1.0 2.0 0.5 0.1 0.2 0 10.5 host 1\n"
                   "FLASER 4 1.5 2.5 3.5 81.83 1.0 2.0 0.5 1.0 2.0 0.5 11.25 host 2\n"),
          bytes_of("ROBOTLASER1 4 -1.57 3.14 1.57 30 0.1 0 3 1 2 40 3 7 8 9 1 2 0.1 1 2 0.1 0 0 0.3 0.3 1 12.5 host 3\n"
                   "TRUEPOS 1 2 3\nODOM 0 0 0 0 0 0 5 h 5\n")};
}
