#pragma once

#include <cstdint>
#include <span>

#include "core/result.hpp"
#include "recording/ros_log_builder.hpp"

namespace smokemap {

/// Adds the messages of an MCAP file (chunks plain, lz4 or zstd) in file order. Reads records one after the other and
/// needs no index, so that a file cut anywhere gives everything before the cut, with a warning. Sums of chunks are
/// checked: a chunk whose sum is wrong is left out and counted. kCorrupt without the magic bytes.
Result<Ok> read_mcap(std::span<const std::uint8_t> bytes, RosLogBuilder& builder);

bool looks_like_mcap(std::span<const std::uint8_t> bytes);

}  // namespace smokemap
