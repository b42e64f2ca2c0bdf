#include "server/wire/layout_json.hpp"

#include "recording/layout_json.hpp"

namespace smokemap::server {

Result<LayoutMap> layout_from_json(const Json& json) {
  auto document = smokemap::layout_from_json(to_text(json));
  if (!document) return document.error();
  return std::move(document->layout);
}

Json layout_to_json(const LayoutMap& layout, const std::optional<SheetInPicture>& sheet) {
  LayoutDocument document{layout, {}, {}};
  if (sheet) {
    document.homography = sheet->homography;
    document.sheet_corners = sheet->corners;
  }
  Json json = Json::parse(to_json(document), nullptr, false);
  if (!sheet) json.erase("homography");
  return json;
}

}  // namespace smokemap::server
