#include "server/http/static_files.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace smokemap::server {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<std::string_view, std::string_view>, 18> kMediaTypes{
    {{".html", "text/html; charset=utf-8"},
     {".js", "text/javascript; charset=utf-8"},
     {".mjs", "text/javascript; charset=utf-8"},
     {".css", "text/css; charset=utf-8"},
     {".json", "application/json"},
     {".map", "application/json"},
     {".webmanifest", "application/manifest+json"},
     {".svg", "image/svg+xml"},
     {".png", "image/png"},
     {".jpg", "image/jpeg"},
     {".jpeg", "image/jpeg"},
     {".webp", "image/webp"},
     {".ico", "image/x-icon"},
     {".woff2", "font/woff2"},
     {".woff", "font/woff"},
     {".wasm", "application/wasm"},
     {".txt", "text/plain; charset=utf-8"},
     {".xml", "application/xml"}}};

bool worth_gzipping(std::string_view media_type) {
  return media_type.starts_with("text/") || media_type.starts_with("application/json") ||
         media_type.starts_with("image/svg") || media_type.starts_with("application/manifest");
}

SharedBytes gzipped_or_null(const std::string& bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY) != Z_OK) return nullptr;
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int status = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END || out.size() >= bytes.size()) return nullptr;
  return std::make_shared<const std::string>(std::move(out));
}

/// The file below `root` that `path` names; empty when it would lie outside.
fs::path inside(const fs::path& root, const std::string& path) {
  if (path.find('\\') != std::string::npos) return {};
  std::error_code failed;
  const fs::path file = fs::weakly_canonical(root / fs::path(path).relative_path(), failed);
  if (failed) return {};
  const auto [end, ignored] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
  return end == root.end() ? file : fs::path();
}

/// The items of a list in a header, without blanks around them.
std::vector<std::string_view> items(std::string_view list) {
  std::vector<std::string_view> found;
  while (!list.empty()) {
    std::string_view item = list.substr(0, list.find(','));
    list.remove_prefix(std::min(list.size(), item.size() + 1));
    item.remove_prefix(std::min(item.find_first_not_of(" \t"), item.size()));
    item = item.substr(0, item.find_last_not_of(" \t") + 1);
    if (!item.empty()) found.push_back(item);
  }
  return found;
}

/// "gzip" or "*" among the codings, and not with a weight of zero.
bool takes_gzip(std::string_view accept_encoding) {
  for (const std::string_view item : items(accept_encoding)) {
    const std::string_view coding = item.substr(0, item.find_first_of("; \t"));
    if (coding != "gzip" && coding != "*") continue;
    const std::size_t weight = item.find("q=");
    return weight == std::string_view::npos || item.find_first_of("123456789", weight) != std::string_view::npos;
  }
  return false;
}

/// Weak comparison (RFC 9110, 13.1.2): a proxy that packs answers makes tags weak.
bool any_is(std::string_view if_none_match, std::string_view tag) {
  for (std::string_view item : items(if_none_match)) {
    if (item.starts_with("W/")) item.remove_prefix(2);
    if (item == "*" || "W/" + std::string(item) == tag) return true;
  }
  return false;
}

}  // namespace

std::string media_type_of(std::string_view path) {
  for (const auto& [ending, type] : kMediaTypes)
    if (path.ends_with(ending)) return std::string(type);
  return "application/octet-stream";
}

StaticFiles::StaticFiles(const std::string& root) {
  std::error_code failed;
  root_ = root.empty() ? std::string() : fs::weakly_canonical(root, failed).string();
}

std::optional<StaticFiles::Entry> StaticFiles::load(const std::string& file) {
  std::error_code failed;
  if (!fs::is_regular_file(file, failed)) return std::nullopt;
  const auto size = fs::file_size(file, failed);
  const auto time = fs::last_write_time(file, failed).time_since_epoch().count();
  const std::string stamp = "W/\"" + std::to_string(time) + "-" + std::to_string(size) + "\"";
  const std::lock_guard lock(mutex_);
  if (const auto it = cache_.find(file); it != cache_.end() && it->second.stamp == stamp) return it->second;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  Entry entry{
      stamp,
      std::make_shared<const std::string>(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()),
      nullptr};
  if (worth_gzipping(media_type_of(file))) entry.gzipped = gzipped_or_null(*entry.plain);
  return cache_[file] = std::move(entry);
}

Response StaticFiles::get(const Request& request) {
  const fs::path root(root_);
  const std::string asked = request.path == "/" ? "/index.html" : request.path;
  fs::path file = root_.empty() ? fs::path() : inside(root, asked);
  auto entry = file.empty() ? std::nullopt : load(file.string());
  const bool may_be_a_page = asked.substr(asked.rfind('/') + 1).find('.') == std::string::npos;
  if (!entry && may_be_a_page && !root_.empty()) {
    file = root / "index.html";
    entry = load(file.string());
  }
  if (!entry) return error_response(404, "not_found", "there is no such page");
  Response response;
  response.content_type = media_type_of(file.string());
  const bool hashed = file.string().starts_with(root_ + "/assets/");  // the file, not what was asked for
  response.headers = {{"Cache-Control", hashed ? "public, max-age=31536000, immutable" : "no-cache"},
                      {"ETag", entry->stamp},
                      {"Vary", "Accept-Encoding"}};
  if (any_is(request.if_none_match, entry->stamp)) {
    response.status = 304;
    return response;
  }
  const bool gzip = entry->gzipped && takes_gzip(request.accept_encoding);
  if (gzip) response.headers.emplace_back("Content-Encoding", "gzip");
  response.body = gzip ? entry->gzipped : entry->plain;
  return response;
}

}  // namespace smokemap::server
