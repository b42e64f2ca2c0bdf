#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace smokemap {

enum class PictureType { kPng, kJpeg, kWebp, kPdf };

/// "image/png" and so on.
const char* media_type(PictureType type);

/// Limits on pictures from outside. Dimensions are read from the header, before anything is decoded.
struct PictureLimits {
  std::size_t max_bytes = 25'000'000;
  double max_megapixels = 40;
  double pdf_megapixels = 8.2;          ///< resolution is chosen so that a page comes to about this
  double decode_seconds = 10;           ///< wall and processor time of the decoding process
  double pdf_processor_s = 0.85;        ///< processor time for a page of a PDF
  std::size_t decode_bytes = 1 << 30;   ///< memory it may take on top of ours
  std::size_t pdf_bytes = 400'000'000;  ///< the same for a page of a PDF
  int max_jpeg_scans = 64;              ///< passes over the picture; progressive ones have about ten
  /// For somebody who waits and can cancel: a page may take as long as any other picture.
  static PictureLimits patient();
  Result<Ok> validate() const;
};

struct PictureHeader {
  PictureType type = PictureType::kPng;
  int width_px = 0;  ///< as stored, before a turn told by EXIF; 0 for PDF
  int height_px = 0;
};

/// What the first bytes say. kUnsupported for anything but PNG, JPEG, WebP and PDF; kTooLarge over the limits; kCorrupt
/// for a header without usable dimensions. Decodes nothing and allocates nothing; of a JPEG its marks are counted to
/// the end.
Result<PictureHeader> read_picture_header(std::span<const std::uint8_t> bytes, const PictureLimits& limits = {});

/// What is amiss with a picture that can be read all the same, in words for people: a JPEG that ends before its picture
/// does has its rest in gray.
std::vector<std::string> picture_warnings(std::span<const std::uint8_t> bytes);

/// The picture as 8 bit BGR (CV_8UC3), turned upright as EXIF asks, transparency laid on white, 16 bit, gray and CMYK
/// converted. A PDF gives the asked page (0 = first).
///
/// Decoded in a child process with limits on time and memory, so that a hostile file costs one clear error and never
/// the server: kCorrupt when the decoder refuses, crashes, or runs out of memory; kTooLarge when a page takes longer
/// than it may; kNotFound for a page that is not there. What a page of a PDF will cost cannot be told from its bytes: a
/// plan of 300 000 strokes and a page made to keep us busy look alike. So time is short unless somebody has patience.
Result<cv::Mat> decode_picture(std::span<const std::uint8_t> bytes, const PictureLimits& limits = {}, int page = 0);

}  // namespace smokemap
