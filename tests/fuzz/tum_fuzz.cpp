#include <cmath>
#include <string_view>

#include "core/expect.hpp"
#include "recording/trajectory_tum.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;

/// What is read is finite, and is read again from what is written of it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto trajectory = from_tum({reinterpret_cast<const char*>(data), size});
  if (!trajectory) return 0;
  for (const StampedPose& pose : *trajectory) ENGINE_EXPECT(pose.T_map_robot.is_finite());
  const auto again = from_tum(to_tum(*trajectory));
  ENGINE_EXPECT(again.ok() && again->size() == trajectory->size());
  for (std::size_t i = 0; i < again->size(); ++i) ENGINE_EXPECT((*again)[i].stamp == (*trajectory)[i].stamp);
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  return {bytes_of("# time x y z qx qy qz qw\n1479203.123456789 1.5 -2 0 0 0 0.7071068 0.7071068\n2 0 0 0 0 0 0 1\n"),
          bytes_of("0 1e3 -1e-3 0 0 0 -1 0\r\n\r\n-5 0 0 0 0 0 0 1"),
          {}};
}
