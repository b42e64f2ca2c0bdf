#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "core/result.hpp"

namespace smokemap::app {

/// Reads a map picture as 8 bit gray. kNotFound or kCorrupt if there is none, kTooLarge over 64 megapixels.
Result<cv::Mat> read_map_picture(const std::string& path);

/// Writes a picture by its file ending. kIo if the disk says no.
Result<Ok> write_picture(const std::string& path, const cv::Mat& picture);

/// Writes text. kIo if the disk says no.
Result<Ok> write_text(const std::string& path, const std::string& text);

}  // namespace smokemap::app
