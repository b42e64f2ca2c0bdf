#pragma once

#include <string>
#include <string_view>

#include "core/result.hpp"

namespace smokemap::server {

/// SHA-256 as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);
bool is_sha256_hex(std::string_view text);

/// Files by the hash of their content, DATA/files/<sha256>. A file is there whole or not at all: it is written beside,
/// synced and renamed. Names never come from outside. Thread-safe.
class FileStore {
 public:
  /// Clears away what a crash left half written. One process owns a folder.
  static Result<FileStore> open(const std::string& folder);

  /// Returns the hash. The same bytes again write nothing, unless those that are there were damaged.
  Result<std::string> put(std::string_view bytes) const;
  /// kNotFound; kCorrupt when the bytes no longer have their hash.
  Result<std::string> get(std::string_view sha256) const;

 private:
  explicit FileStore(std::string folder) : folder_(std::move(folder)) {}
  std::string folder_;
};

}  // namespace smokemap::server
