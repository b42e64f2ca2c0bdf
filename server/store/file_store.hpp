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
  static Result<FileStore> open(const std::string& folder);

  /// Returns the hash. Storing the same bytes again is free.
  Result<std::string> put(std::string_view bytes) const;
  /// kNotFound; kCorrupt when the bytes no longer have their hash.
  Result<std::string> get(std::string_view sha256) const;

 private:
  explicit FileStore(std::string folder) : folder_(std::move(folder)) {}
  std::string folder_;
};

}  // namespace smokemap::server
