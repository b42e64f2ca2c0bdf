#pragma once

#include <array>
#include <cstdint>

namespace smokemap {

/// MCAP: magic, then records of {kind u8, length u64, body}, then magic again (mcap.dev/spec, version 0). Little
/// endian.
inline constexpr std::array<std::uint8_t, 8> kMcapMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

enum class McapOp : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

inline constexpr std::uint64_t kMostChunkBytes = std::uint64_t{1} << 30;

}  // namespace smokemap
