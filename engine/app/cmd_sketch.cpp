#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/map_picture.hpp"
#include "recording/file_bytes.hpp"
#include "recording/picture_file.hpp"
#include "sketch/clean_sketch.hpp"
#include "sketch/read_sketch_photo.hpp"

namespace smokemap::app {
namespace {

struct SketchArguments {
  std::string input;
  std::string output;
  std::string preview;
};

Result<SketchMap> sketch_from_json(const std::string& text) {
  const auto document = nlohmann::json::parse(text, nullptr, false);
  if (document.is_discarded() || !document.is_object()) return fail(Errc::kCorrupt, "the strokes are no JSON object");
  try {
    SketchMap sketch;
    sketch.width_px = document.value("width", sketch.width_px);
    sketch.height_px = document.value("height", sketch.height_px);
    for (const auto& s : document.at("strokes")) {
      Stroke stroke;
      const std::string kind = s.value("kind", "wall");
      stroke.kind = kind == "door" ? StrokeKind::kDoor : kind == "note" ? StrokeKind::kNote : StrokeKind::kWall;
      stroke.width_px = s.value("width", stroke.width_px);
      for (const auto& p : s.at("points")) stroke.points_px.emplace_back(p.at(0).get<double>(), p.at(1).get<double>());
      sketch.strokes.push_back(std::move(stroke));
    }
    return sketch;
  } catch (const nlohmann::json::exception& e) {
    return fail(Errc::kCorrupt, std::string("the strokes: ") + e.what());
  }
}

Result<SketchMap> sketch_from_photo(const std::vector<std::uint8_t>& bytes, std::vector<std::string>& warnings) {
  PictureLimits limits;
  limits.decode_seconds = 30;  // a busy machine is no reason to refuse a file that somebody named on the command line
  const auto picture = decode_picture(bytes, limits);
  if (!picture) return picture.error();
  const auto photo = read_sketch_photo(*picture);
  if (!photo) return photo.error();
  warnings = photo->warnings;
  return SketchMap{photo->width_px, photo->height_px, photo->strokes};
}

/// Free space tinted, strokes black, gaps orange (open) or blue (closed by us).
cv::Mat draw_sketch(const SketchMap& sketch, const CleanSketch& clean) {
  cv::Mat picture(clean.free_space.size(), CV_8UC3, cv::Scalar(255, 255, 255));
  picture.setTo(cv::Scalar(225, 240, 215), clean.free_space);
  const int pen = std::max(2, std::max(picture.rows, picture.cols) / 400);
  const auto pixel = [](const Point2& p) {
    return cv::Point(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  };
  for (const auto& s : sketch.strokes) {
    const cv::Scalar colour = s.kind == StrokeKind::kWall   ? cv::Scalar(0, 0, 0)
                              : s.kind == StrokeKind::kDoor ? cv::Scalar(200, 120, 0)
                                                            : cv::Scalar(190, 190, 190);
    for (std::size_t i = 0; i + 1 < s.points_px.size(); ++i)
      cv::line(picture, pixel(s.points_px[i]), pixel(s.points_px[i + 1]), colour, pen, cv::LINE_AA);
  }
  for (const auto& s : clean.marks)
    for (std::size_t i = 0; i + 1 < s.points_px.size(); ++i)
      cv::line(picture, pixel(s.points_px[i]), pixel(s.points_px[i + 1]), cv::Scalar(200, 120, 0), pen, cv::LINE_AA);
  for (const auto& g : clean.gaps)
    cv::line(picture, pixel(g.gap_px.a), pixel(g.gap_px.b),
             g.closed_by_us ? cv::Scalar(255, 60, 0) : cv::Scalar(0, 140, 255), 2 * pen, cv::LINE_AA);
  return picture;
}

void run_sketch(const SketchArguments& arguments, Outcome& outcome) {
  const auto bytes = read_file(arguments.input, PictureLimits{}.max_bytes);
  if (!bytes) return outcome.no_answer(bytes.error());
  const std::string text(bytes->begin(), bytes->end());
  const auto first = text.find_first_not_of(" \t\r\n");
  const bool is_json = first != std::string::npos && text[first] == '{';
  std::vector<std::string> warnings;
  const auto sketch = is_json ? sketch_from_json(text) : sketch_from_photo(*bytes, warnings);
  if (!sketch) return outcome.no_answer(sketch.error());
  SketchParams params;
  params.max_sheet_megapixels = 40;
  const auto clean = clean_sketch(*sketch, params);
  if (!clean) return outcome.no_answer(clean.error());
  for (const auto& w : warnings) std::cerr << w << '\n';
  for (const auto& w : clean->warnings) std::cerr << w << '\n';
  if (const auto written = write_picture(arguments.output, clean->free_space); !written)
    return outcome.no_answer(written.error());
  if (arguments.preview.empty()) return;
  if (const auto drawn = write_picture(arguments.preview, draw_sketch(*sketch, *clean)); !drawn)
    outcome.no_answer(drawn.error());
}

}  // namespace

void add_sketch(CLI::App& app, Outcome& outcome) {
  auto arguments = std::make_shared<SketchArguments>();
  auto* command = app.add_subcommand(
      "sketch", "Clean a sketch: strokes, or a photograph of a drawing -> free space with closed rooms");
  command->add_option("input", arguments->input, "strokes as JSON, or a picture")->required();
  command->add_option("-o,--output", arguments->output, "PNG: 255 free, 0 elsewhere")->required();
  command->add_option("--preview", arguments->preview, "PNG with strokes and gaps");
  command->callback([arguments, &outcome] { run_sketch(*arguments, outcome); });
}

}  // namespace smokemap::app
