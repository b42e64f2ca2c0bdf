#pragma once

namespace smokemap {
/// Prints the broken promise and aborts.
[[noreturn]] void broken_promise(const char* condition, const char* file, int line);
}  // namespace smokemap

/// A promise of the caller. Never for data from outside: that gets a Result.
#define ENGINE_EXPECT(condition) \
  ((condition) ? static_cast<void>(0) : ::smokemap::broken_promise(#condition, __FILE__, __LINE__))
