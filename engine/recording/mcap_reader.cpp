#include "recording/mcap_reader.hpp"

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/mcap_format.hpp"

namespace smokemap {
namespace {

using McapBytes = std::span<const std::uint8_t>;

/// Little-endian fields of one record; like CdrReader it never leaves its bytes and keeps its first fault.
class McapFields {
 public:
  explicit McapFields(McapBytes bytes) : bytes_(bytes) {}

  template <typename T>
  T number() {
    T value{};
    if (!ok_ || bytes_.size() < sizeof(T)) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }

  std::string string() {
    const McapBytes text = take(number<std::uint32_t>());
    return {text.begin(), text.end()};
  }

  McapBytes take(std::uint64_t size) {
    if (!ok_ || size > bytes_.size()) {
      ok_ = false;
      return {};
    }
    const McapBytes taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }

  McapBytes rest() const { return ok_ ? bytes_ : McapBytes{}; }
  bool ok() const { return ok_; }

 private:
  McapBytes bytes_;
  bool ok_ = true;
};

bool unpack_zstd(McapBytes packed, std::vector<std::uint8_t>& plain) {
  const std::size_t size = ZSTD_decompress(plain.data(), plain.size(), packed.data(), packed.size());
  return !ZSTD_isError(size) && size == plain.size();
}

bool unpack_lz4(McapBytes packed, std::vector<std::uint8_t>& plain) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) return false;
  std::size_t done = 0;
  while (!packed.empty() && done < plain.size()) {
    std::size_t out = plain.size() - done, in = packed.size();
    const std::size_t hint = LZ4F_decompress(context, plain.data() + done, &out, packed.data(), &in, nullptr);
    if (LZ4F_isError(hint) || (in == 0 && out == 0)) break;
    done += out;
    packed = packed.subspan(in);
  }
  LZ4F_freeDecompressionContext(context);
  return done == plain.size();
}

class McapReader {
 public:
  explicit McapReader(RosLogBuilder& builder) : builder_(builder) {}

  /// False when the bytes end inside a record or a record lies about its own length.
  bool records(McapBytes bytes, bool inside_chunk) {
    while (!bytes.empty()) {
      McapFields fields(bytes);
      const auto op = static_cast<McapOp>(fields.number<std::uint8_t>());
      const auto length = fields.number<std::uint64_t>();
      const McapBytes body = fields.take(length);
      if (!fields.ok()) return false;
      if (op == McapOp::kFooter || (op == McapOp::kDataEnd && !inside_chunk)) return true;
      record(op, body, inside_chunk);
      bytes = fields.rest();
    }
    return inside_chunk;
  }

 private:
  struct Channel {
    std::string topic, type, encoding;
  };

  void record(McapOp op, McapBytes body, bool inside_chunk) {
    McapFields fields(body);
    if (op == McapOp::kSchema) {
      const auto id = fields.number<std::uint16_t>();
      const std::string name = fields.string();
      if (fields.ok()) schemas_[id] = name;
    } else if (op == McapOp::kChannel) {
      const auto id = fields.number<std::uint16_t>();
      const auto schema = fields.number<std::uint16_t>();
      const std::string topic = fields.string(), encoding = fields.string();
      if (fields.ok()) channels_[id] = {topic, schemas_[schema], encoding};
    } else if (op == McapOp::kMessage) {
      message(fields);
    } else if (op == McapOp::kChunk && !inside_chunk) {
      chunk(fields);
    }
  }

  void message(McapFields fields) {
    const auto channel = channels_.find(fields.number<std::uint16_t>());
    fields.number<std::uint32_t>();  // sequence
    fields.number<std::uint64_t>();  // log time
    fields.number<std::uint64_t>();  // publish time
    if (!fields.ok() || channel == channels_.end()) return builder_.drop("message without a channel");
    if (channel->second.encoding != "cdr") return builder_.drop("not in CDR");
    builder_.add(channel->second.topic, channel->second.type, fields.rest());
  }

  void chunk(McapFields fields) {
    fields.number<std::uint64_t>();  // first and last time
    fields.number<std::uint64_t>();
    const auto plain_size = fields.number<std::uint64_t>();
    const auto sum = fields.number<std::uint32_t>();
    const std::string compression = fields.string();
    const McapBytes packed = fields.take(fields.number<std::uint64_t>());
    if (!fields.ok() || plain_size > kMostChunkBytes) return builder_.drop("damaged chunk");
    McapBytes plain = packed;
    if (!compression.empty()) {
      // Real data shrinks by far less than this; a claim beyond it is a bomb.
      constexpr std::uint64_t kMostShrink = 2000;
      if (plain_size > (packed.size() + 64) * kMostShrink) return builder_.drop("damaged chunk");
      unpacked_.resize(plain_size);
      const bool good = compression == "zstd"  ? unpack_zstd(packed, unpacked_)
                        : compression == "lz4" ? unpack_lz4(packed, unpacked_)
                                               : false;
      if (!good) return builder_.drop("chunk that does not unpack (" + compression.substr(0, 16) + ")");
      plain = unpacked_;
    }
    if (sum != 0 && crc32(0, plain.data(), static_cast<uInt>(plain.size())) != sum)
      return builder_.drop("chunk with a wrong sum");
    if (!records(plain, true)) builder_.drop("damaged chunk");
  }

  RosLogBuilder& builder_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<std::uint8_t> unpacked_;
};

}  // namespace

bool looks_like_mcap(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kMcapMagic.size() && std::memcmp(bytes.data(), kMcapMagic.data(), kMcapMagic.size()) == 0;
}

Result<Ok> read_mcap(std::span<const std::uint8_t> bytes, RosLogBuilder& builder) {
  if (!looks_like_mcap(bytes)) return fail(Errc::kCorrupt, "not an MCAP file: its first bytes are others");
  if (!McapReader(builder).records(bytes.subspan(kMcapMagic.size()), false))
    builder.warn("the file ends in the middle of a record; everything before it was read");
  return Ok{};
}

}  // namespace smokemap
