#include "recording/picture_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "recording/limited_child.hpp"
#include "recording/pdf_page.hpp"

namespace smokemap {
namespace {

/// What the child leaves at the beginning of the shared memory; the pixels follow.
struct PictureAnswer {
  std::int32_t width = 0, height = 0;  ///< 0: there is none, because
  Errc why = Errc::kCorrupt;
  char text[200] = {};
};

/// Any of the forms that decoders give -> 8 bit BGR on white. Plain loops: the child has no threads for OpenCV's
/// parallel ones.
template <typename Channel>
void to_bgr_on_white(const cv::Mat& from, cv::Mat& to) {
  constexpr int kFull = sizeof(Channel) == 1 ? 255 : 65535;
  const int channels = from.channels();
  for (int y = 0; y < from.rows; ++y) {
    const auto* in = from.ptr<Channel>(y);
    auto* out = to.ptr<std::uint8_t>(y);
    for (int x = 0; x < from.cols; ++x, in += channels, out += 3) {
      const int alpha = channels == 4 ? in[3] : kFull;
      for (int c = 0; c < 3; ++c) {
        const int value = in[channels >= 3 ? c : 0];
        const std::int64_t on_white = std::int64_t{value} * alpha + std::int64_t{kFull} * (kFull - alpha);
        out[c] = static_cast<std::uint8_t>(on_white * 255 / (std::int64_t{kFull} * kFull));
      }
    }
  }
}

Result<cv::Mat> decode_here(std::span<const std::uint8_t> bytes, PictureType type, const PictureLimits& limits,
                            int page) {
  if (type == PictureType::kPdf) return draw_pdf_page(bytes, page, limits.pdf_megapixels);
  std::vector<std::uint8_t> ended;
  if (!picture_warnings(bytes).empty()) {  // a cut JPEG: with an end mark the decoder gives what there is
    ended.assign(bytes.begin(), bytes.end());
    ended.insert(ended.end(), {0xFF, 0xD9});
    bytes = ended;
  }
  const cv::Mat wrapped(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<std::uint8_t*>(bytes.data()));
  // Only JPEG is turned upright by the decoder, and only without IMREAD_UNCHANGED, which the others need for their
  // alpha.
  const cv::Mat raw = cv::imdecode(wrapped, type == PictureType::kJpeg ? cv::IMREAD_COLOR : cv::IMREAD_UNCHANGED);
  if (raw.empty()) return fail(Errc::kCorrupt, "this picture cannot be decoded");
  if (raw.type() == CV_8UC3) return raw;
  if (raw.depth() != CV_8U && raw.depth() != CV_16U) return fail(Errc::kUnsupported, "a picture of an unusual depth");
  cv::Mat bgr(raw.size(), CV_8UC3);
  raw.depth() == CV_8U ? to_bgr_on_white<std::uint8_t>(raw, bgr) : to_bgr_on_white<std::uint16_t>(raw, bgr);
  return bgr;
}

void leave(const Result<cv::Mat>& picture, std::span<std::uint8_t> memory) {
  PictureAnswer answer;
  const auto refuse = [&](Errc why, const std::string& text) {
    answer.why = why;
    std::strncpy(answer.text, text.c_str(), sizeof answer.text - 1);
  };
  if (!picture) {
    refuse(picture.error().code, picture.error().message);
  } else if (picture->total() * 3 > memory.size() - sizeof answer) {
    refuse(Errc::kCorrupt, "the picture is larger than its header says");
  } else {
    answer.width = picture->cols, answer.height = picture->rows;
    const auto row_bytes = static_cast<std::size_t>(picture->cols) * 3;
    for (int y = 0; y < picture->rows; ++y)
      std::memcpy(memory.data() + sizeof answer + static_cast<std::size_t>(y) * row_bytes, picture->ptr(y), row_bytes);
  }
  std::memcpy(memory.data(), &answer, sizeof answer);
}

}  // namespace

Result<cv::Mat> decode_picture(std::span<const std::uint8_t> bytes, const PictureLimits& limits, int page) {
  if (auto sound = limits.validate(); !sound) return sound.error();
  const auto header = read_picture_header(bytes, limits);
  if (!header) return header.error();
  const bool is_pdf = header->type == PictureType::kPdf;
  if (page != 0 && !is_pdf) return fail(Errc::kNotFound, "only a PDF has pages");
  const double pixels =
      is_pdf ? limits.pdf_megapixels * 1.05e6 + 1e5 : static_cast<double>(header->width_px) * header->height_px;
  const SharedMemory memory(sizeof(PictureAnswer) + static_cast<std::size_t>(3 * pixels));
  if (memory.bytes().empty()) return fail(Errc::kTooLarge, "no memory for the picture");
  const ChildLimits child{limits.decode_seconds, is_pdf ? limits.pdf_processor_s : limits.decode_seconds,
                          is_pdf ? limits.pdf_bytes : limits.decode_bytes};
  const auto done =
      run_in_limited_child(child, [&] { leave(decode_here(bytes, header->type, limits, page), memory.bytes()); });
  if (!done && is_pdf && done.error().code == Errc::kTooLarge)
    return fail(Errc::kTooLarge, "this page takes long to draw: ask for it once more, with patience");
  if (!done) return fail(done.error().code, "the picture " + done.error().message);
  PictureAnswer answer;
  std::memcpy(&answer, memory.bytes().data(), sizeof answer);
  const bool fits =
      answer.width > 0 && answer.height > 0 && static_cast<double>(answer.width) * answer.height <= pixels;
  // What the child says is as foreign as the file it read.
  if (answer.why < Errc::kInvalidArgument || answer.why > Errc::kNotConverged) answer.why = Errc::kCorrupt;
  if (!fits) return fail(answer.why, std::string(answer.text, strnlen(answer.text, sizeof answer.text)));
  return cv::Mat(answer.height, answer.width, CV_8UC3, memory.bytes().data() + sizeof answer).clone();
}

}  // namespace smokemap
