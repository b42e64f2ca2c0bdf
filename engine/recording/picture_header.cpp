#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "core/check.hpp"
#include "recording/picture_file.hpp"

namespace smokemap {
namespace {

using PictureBytes = std::span<const std::uint8_t>;

bool has_at(PictureBytes bytes, std::size_t at, std::string_view text) {
  return bytes.size() >= at + text.size() && std::memcmp(bytes.data() + at, text.data(), text.size()) == 0;
}

/// `count` bytes as a number, most significant first, or the other way round.
std::uint32_t big_endian(PictureBytes bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}
std::uint32_t little_endian(PictureBytes bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8 | bytes[at + i];
  return value;
}

struct Size {
  std::uint32_t width = 0, height = 0;
};

std::optional<Size> png_size(PictureBytes bytes) {
  constexpr std::size_t kWidthAt = 16, kHeightAt = 20;
  if (!has_at(bytes, 12, "IHDR") || bytes.size() < kHeightAt + 4) return std::nullopt;
  return Size{big_endian(bytes, kWidthAt, 4), big_endian(bytes, kHeightAt, 4)};
}

bool is_frame_mark(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// Walks the segments up to the frame header.
std::optional<Size> jpeg_size(PictureBytes bytes) {
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    if (bytes[at] != 0xFF) return std::nullopt;
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xFF) {  // padding
      ++at;
      continue;
    }
    if (is_frame_mark(marker)) {
      if (at + 9 > bytes.size()) return std::nullopt;
      return Size{big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2)};
    }
    const bool is_bare = marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
    if (marker == 0xD9 || marker == 0xDA || marker == 0x00) return std::nullopt;  // end or data before any frame
    at += is_bare ? 2 : 2 + std::size_t{big_endian(bytes, at + 2, 2)};
  }
  return std::nullopt;
}

struct JpegData {
  bool is_whole = false;  ///< the compressed data goes on to the end mark. Cameras put more behind it
  int scans = 0;
  int inks = 0;           ///< components of the picture: 1 gray, 3 colour, 4 CMYK
  bool by_adobe = false;  ///< then four inks are stored inverted
};

JpegData jpeg_data(PictureBytes bytes) {
  constexpr std::uint8_t kScan = 0xDA, kEnd = 0xD9, kAdobe = 0xEE;
  JpegData data;
  bool in_scan = false;
  std::size_t at = 2;
  while (at + 2 <= bytes.size()) {
    const std::uint8_t marker = bytes[at + 1];
    const bool is_data = bytes[at] != 0xFF || marker == 0x00 || marker == 0xFF || (marker >= 0xD0 && marker <= 0xD7);
    if (is_data) {
      if (!in_scan && marker != 0xFF) {  // no chain of segments: the decoder will say so
        data.is_whole = true;
        return data;
      }
      ++at;
      continue;
    }
    if (marker == kEnd) {
      data.is_whole = true;
      return data;
    }
    in_scan = marker == kScan;
    data.scans += in_scan;
    data.by_adobe = data.by_adobe || (marker == kAdobe && has_at(bytes, at + 4, "Adobe"));
    if (is_frame_mark(marker) && at + 10 <= bytes.size()) data.inks = bytes[at + 9];
    if (at + 4 > bytes.size()) return data;
    at += 2 + std::size_t{big_endian(bytes, at + 2, 2)};
  }
  return data;
}

std::optional<Size> webp_size(PictureBytes bytes) {
  constexpr std::size_t kChunk = 12, kData = 20, kLeast = 30;
  if (bytes.size() < kLeast) return std::nullopt;
  if (has_at(bytes, kChunk, "VP8X"))
    return Size{little_endian(bytes, kData + 4, 3) + 1, little_endian(bytes, kData + 7, 3) + 1};
  if (has_at(bytes, kChunk, "VP8L")) {
    const std::uint32_t packed = little_endian(bytes, kData + 1, 4);
    return Size{(packed & 0x3FFF) + 1, (packed >> 14 & 0x3FFF) + 1};
  }
  if (has_at(bytes, kChunk, "VP8 "))
    return Size{little_endian(bytes, kData + 6, 2) & 0x3FFF, little_endian(bytes, kData + 8, 2) & 0x3FFF};
  return std::nullopt;
}

