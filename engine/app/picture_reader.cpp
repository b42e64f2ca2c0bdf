#include "app/picture_reader.hpp"

#include <opencv2/imgcodecs.hpp>
#include <span>

#include "layout/read_layout.hpp"
#include "recording/picture_file.hpp"
#include "sketch/read_sketch_photo.hpp"

namespace smokemap::app {
namespace {

constexpr int kJpegQuality = 92;

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Photographs stay JPEG, drawings PNG: each is the smaller there, and walls keep their edges.
Result<server::CleanPicture> encoded(const cv::Mat& bgr, bool photograph) {
  std::vector<std::uint8_t> bytes;
  try {
    if (!cv::imencode(photograph ? ".jpg" : ".png", bgr, bytes, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality}))
      return fail(Errc::kIo, "the picture could not be written");
  } catch (const cv::Exception&) {
    return fail(Errc::kIo, "the picture could not be written");
  }
  return server::CleanPicture{
      {bytes.begin(), bytes.end()}, photograph ? "image/jpeg" : "image/png", bgr.cols, bgr.rows, {}};
}

Result<bool> is_photograph(std::string_view bytes) {
  const auto header = read_picture_header(bytes_of(bytes));
  if (!header) return header.error();
  return header->type == PictureType::kJpeg;
}

}  // namespace

Result<server::CleanPicture> PictureReader::clean(std::string_view bytes, int pdf_page, bool patient) {
  const auto photograph = is_photograph(bytes);
  if (!photograph) return photograph.error();
  const auto picture =
      decode_picture(bytes_of(bytes), patient ? PictureLimits::patient() : PictureLimits{}, pdf_page - 1);
  if (!picture) return picture.error();
  auto clean = encoded(*picture, *photograph);
  if (clean) clean->warnings = picture_warnings(bytes_of(bytes));
  return clean;
}

Result<server::PlanReading> PictureReader::read_layout(std::string_view bytes, const server::PlanReadRequest& request) {
  const auto photograph = is_photograph(bytes);
  if (!photograph) return photograph.error();
  const auto picture = decode_picture(bytes_of(bytes));
  if (!picture) return picture.error();
  LayoutOptions options;
  options.sheet_corners_px = request.corners_px;
  options.metres_per_pixel = request.metres_per_pixel;
  options.plan_at_px = request.plan_at_px;
  auto reading = smokemap::read_layout(*picture, options);
  if (!reading) return reading.error();
  auto rectified = encoded(reading->rectified, *photograph);
  if (!rectified) return rectified.error();
  return server::PlanReading{
      std::move(reading->layout), {reading->homography, reading->sheet_corners_px}, std::move(*rectified)};
}

Result<server::SketchReading> PictureReader::read_sketch_photo(std::string_view bytes) {
  const auto picture = decode_picture(bytes_of(bytes));
  if (!picture) return picture.error();
  auto photo = smokemap::read_sketch_photo(*picture);
  if (!photo) return photo.error();
  return server::SketchReading{photo->width_px, photo->height_px, std::move(photo->strokes)};
}

}  // namespace smokemap::app
