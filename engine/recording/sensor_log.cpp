#include "recording/sensor_log.hpp"

#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>
#include <span>
#include <sstream>
#include <string_view>
#include <vector>

#include "recording/carmen_log.hpp"
#include "recording/file_bytes.hpp"
#include "recording/log_writer.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/ros_log_builder.hpp"
#include "recording/rosbag2_db3.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kMostLogBytes = std::size_t{4} << 30;
constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};
constexpr std::string_view kZstdMagic = "\x28\xB5\x2F\xFD";

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::vector<std::uint8_t> first_bytes(const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes(16);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return bytes;
}

/// Whole-file compression of rosbag2 (.db3.zstd, .mcap.zstd).
Result<std::vector<std::uint8_t>> unpack_zstd_file(std::span<const std::uint8_t> packed) {
  std::vector<std::uint8_t> plain;
  std::vector<std::uint8_t> block(ZSTD_DStreamOutSize());
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(), ZSTD_freeDStream);
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  while (in.pos < in.size) {
    ZSTD_outBuffer out{block.data(), block.size(), 0};
    if (ZSTD_isError(ZSTD_decompressStream(stream.get(), &out, &in))) break;
    plain.insert(plain.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(out.pos));
    if (plain.size() > kMostLogBytes) return fail(Errc::kTooLarge, "the unpacked bag is too large");
  }
  if (plain.empty()) return fail(Errc::kCorrupt, "a bag that does not unpack");
  return plain;
}

/// Adds one bag file. Sets `format`.
Result<Ok> read_bag_file(const std::filesystem::path& path, RosLogBuilder& builder, std::string& format) {
  format = "rosbag2";
  if (as_text(first_bytes(path)).starts_with(kSqliteMagic)) return read_db3(path, builder);
  auto bytes = read_file(path, kMostLogBytes);
  if (bytes && as_text(*bytes).starts_with(kZstdMagic)) bytes = unpack_zstd_file(*bytes);
  if (!bytes) return bytes.error();
  if (as_text(*bytes).starts_with(kSqliteMagic)) return read_db3(*bytes, builder);
  format = "mcap";
  return read_mcap(*bytes, builder);
}

Result<SensorLog> finished(RosLogBuilder builder, std::string format) {
  SensorLog log = std::move(builder).finish(std::move(format));
  if (log.items.empty()) return fail(Errc::kDegenerate, "a bag without laser scans, radar sweeps or odometry");
  return log;
}

/// The files of a bag folder in the order of their numbers: bag_2.db3 before bag_10.db3.
std::vector<std::filesystem::path> bag_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    for (const char* ending : {".db3", ".mcap", ".db3.zstd", ".mcap.zstd"})
      if (name.ends_with(ending)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    const std::string name_a = a.string(), name_b = b.string();
    return name_a.size() != name_b.size() ? name_a.size() < name_b.size() : name_a < name_b;
  });
  return files;
}

Result<SensorLog> read_bag_folder(const std::filesystem::path& folder) {
  const auto files = bag_files(folder);
  if (files.empty()) return fail(Errc::kUnsupported, folder.string() + " holds no .db3 or .mcap file");
  RosLogBuilder builder;
  std::string format;
  for (const auto& file : files)
    if (auto read = read_bag_file(file, builder, format); !read) return read.error();
  return finished(std::move(builder), format);
}

}  // namespace

Result<SensorLog> read_log(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return fail(Errc::kIo, "there is no " + path.string());
  if (std::filesystem::is_directory(path, error)) return read_bag_folder(path);
  const auto first = first_bytes(path);
  if (as_text(first).starts_with(kSqliteMagic) || as_text(first).starts_with(kZstdMagic) || looks_like_mcap(first)) {
    RosLogBuilder builder;
    std::string format;
    if (auto read = read_bag_file(path, builder, format); !read) return read.error();
    return finished(std::move(builder), format);
  }
  bool damaged = false;
  const auto bytes = read_file(path, kMostLogBytes, &damaged);
  if (!bytes) return bytes.error();
  if (!looks_like_carmen(as_text(*bytes)))
    return fail(Errc::kUnsupported, path.string() + " is no log we read (CARMEN, rosbag2 .db3, MCAP)");
  auto log = read_carmen(as_text(*bytes));
  if (log && damaged) log->warnings.emplace_back("the file ends early; everything before its end was read");
  return log;
}

Result<Ok> write_log(const SensorLog& log, const std::filesystem::path& path) {
  std::ostringstream out;
  LogWriter writer(out);
  for (const LogItem& item : log.items) writer.add(item);
  if (auto done = writer.finish(); !done) return done;
  return write_file(path, out.str());
}

}  // namespace smokemap
