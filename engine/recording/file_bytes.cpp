#include "recording/file_bytes.hpp"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <system_error>

namespace smokemap {
namespace {

struct CloseGzip {
  void operator()(gzFile file) const { gzclose(file); }
};

}  // namespace

Result<std::vector<std::uint8_t>> read_file(const std::filesystem::path& path, std::size_t most_bytes, bool* damaged) {
  constexpr std::size_t kBlock = 1 << 20;
  if (std::error_code error; std::filesystem::is_directory(path, error))
    return fail(Errc::kIo, path.string() + " is a folder");
  const std::unique_ptr<gzFile_s, CloseGzip> file(gzopen(path.c_str(), "rb"));  // reads plain files as they are
  if (!file) return fail(Errc::kIo, "cannot open " + path.string() + ": " + std::strerror(errno));
  gzbuffer(file.get(), 1 << 17);
  std::vector<std::uint8_t> bytes;
  for (;;) {
    const std::size_t had = bytes.size();
    bytes.resize(had + kBlock);
    const int got = gzread(file.get(), bytes.data() + had, kBlock);
    bytes.resize(had + static_cast<std::size_t>(std::max(got, 0)));
    if (bytes.size() > most_bytes) return fail(Errc::kTooLarge, path.string() + " is too large");
    int problem = Z_OK;
    const char* why = gzerror(file.get(), &problem);
    if (problem == Z_ERRNO) return fail(Errc::kIo, "cannot read " + path.string());
    if (got < 0 && had == 0) return fail(Errc::kCorrupt, path.string() + ": " + why);
    if (damaged && problem != Z_OK && problem != Z_STREAM_END) *damaged = true;
    if (got < static_cast<int>(kBlock)) return bytes;
  }
}

namespace {

bool put_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  return static_cast<bool>(file);
}

}  // namespace

Result<Ok> write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  std::filesystem::path beside = path;
  beside += ".part";
  std::error_code error;
  // A pipe or a device is written to; renaming would put a file in its place.
  const bool is_special = std::filesystem::exists(path, error) && std::filesystem::is_other(path, error);
  if (!put_bytes(is_special ? path : beside, bytes)) {
    if (!is_special) std::filesystem::remove(beside, error);
    return fail(Errc::kIo, "cannot write " + path.string());
  }
  if (is_special) return Ok{};
  std::filesystem::rename(beside, path, error);
  if (!error) return Ok{};
  std::error_code ignored;
  std::filesystem::remove(beside, ignored);
  return fail(Errc::kIo, "cannot write " + path.string() + ": " + error.message());
}

Result<Ok> write_file(const std::filesystem::path& path, const std::string& text) {
  return write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace smokemap
