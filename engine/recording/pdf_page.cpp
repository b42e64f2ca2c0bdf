#include "recording/pdf_page.hpp"

#include <poppler/cpp/poppler-document.h>
#include <poppler/cpp/poppler-global.h>
#include <poppler/cpp/poppler-page-renderer.h>
#include <poppler/cpp/poppler-page.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

namespace smokemap {
namespace {

void keep_quiet(const std::string&, void*) {}

constexpr double kPointsPerInch = 72;
constexpr double kMostDpi = 1200;  // a postage stamp need not fill the picture

}  // namespace

Result<cv::Mat> draw_pdf_page(std::span<const std::uint8_t> bytes, int page_number, double megapixels) {
  poppler::set_debug_error_function(keep_quiet, nullptr);
  const std::unique_ptr<poppler::document> document(poppler::document::load_from_raw_data(
      reinterpret_cast<const char*>(bytes.data()), static_cast<int>(bytes.size())));
  if (!document) return fail(Errc::kCorrupt, "this PDF cannot be read");
  if (document->is_locked()) return fail(Errc::kForbidden, "this PDF is locked with a password");
  if (page_number < 0 || page_number >= document->pages())
    return fail(Errc::kNotFound, "this PDF has " + std::to_string(document->pages()) + " pages");
  const std::unique_ptr<poppler::page> page(document->create_page(page_number));
  if (!page) return fail(Errc::kCorrupt, "this page cannot be read");
  const poppler::rectf sheet = page->page_rect();
  const double area_inch2 = sheet.width() * sheet.height() / (kPointsPerInch * kPointsPerInch);
  if (!(area_inch2 > 0) || !std::isfinite(area_inch2)) return fail(Errc::kCorrupt, "this page has no size");
  const double dpi = std::min(kMostDpi, std::sqrt(megapixels * 1e6 / area_inch2));
  poppler::page_renderer renderer;
  renderer.set_image_format(poppler::image::format_bgr24);
  renderer.set_render_hints(poppler::page_renderer::antialiasing | poppler::page_renderer::text_antialiasing);
  poppler::image drawn = renderer.render_page(page.get(), dpi, dpi);
  if (!drawn.is_valid() || drawn.width() < 1 || drawn.height() < 1)
    return fail(Errc::kCorrupt, "this page cannot be drawn");
  return cv::Mat(drawn.height(), drawn.width(), CV_8UC3, drawn.data(), static_cast<std::size_t>(drawn.bytes_per_row()))
      .clone();
}

}  // namespace smokemap
