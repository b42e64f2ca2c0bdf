#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace smokemap {

/// The whole file; a gzip file is unpacked. kTooLarge over `most_bytes` (unpacked), kIo when it cannot be read.
/// A gzip file that ends early gives what could be unpacked and sets `damaged`.
Result<std::vector<std::uint8_t>> read_file(const std::filesystem::path& path, std::size_t most_bytes,
                                            bool* damaged = nullptr);

/// Writes beside the target and renames at the end, so that a file is there whole or not at all.
Result<Ok> write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
Result<Ok> write_file(const std::filesystem::path& path, const std::string& text);

}  // namespace smokemap
