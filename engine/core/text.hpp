#pragma once

#include <cstddef>
#include <string_view>

namespace smokemap {

/// Characters (code points) of UTF-8 text: what people count, where bytes punish every alphabet but the Latin one.
/// Bytes that are no UTF-8 count as at least a quarter of a character each, so that a limit on characters limits bytes.
constexpr std::size_t characters(std::string_view text) {
  std::size_t starts = 0;
  for (const char c : text) starts += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  const std::size_t least = (text.size() + 3) / 4;
  return starts < least ? least : starts;
}

}  // namespace smokemap
