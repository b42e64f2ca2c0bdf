#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>

#include "core/result.hpp"

namespace smokemap {

/// Draws one page of a PDF on white, CV_8UC3 (BGR), at about `megapixels`. kCorrupt, kForbidden (locked with a
/// password) or kNotFound (no such page). Runs foreign bytes through Poppler: only in a child process.
Result<cv::Mat> draw_pdf_page(std::span<const std::uint8_t> bytes, int page, double megapixels);

}  // namespace smokemap
