#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace smokemap {

/// Plain CDR as ROS 2 has it on the wire and in bags: four bytes of header (00 01 00 00 = little endian), then every
/// number aligned to its own size, counted from behind the header; strings and sequences with a 32 bit length before
/// them.
///
/// Own code and not Fast CDR: that library resizes a container to whatever length the bytes claim, before it looks how
/// many bytes there are, and reports by exceptions. Here a length is believed only when the bytes for it are present.

/// Reads without ever leaving the bytes. The first fault is kept: from then on everything reads as zero or empty, so a
/// decoder reads straight through and asks once at the end. Bytes left over are fine: newer messages end with more
/// fields.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::uint8_t> message) {
    if (message.size() < 4 || message[0] != 0 || message[1] > 1) {
      failed_ = true;
      return;
    }
    swap_ = (message[1] == 1) != (std::endian::native == std::endian::little);
    body_ = message.subspan(4);
  }

  bool ok() const { return !failed_; }

  template <typename T>
  requires std::integral<T> || std::floating_point<T> T number() {
    if (!align(sizeof(T)) || left() < sizeof(T)) return fault<T>();
    T value;
    std::memcpy(&value, body_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return swap_ ? swapped(value) : value;
  }

  std::string string() {
    const auto length = number<std::uint32_t>();
    if (failed_ || length == 0 || length > left() || body_[at_ + length - 1] != 0) return fault<std::string>();
    std::string text(reinterpret_cast<const char*>(body_.data()) + at_, length - 1);
    at_ += length;
    return text;
  }

  template <typename T>
  requires std::integral<T> || std::floating_point<T> std::vector<T> numbers() {
    const auto length = number<std::uint32_t>();
    if (failed_ || length == 0) return {};
    if (!align(sizeof(T)) || length > left() / sizeof(T)) return fault<std::vector<T>>();
    std::vector<T> values(length);
    std::memcpy(values.data(), body_.data() + at_, length * sizeof(T));
    at_ += length * sizeof(T);
    if (swap_)
      for (T& value : values) value = swapped(value);
    return values;
  }

  /// Length of a sequence whose elements take at least `least_bytes` each.
  std::uint32_t length(std::size_t least_bytes) {
    const auto count = number<std::uint32_t>();
    return failed_ || count > left() / least_bytes ? fault<std::uint32_t>() : count;
  }

  void skip(std::size_t bytes) {
    if (bytes > left())
      fault<int>();
    else
      at_ += bytes;
  }

 private:
  std::size_t left() const { return failed_ ? 0 : body_.size() - at_; }

  bool align(std::size_t size) {
    const std::size_t aligned = (at_ + size - 1) / size * size;
    if (failed_ || aligned > body_.size()) return false;
    at_ = aligned;
    return true;
  }

  template <typename T>
  T fault() {
    failed_ = true;
    return T{};
  }

  template <typename T>
  static T swapped(T value) {
    std::uint8_t bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  std::span<const std::uint8_t> body_;
  std::size_t at_ = 0;
  bool swap_ = false;
  bool failed_ = false;
};

/// Writes little endian, whatever the machine.
class CdrWriter {
 public:
  static_assert(std::endian::native == std::endian::little, "the writer copies numbers as they lie in memory");

  CdrWriter() : bytes_{0, 1, 0, 0} {}

  template <typename T>
  requires std::integral<T> || std::floating_point<T>
  void number(T value) {
    align(sizeof(T));
    append(&value, sizeof(T));
  }

  void string(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size() + 1));
    append(text.data(), text.size());
    bytes_.push_back(0);
  }

  template <typename T>
  requires std::integral<T> || std::floating_point<T>
  void numbers(std::span<const T> values) {
    number(static_cast<std::uint32_t>(values.size()));
    if (values.empty()) return;
    align(sizeof(T));
    append(values.data(), values.size_bytes());
  }

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  void align(std::size_t size) { bytes_.resize((bytes_.size() - 4 + size - 1) / size * size + 4); }
  void append(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }

  std::vector<std::uint8_t> bytes_;
};

}  // namespace smokemap
