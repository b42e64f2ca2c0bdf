#pragma once

#include <unistd.h>

#include <cstdlib>

namespace smokemap::test {

/// A DDS domain for this process alone, so that tests may run side by side; never 0, where real robots are.
inline int ros_domain() {
  if (const char* chosen = std::getenv("SMOKEMAP_TEST_DOMAIN")) return std::atoi(chosen);
  return 1 + static_cast<int>(getpid() % 230);
}

}  // namespace smokemap::test