std::optional<PictureType> picture_type(PictureBytes bytes) {
  constexpr std::size_t kPdfMayBeginLate = 1024;
  constexpr std::string_view kPdfMark = "%PDF-";
  if (has_at(bytes, 0, "\x89PNG\r\n\x1a\n")) return PictureType::kPng;
  if (has_at(bytes, 0, "\xFF\xD8\xFF")) return PictureType::kJpeg;
  if (has_at(bytes, 0, "RIFF") && has_at(bytes, 8, "WEBP")) return PictureType::kWebp;
  const PictureBytes head = bytes.first(std::min(bytes.size(), kPdfMayBeginLate));
  if (std::search(head.begin(), head.end(), kPdfMark.begin(), kPdfMark.end()) != head.end()) return PictureType::kPdf;
  return std::nullopt;
}

bool is_tiff(PictureBytes bytes) {
  return has_at(bytes, 0, std::string_view("II*\0", 4)) || has_at(bytes, 0, std::string_view("MM\0*", 4));
}

}  // namespace

std::vector<std::string> picture_warnings(PictureBytes bytes) {
  std::vector<std::string> warnings;
  if (picture_type(bytes) == PictureType::kJpeg && !jpeg_data(bytes).is_whole)
    warnings.push_back("The picture file is cut off: its lower part is missing.");
  return warnings;
}

const char* media_type(PictureType type) {
  switch (type) {
    case PictureType::kPng:
      return "image/png";
    case PictureType::kJpeg:
      return "image/jpeg";
    case PictureType::kWebp:
      return "image/webp";
    case PictureType::kPdf:
      return "application/pdf";
  }
  return "application/octet-stream";
}

Result<Ok> PictureLimits::validate() const {
  return ParamCheck("PictureLimits")
      .in_range("max_bytes", static_cast<double>(max_bytes), 1, 1e9)
      .in_range("max_megapixels", max_megapixels, 0.001, 1000)
      .in_range("pdf_megapixels", pdf_megapixels, 0.001, max_megapixels)
      .in_range("decode_seconds", decode_seconds, 0.1, 600)
      .in_range("pdf_processor_s", pdf_processor_s, 0.01, 600)
      .in_range("decode_bytes", static_cast<double>(decode_bytes), 1e6, 1e11)
      .in_range("pdf_bytes", static_cast<double>(pdf_bytes), 1e6, 1e11)
      .in_range("max_jpeg_scans", max_jpeg_scans, 1, 10'000)
      .result();
}

PictureLimits PictureLimits::patient() {
  PictureLimits limits;
  limits.pdf_processor_s = limits.decode_seconds;
  return limits;
}

Result<PictureHeader> read_picture_header(PictureBytes bytes, const PictureLimits& limits) {
  const auto type = picture_type(bytes);
  if (is_tiff(bytes)) return fail(Errc::kUnsupported, "this is a TIFF; save it as PNG, JPEG or PDF");
  if (!type) return fail(Errc::kUnsupported, "this is no PNG, JPEG, WebP or PDF");
  if (bytes.size() > limits.max_bytes)
    return fail(Errc::kTooLarge, "the file has more than " + std::to_string(limits.max_bytes / 1'000'000) + " MB");
  PictureHeader header{*type, 0, 0};
  if (*type == PictureType::kPdf) return header;
  const auto size = *type == PictureType::kPng    ? png_size(bytes)
                    : *type == PictureType::kJpeg ? jpeg_size(bytes)
                                                  : webp_size(bytes);
  if (!size || size->width == 0 || size->height == 0) return fail(Errc::kCorrupt, "a picture without a size");
  constexpr std::uint32_t kMostAcross = 65'535;
  if (size->width > kMostAcross || size->height > kMostAcross ||
      static_cast<double>(size->width) * size->height > limits.max_megapixels * 1e6)
    return fail(Errc::kTooLarge, "a picture of " + std::to_string(size->width) + " x " + std::to_string(size->height) +
                                     " pixels; at most " + std::to_string(static_cast<int>(limits.max_megapixels)) +
                                     " megapixels are taken");
  if (*type == PictureType::kJpeg) {
    const JpegData data = jpeg_data(bytes);
    if (data.scans > limits.max_jpeg_scans)
      return fail(Errc::kTooLarge, "a JPEG with more passes than any camera makes");
    if (data.inks == 4 && !data.by_adobe)
      return fail(Errc::kUnsupported, "a CMYK JPEG that does not say how its inks are stored; save it as RGB");
  }
  header.width_px = static_cast<int>(size->width);
  header.height_px = static_cast<int>(size->height);
  return header;
}

}  // namespace smokemap
