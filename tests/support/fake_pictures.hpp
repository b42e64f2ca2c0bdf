#pragma once

#include "server/http/picture_service.hpp"

namespace smokemap::test {

/// Takes bytes that begin with "PNG"; a plan with "no walls" in it has none, a "slow" one needs patience.
class FakePictures final : public server::PictureService {
 public:
  Result<server::CleanPicture> clean(std::string_view bytes, int page, bool patient) override {
    if (!bytes.starts_with("PNG")) return fail(Errc::kUnsupported, "only PNG, JPEG, WebP and PDF are taken");
    if (bytes.find("slow") != std::string_view::npos && !patient) return fail(Errc::kTooLarge, "this takes long");
    if (page > 1) return fail(Errc::kNotFound, "there is no such page");
    return server::CleanPicture{std::string(bytes), "image/png", 80, 60, {"it is a test"}};
  }
  Result<server::PlanReading> read_layout(std::string_view bytes, const server::PlanReadRequest& request) override {
    if (bytes.find("no walls") != std::string_view::npos) return fail(Errc::kDegenerate, "there are no walls in it");
    server::PlanReading reading;
    reading.layout.width_px = 80;
    reading.layout.height_px = 60;
    reading.layout.corners = {{Point2(1, 1), 1, 1}, {Point2(70, 1), 1, 1}};
    reading.layout.walls = {{0, 1, 3, 0.9, false}};
    if (request.metres_per_pixel) reading.layout.scale = LayoutScale{*request.metres_per_pixel, 0.01, true};
    if (request.corners_px) reading.sheet.corners = *request.corners_px;
    reading.rectified = {"PNG rectified", "image/png", 80, 60, {}};
    return reading;
  }
  Result<server::SketchReading> read_sketch_photo(std::string_view bytes) override {
    if (!bytes.starts_with("PNG")) return fail(Errc::kCorrupt, "this is no picture");
    return server::SketchReading{80, 60, {{"", "", StrokeKind::kWall, 3, {Point2(1, 2), Point2(3, 4)}}}};
  }
};

}  // namespace smokemap::test
