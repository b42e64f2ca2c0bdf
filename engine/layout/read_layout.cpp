#include "layout/read_layout.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "grids/paper_view.hpp"
#include "layout/clutter.hpp"
#include "layout/confidence.hpp"
#include "layout/doors.hpp"
#include "layout/doubts.hpp"
#include "layout/drafting.hpp"
#include "layout/ink_stroke.hpp"
#include "layout/openings.hpp"
#include "layout/rooms.hpp"
#include "layout/scale.hpp"
#include "layout/sheet.hpp"
#include "layout/signs.hpp"
#include "layout/wall_choice.hpp"
#include "layout/wall_graph.hpp"
#include "layout/wall_strokes.hpp"

namespace smokemap {
namespace {

constexpr double kSureOfTheSheet = 0.7;  ///< of the proposed corners: below people are told to look

/// A point of the working picture in pixels of the layout.
Point2 rescaled(const Point2& p, double scale) { return (p + Point2(0.5, 0.5)) / scale - Point2(0.5, 0.5); }

void rescale(std::vector<InkStroke>& strokes, double scale) {
  for (auto& s : strokes) {
    s.axis = {rescaled(s.axis.a, scale), rescaled(s.axis.b, scale)};
    s.thickness_px /= scale;
  }
}

void rescale(LayoutMap& map, double scale) {
  const auto back = [&](const Point2& p) { return rescaled(p, scale); };
  for (auto& c : map.corners) c.p_px = back(c.p_px);
  for (auto& w : map.walls) w.thickness_px /= scale;
  for (auto& o : map.openings) o.gap_px = {back(o.gap_px.a), back(o.gap_px.b)};
  for (auto& s : map.signs) s.p_px = back(s.p_px), s.radius_px /= scale;
  for (auto& d : map.drawings) d.low_px = back(d.low_px), d.high_px = back(d.high_px);
  if (map.you_are_here_px) map.you_are_here_px = back(*map.you_are_here_px);
}

/// What is left to be read as lines.
struct Legible {
  cv::Mat darkness;  ///< without what has a colour, without signs and text: routes, headers and pictograms are no ink
  cv::Mat ink;       ///< CV_8UC1, 255 = ink
  cv::Mat hidden;    ///< CV_8UC1, 255 where something coloured or a sign lies over the drawing
  std::optional<double> bar_division_px;  ///< of a scale bar
};

Legible legible_ink(const PaperView& view, const cv::Mat& covered, const LayoutParams& params) {
  Legible out;
  cv::subtract(view.darkness, view.chroma, out.darkness);  // saturates at zero
  out.darkness.setTo(0, covered);
  out.darkness.setTo(0, find_headers(out.darkness, params));
  out.ink = ink_mask(out.darkness, params);
  out.bar_division_px = find_scale_bar(out.ink);
  cv::Mat text;
  cv::dilate(find_text(out.ink), text, cv::Mat());
  out.darkness.setTo(0, text);
  out.ink.setTo(0, text);
  cv::dilate(view.chroma > 255 * params.colour_chroma, out.hidden, cv::getStructuringElement(cv::MORPH_RECT, {7, 7}));
  cv::bitwise_or(out.hidden, covered, out.hidden);
  return out;
}

/// Leaves as thick as walls, and the arcs of their tips, are thin lines like other leaves.
void part_off_leaves(WallStrokes& strokes, const Legible& legible) {
  const auto leaves = door_leaves(strokes.walls, legible.ink, legible.hidden);
  std::vector<InkStroke> walls;
  for (std::size_t i = 0; i < leaves.size(); ++i) (leaves[i] ? strokes.thin : walls).push_back(strokes.walls[i]);
  if (!walls.empty()) strokes.walls = std::move(walls);
}

Result<Ok> check_request(const cv::Mat& picture, const LayoutOptions& options, const LayoutParams& params) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  if (options.metres_per_pixel && !(*options.metres_per_pixel > 0 && std::isfinite(*options.metres_per_pixel)))
    return fail(Errc::kInvalidArgument, "metres per pixel must be positive");
  if (options.plan_at_px && !options.plan_at_px->allFinite())
    return fail(Errc::kInvalidArgument, "the place of the plan is not a number");
  const double megapixels = static_cast<double>(picture.rows) * picture.cols * 1e-6;
  if (megapixels > params.max_megapixels)
    return fail(Errc::kTooLarge, "the picture has " + std::to_string(static_cast<int>(megapixels)) +
                                     " megapixels, at most " + std::to_string(static_cast<int>(params.max_megapixels)) +
                                     " are read");
  return Ok{};
}

/// The sheet straightened out, or where it is proposed to be.
Result<LayoutReading> find_sheet(const cv::Mat& bgr, const LayoutOptions& options, const LayoutParams& params) {
  LayoutReading reading;
  reading.rectified = bgr;
  if (!options.sheet_corners_px) {
    const auto proposal = propose_sheet(bgr);
    reading.sheet_corners_px = proposal.corners_px;
    reading.sheet_confidence = proposal.confidence;
    return reading;
  }
  reading.sheet_corners_px = *options.sheet_corners_px;
  reading.sheet_confidence = 1;
  auto sheet = rectify_sheet(bgr, *options.sheet_corners_px, params.max_megapixels);
  if (!sheet) return sheet.error();
  if (options.rectify) reading.rectified = sheet->bgr, reading.homography = sheet->homography;
  return reading;
}

/// Long side in pixels of the layout of an A-series sheet, if that is what is seen.
std::optional<double> sheet_side(const LayoutReading& reading) {
  if (const auto whole = a_series_side(reading.rectified.size())) return whole;
  if (reading.sheet_confidence < 0.5) return std::nullopt;
  const auto side = [&](std::size_t a, std::size_t b) {
    return (reading.sheet_corners_px[a] - reading.sheet_corners_px[b]).norm();
  };
  const double width = 0.5 * (side(0, 1) + side(3, 2)), height = 0.5 * (side(0, 3) + side(1, 2));
  return a_series_side({static_cast<int>(width), static_cast<int>(height)});
}

Result<LayoutReading> read_checked(const cv::Mat& picture, const LayoutOptions& options, const LayoutParams& params,
                                   const Progress& progress) {
  if (const auto fine = check_request(picture, options, params); !fine) return fine.error();
  const auto bgr = as_bgr(picture);
  if (!bgr) return bgr.error();
  progress.tell(0.05, "sheet");
  auto found = find_sheet(*bgr, options, params);
  if (!found) return found.error();
  LayoutReading reading = std::move(*found);

  const WorkPicture work = at_work_size(reading.rectified, params.min_long_side_px, params.work_long_side_px);
  std::optional<Point2> at;
  if (options.plan_at_px) at = work.scale * (*options.plan_at_px + Point2(0.5, 0.5)) - Point2(0.5, 0.5);
  progress.tell(0.15, "light");
  const PaperView view = divide_light(work.bgr, params.background_share);
  const Signs signs = find_signs(view, params);
  if (progress.cancelled()) return fail(Errc::kCancelled, "reading the plan was cancelled");
  progress.tell(0.35, "walls");
  const Legible legible = legible_ink(view, signs.covered, params);
  WallChoice choice = choose_walls(legible.darkness, signs.covered, legible.hidden, params, at, progress);
  part_off_leaves(choice.walls, legible);
  const WallStrokes& chosen = choice.walls;
  if (progress.cancelled()) return fail(Errc::kCancelled, "reading the plan was cancelled");
  progress.tell(0.85, "rooms");
  if (chosen.walls.empty()) return fail(Errc::kDegenerate, "no walls were found in the picture");

  LayoutMap& map = reading.layout;
  map = build_wall_graph(chosen.walls, chosen.thickness_px, params);
  if (map.walls.empty()) return fail(Errc::kDegenerate, "no walls were found in the picture");
  close_gaps(map, chosen.thin, choice.covered, chosen.thickness_px, params, legible.ink);
  grade_confidence(map);
  map.drawings = chosen.drawings;
  map.signs = signs.signs;
  map.you_are_here_px = signs.you_are_here_px;
  rescale(map, work.scale);
  map.width_px = reading.rectified.cols;
  map.height_px = reading.rectified.rows;
  map.rooms_px = find_rooms(map);
  rescale(choice.strokes, work.scale);
  const ReadingDoubts doubts = doubt_reading(map, choice.strokes, choice.fragment);
  ScaleEvidence evidence{door_widths(map), legible.bar_division_px, sheet_side(reading)};
  if (evidence.bar_division_px) *evidence.bar_division_px /= work.scale;
  map.scale =
      options.metres_per_pixel ? LayoutScale{*options.metres_per_pixel, 0.02, true} : guess_scale(evidence, params);
  add_warnings(map, doubts, evidence.bar_division_px.has_value());
  if (reading.sheet_confidence > 0 && reading.sheet_confidence < kSureOfTheSheet)
    map.warnings.push_back("Where the sheet ends is not sure: check its four corners.");
  progress.tell(1, "done");
  return reading;
}

}  // namespace

Result<LayoutReading> read_layout(const cv::Mat& picture_bgr, const LayoutOptions& options, const LayoutParams& params,
                                  const Progress& progress) {
  try {
    return read_checked(picture_bgr, options, params, progress);
  } catch (const cv::Exception& e) {
    return fail(Errc::kDegenerate, "the picture could not be processed: " + std::string(e.what()));
  }
}

}  // namespace smokemap
