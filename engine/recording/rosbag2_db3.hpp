#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "core/result.hpp"
#include "recording/ros_log_builder.hpp"

namespace smokemap {

/// Adds the messages of one rosbag2 SQLite file, in the order of their record times: tables `topics` and `messages`,
/// which all schema versions share. A damaged file gives what can be read before the damage, with a warning; kCorrupt
/// if that is nothing.
Result<Ok> read_db3(const std::filesystem::path& path, RosLogBuilder& builder);

/// The same from memory (a file that was unpacked).
Result<Ok> read_db3(std::span<const std::uint8_t> bytes, RosLogBuilder& builder);

}  // namespace smokemap
