#pragma once

#include <cstdlib>
#include <string_view>

namespace smokemap::bench {

/// The number after `--seeds`, for benchmarks without other options.
inline int seeds_option(int argc, char** argv, int otherwise) {
  for (int i = 1; i + 1 < argc; ++i)
    if (std::string_view(argv[i]) == "--seeds") return std::atoi(argv[i + 1]);
  return otherwise;
}

}  // namespace smokemap::bench
