#pragma once

#include <cstddef>

namespace smokemap {

/// Sizes in bytes: `64_KiB`, `25_MiB`.
constexpr std::size_t operator""_KiB(unsigned long long count) { return static_cast<std::size_t>(count) << 10; }
constexpr std::size_t operator""_MiB(unsigned long long count) { return static_cast<std::size_t>(count) << 20; }

}  // namespace smokemap
