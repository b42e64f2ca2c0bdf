#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/layout_preview.hpp"
#include "app/map_picture.hpp"
#include "layout/read_layout.hpp"
#include "recording/file_bytes.hpp"
#include "recording/layout_json.hpp"
#include "recording/picture_file.hpp"

namespace smokemap::app {
namespace {

struct LayoutArguments {
  std::string picture;
  std::string output;
  std::string preview;
  std::vector<double> corners;
  std::vector<double> plan_at;
  double metres_per_pixel = 0;
  int page = 1;
  double patience_s = PictureLimits{}.pdf_processor_s;
};

/// The document as written: `corners` lists places where walls of different directions meet. Ends of walls at doors
/// follow from `walls` (the reader of the format puts them back), so that a corner in the file is what a person calls a
/// corner.
std::string document(const LayoutReading& reading) {
  LayoutDocument whole{reading.layout, reading.homography, reading.sheet_corners_px};
  auto json = nlohmann::json::parse(to_json(whole));
  const auto& map = reading.layout;
  std::vector<std::vector<double>> headings(map.corners.size());
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    headings[static_cast<std::size_t>(map.walls[w].corner_a)].push_back(map.wall_px(static_cast<int>(w)).heading());
    headings[static_cast<std::size_t>(map.walls[w].corner_b)].push_back(map.wall_px(static_cast<int>(w)).heading());
  }
  auto corners = nlohmann::json::array();
  for (std::size_t c = 0; c < map.corners.size(); ++c) {
    const bool turns = std::any_of(headings[c].begin(), headings[c].end(),
                                   [&](double h) { return line_angle_between(h, headings[c].front()) > radians(20); });
    if (turns) corners.push_back({map.corners[c].p_px.x(), map.corners[c].p_px.y()});
  }
  json["corners"] = corners;
  json.erase("wall_corners");
  json["sheet_confidence"] = reading.sheet_confidence;
  return json.dump();
}

void run_layout(const LayoutArguments& arguments, Outcome& outcome) {
  LayoutOptions options;
  if (!arguments.corners.empty()) {
    std::array<Point2, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = {arguments.corners[2 * i], arguments.corners[2 * i + 1]};
    options.sheet_corners_px = corners;
  }
  if (arguments.metres_per_pixel != 0) options.metres_per_pixel = arguments.metres_per_pixel;
  if (!arguments.plan_at.empty()) options.plan_at_px = Point2(arguments.plan_at[0], arguments.plan_at[1]);
  const auto bytes = read_file(arguments.picture, PictureLimits{}.max_bytes);
  if (!bytes) return outcome.no_answer(bytes.error());
  PictureLimits limits;
  limits.decode_seconds = 30;  // a busy machine is no reason to refuse a file that somebody named on the command line
  limits.pdf_processor_s = arguments.patience_s;
  const auto picture = decode_picture(*bytes, limits, arguments.page - 1);
  if (!picture) return outcome.no_answer(picture.error());
  auto reading = read_layout(*picture, options);
  if (!reading) return outcome.no_answer(reading.error());
  for (auto& warning : picture_warnings(*bytes)) reading->layout.warnings.push_back(std::move(warning));
  if (const auto written = write_file(arguments.output, document(*reading) + "\n"); !written)
    return outcome.no_answer(written.error());
  if (arguments.preview.empty()) return;
  if (const auto drawn = write_picture(arguments.preview, draw_layout(reading->rectified, reading->layout)); !drawn)
    outcome.no_answer(drawn.error());
}

}  // namespace

void add_layout(CLI::App& app, Outcome& outcome) {
  auto arguments = std::make_shared<LayoutArguments>();
  auto* command =
      app.add_subcommand("layout", "Read an evacuation plan: picture -> walls, corners, doors, rooms, signs");
  command->add_option("picture", arguments->picture, "PNG, JPEG, WebP or PDF")->required();
  command->add_option("-o,--output", arguments->output, "layout.json")->required();
  command->add_option("--preview", arguments->preview, "PNG with the reading over the picture");
  command
      ->add_option("--corners", arguments->corners,
                   "sheet corners in the picture, clockwise from top left: x1,y1,...,x4,y4")
      ->delimiter(',')
      ->expected(8);
  command
      ->add_option("--plan-at", arguments->plan_at,
                   "of several drawings on the sheet the one at x,y (rectified picture)")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--metres-per-pixel", arguments->metres_per_pixel, "of the rectified picture, if it is known");
  command->add_option("--page", arguments->page, "page of a PDF, from 1")->check(CLI::Range(1, 10000));
  command
      ->add_option("--patience", arguments->patience_s,
                   "seconds of processor time that a page of a PDF may take to be drawn")
      ->check(CLI::Range(0.01, 30.0))
      ->capture_default_str();
  command->callback([arguments, &outcome] { run_layout(*arguments, outcome); });
}

}  // namespace smokemap::app
