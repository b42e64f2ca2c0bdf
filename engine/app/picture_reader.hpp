#pragma once

#include "server/http/picture_service.hpp"

namespace smokemap::app {

/// Pictures for the server, read by the engine's modules. Decoding of foreign bytes happens in a limited child process.
class PictureReader final : public server::PictureService {
 public:
  Result<server::CleanPicture> clean(std::string_view bytes, int pdf_page, bool patient) override;
  Result<server::PlanReading> read_layout(std::string_view bytes, const server::PlanReadRequest& request) override;
  Result<server::SketchReading> read_sketch_photo(std::string_view bytes) override;
};

}  // namespace smokemap::app
