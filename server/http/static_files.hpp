#pragma once

#include <map>
#include <mutex>
#include <string>

#include "server/http/message.hpp"

namespace smokemap::server {

/// The built web app. Paths outside the folder do not exist; paths without a dot that are no file give index.html, so
/// that the app may have addresses of its own. Texts are gzipped once and kept. Thread-safe.
class StaticFiles {
 public:
  explicit StaticFiles(const std::string& root);

  Response get(const Request& request);

 private:
  struct Entry {
    std::string stamp;  ///< time and size of the file; also the ETag, weak: it is the same packed and plain
    SharedBytes plain;
    SharedBytes gzipped;  ///< null when that is no smaller
  };
  std::optional<Entry> load(const std::string& file);
  std::string root_;
  std::mutex mutex_;
  std::map<std::string, Entry> cache_;
};

/// By the ending of the name; application/octet-stream when unknown.
std::string media_type_of(std::string_view path);

}  // namespace smokemap::server
