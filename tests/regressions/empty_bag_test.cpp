// An empty db3 bag handed over in memory was copied from a null pointer (undefined, found by the sanitizer).

#include <gtest/gtest.h>

#include "recording/rosbag2_db3.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

TEST(EmptyBag, InMemoryIsRefused) {
  RosLogBuilder builder;
  EXPECT_FALSE(read_db3(std::span<const std::uint8_t>{}, builder));
}

}  // namespace
}  // namespace smokemap
