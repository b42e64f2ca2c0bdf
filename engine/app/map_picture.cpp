#include "app/map_picture.hpp"

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

namespace smokemap::app {

Result<cv::Mat> read_map_picture(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) return fail(Errc::kNotFound, "there is no file " + path);
  try {
    cv::Mat picture = cv::imread(path, cv::IMREAD_GRAYSCALE);
    if (picture.empty()) return fail(Errc::kCorrupt, path + " is not a picture we can read");
    if (picture.total() > size_t{64} << 20)
      return fail(Errc::kTooLarge, path + " has more than 64 megapixels: reduce it first");
    return picture;
  } catch (const cv::Exception& e) {
    return fail(Errc::kCorrupt, path + " cannot be decoded: " + e.err);
  }
}

Result<Ok> write_picture(const std::string& path, const cv::Mat& picture) {
  try {
    if (cv::imwrite(path, picture)) return Ok{};
  } catch (const cv::Exception& e) {
    return fail(Errc::kIo, "cannot write " + path + ": " + e.err);
  }
  return fail(Errc::kIo, "cannot write " + path);
}

Result<Ok> write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text << '\n';
  if (!file.flush()) return fail(Errc::kIo, "cannot write " + path);
  return Ok{};
}

}  // namespace smokemap::app
