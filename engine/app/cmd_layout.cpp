#include <array>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/layout_preview.hpp"
#include "layout/read_layout.hpp"

namespace smokemap::app {
namespace {

struct LayoutArguments {
  std::string picture;
  std::string output;
  std::string preview;
  std::vector<double> corners;
  double metres_per_pixel = 0;
};

nlohmann::json point(const Point2& p) { return {std::round(p.x() * 100) / 100, std::round(p.y() * 100) / 100}; }

nlohmann::json document(const LayoutReading& reading) {
  const auto& map = reading.layout;
  nlohmann::json out = {{"size", {map.width_px, map.height_px}}, {"walls", nlohmann::json::array()}, {"doors", nlohmann::json::array()}, {"corners", nlohmann::json::array()}, {"rooms", nlohmann::json::array()}};
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const auto s = map.wall_px(static_cast<int>(w));
    out["walls"].push_back({s.a.x(), s.a.y(), s.b.x(), s.b.y(), map.walls[w].thickness_px});
    out["wall_confidence"].push_back(map.walls[w].confidence);
  }
  for (const auto& o : map.openings) out["doors"].push_back({o.gap_px.a.x(), o.gap_px.a.y(), o.gap_px.b.x(), o.gap_px.b.y()});
  for (const auto& room : map.rooms_px) {
    nlohmann::json ring = nlohmann::json::array();
    for (const auto& p : room) ring.push_back(point(p));
    out["rooms"].push_back(ring);
  }
  out.erase("corners");
  for (const auto& p : reading.sheet_corners_px) out["sheet_corners"].push_back(point(p));
  out["sheet_confidence"] = reading.sheet_confidence;
  for (const auto& s : map.signs) out["signs"].push_back({{"x", s.p_px.x()}, {"y", s.p_px.y()}, {"r", s.radius_px}, {"colour", s.colour}});
  if (map.you_are_here_px) out["you_are_here"] = point(*map.you_are_here_px);
  if (map.scale) out["metres_per_pixel"] = map.scale->metres_per_pixel;
  out["warnings"] = map.warnings;
  return out;
}

void run_layout(const LayoutArguments& arguments, Outcome& outcome) {
  LayoutOptions options;
  if (!arguments.corners.empty()) {
    std::array<Point2, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = {arguments.corners[2 * i], arguments.corners[2 * i + 1]};
    options.sheet_corners_px = corners;
  }
  if (arguments.metres_per_pixel != 0) options.metres_per_pixel = arguments.metres_per_pixel;
  const cv::Mat picture = cv::imread(arguments.picture);
  const auto reading = read_layout(picture, options);
  if (!reading) return outcome.no_answer(reading.error());
  std::ofstream(arguments.output) << document(*reading).dump() << '\n';
  if (!arguments.preview.empty()) cv::imwrite(arguments.preview, draw_layout(reading->rectified, reading->layout));
}

}  // namespace

void add_layout(CLI::App& app, Outcome& outcome) {
  auto arguments = std::make_shared<LayoutArguments>();
  auto* command = app.add_subcommand("layout", "Read an evacuation plan: picture -> walls, corners, doors, rooms, signs");
  command->add_option("picture", arguments->picture, "PNG, JPEG, WebP or PDF")->required();
  command->add_option("-o,--output", arguments->output, "layout.json")->required();
  command->add_option("--preview", arguments->preview, "PNG with the reading over the picture");
  command->add_option("--corners", arguments->corners, "sheet corners in the picture, clockwise from top left: x1,y1,...,x4,y4")->delimiter(',')->expected(8);
  command->add_option("--metres-per-pixel", arguments->metres_per_pixel, "of the rectified picture, if it is known");
  command->callback([arguments, &outcome] { run_layout(*arguments, outcome); });
}

}  // namespace smokemap::app
