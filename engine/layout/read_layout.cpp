#include "layout/read_layout.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <opencv2/imgproc.hpp>
#include <string>

#include "grids/paper_view.hpp"
#include "layout/clutter.hpp"
#include "layout/ink_stroke.hpp"
#include "layout/openings.hpp"
#include "layout/rooms.hpp"
#include "layout/sheet.hpp"
#include "layout/signs.hpp"
#include "layout/wall_graph.hpp"
#include "layout/wall_strokes.hpp"

namespace smokemap {
namespace {

/// From pixels of the working picture to pixels of the layout.
void rescale(LayoutMap& map, double scale) {
  const auto back = [&](const Point2& p) { return Point2((p + Point2(0.5, 0.5)) / scale - Point2(0.5, 0.5)); };
  for (auto& c : map.corners) c.p_px = back(c.p_px);
  for (auto& w : map.walls) w.thickness_px /= scale;
  for (auto& o : map.openings) o.gap_px = {back(o.gap_px.a), back(o.gap_px.b)};
  for (auto& s : map.signs) s.p_px = back(s.p_px), s.radius_px /= scale;
  if (map.you_are_here_px) map.you_are_here_px = back(*map.you_are_here_px);
}

/// A median door is about as wide as doors are. Needs three doors.
std::optional<LayoutScale> scale_from_doors(const LayoutMap& map, const LayoutParams& params) {
  std::vector<double> widths;
  for (const auto& o : map.openings)
    if (o.kind == OpeningKind::kDoor) widths.push_back(o.gap_px.length());
  if (widths.size() < 3) return std::nullopt;
  std::sort(widths.begin(), widths.end());
  return LayoutScale{params.door_width_m / widths[widths.size() / 2], params.door_width_sigma, false};
}

void add_warnings(LayoutMap& map, const WallStrokes& strokes, double extent_px) {
  if (strokes.regions > 1)
    map.warnings.push_back("The sheet shows " + std::to_string(strokes.regions) +
                           " drawings that could be the plan; the one with most walls was read.");
  if (map.walls.size() < 8) map.warnings.push_back("Few walls were found: check the plan against the picture.");
  if (map.rooms_px.empty()) map.warnings.push_back("No closed room was found: walls may be missing.");
  if (extent_px < 500) map.warnings.push_back("The plan is small in the picture: thin walls may be missing.");
  if (!map.scale)
    map.warnings.push_back("The scale is not known: measure one length.");
  else if (!map.scale->by_person)
    map.warnings.push_back("The scale is guessed from doors: measure one length.");
}

/// Darkness without what has a colour, without signs and without text: routes, headers and pictograms are no ink.
cv::Mat legible_ink(const PaperView& view, const cv::Mat& covered, const LayoutParams& params) {
  cv::Mat ink, text;
  cv::subtract(view.darkness, view.chroma, ink);  // saturates at zero
  ink.setTo(0, covered);
  cv::dilate(find_text(ink_mask(ink, params)), text, cv::Mat());
  ink.setTo(0, text);
  return ink;
}

struct Choice {
  WallStrokes walls;
  cv::Mat covered;  ///< CV_8UC1, 255 where signs and other figures hide the drawing
};

/// Without the outlines of filled figures, which show only against the walls' thickness.
Choice without_blocks(const std::vector<InkStroke>& strokes, const cv::Mat& darkness, Choice first, double least_px,
                      const LayoutParams& params) {
  const cv::Mat solid = darkness >= params.solid_share * usual_black(darkness);
  const cv::Mat blocks = find_blocks(solid, std::max(first.walls.thickness_px, first.walls.thickest_px));
  std::vector<InkStroke> free;
  for (const auto& s : strokes)
    if (covered_share(s.axis, blocks) < 0.6) free.push_back(s);
  if (free.size() == strokes.size()) return first;
  cv::Mat covered;
  cv::bitwise_or(first.covered, blocks, covered);
  return {select_walls(free, darkness.size(), params, least_px), covered};
}

/// Walls in the ink. Where a plan draws them as two lines, the space between is filled and everything is traced once
/// more: then thickness tells walls from leaves and treads, as in plans with solid walls, and blur does no harm.
Choice choose_walls(const cv::Mat& darkness, const cv::Mat& covered, const LayoutParams& params,
                    const Progress& progress) {
  const auto strokes = trace_strokes(darkness, params);
  progress.tell(0.7, "rooms");
  Choice choice{select_walls(strokes, darkness.size(), params), covered};
  if (choice.walls.walls.empty() || progress.cancelled()) return choice;
  if (!choice.walls.hollow) return without_blocks(strokes, darkness, std::move(choice), 0, params);
  const int reach = static_cast<int>(std::lround(1.1 * choice.walls.hollow_px)) | 1;
  const double least_px = 1.6 * choice.walls.outline_px;
  cv::Mat filled;
  cv::morphologyEx(darkness, filled, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_RECT, {reach, reach}));
  const auto solid = trace_strokes(filled, params);
  Choice second{select_walls(solid, filled.size(), params, least_px), covered};
  if (second.walls.walls.empty()) return choice;
  second = without_blocks(solid, filled, std::move(second), least_px, params);
  second.walls.hollow = true;
  return second;
}

Result<LayoutReading> read_checked(const cv::Mat& picture, const LayoutOptions& options, const LayoutParams& params,
                                   const Progress& progress) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  if (options.metres_per_pixel && !(*options.metres_per_pixel > 0 && std::isfinite(*options.metres_per_pixel)))
    return fail(Errc::kInvalidArgument, "metres per pixel must be positive");
  const double megapixels = static_cast<double>(picture.rows) * picture.cols * 1e-6;
  if (megapixels > params.max_megapixels)
    return fail(Errc::kTooLarge, "the picture has " + std::to_string(static_cast<int>(megapixels)) +
                                     " megapixels, at most " + std::to_string(static_cast<int>(params.max_megapixels)) +
                                     " are read");
  const auto bgr = as_bgr(picture);
  if (!bgr) return bgr.error();

  LayoutReading reading;
  reading.rectified = *bgr;
  progress.tell(0.05, "sheet");
  if (options.sheet_corners_px) {
    reading.sheet_corners_px = *options.sheet_corners_px;
    reading.sheet_confidence = 1;
    auto sheet = rectify_sheet(*bgr, *options.sheet_corners_px, params.max_megapixels);
    if (!sheet) return sheet.error();
    if (options.rectify) reading.rectified = sheet->bgr, reading.homography = sheet->homography;
  } else {
    const auto proposal = propose_sheet(*bgr);
    reading.sheet_corners_px = proposal.corners_px;
    reading.sheet_confidence = proposal.confidence;
  }

  const WorkPicture work = at_work_size(reading.rectified, params.min_long_side_px, params.work_long_side_px);
  progress.tell(0.15, "light");
  const PaperView view = divide_light(work.bgr, params.background_share);
  const Signs signs = find_signs(view, params);
  if (progress.cancelled()) return fail(Errc::kCancelled, "reading the plan was cancelled");
  progress.tell(0.35, "walls");
  const cv::Mat darkness = legible_ink(view, signs.covered, params);
  const Choice choice = choose_walls(darkness, signs.covered, params, progress);
  const WallStrokes& chosen = choice.walls;
  if (progress.cancelled()) return fail(Errc::kCancelled, "reading the plan was cancelled");
  progress.tell(0.85, "rooms");
  if (chosen.walls.empty()) return fail(Errc::kDegenerate, "no walls were found in the picture");

  LayoutMap& map = reading.layout;
  map = build_wall_graph(chosen.walls, chosen.thickness_px, params);
  if (map.walls.empty()) return fail(Errc::kDegenerate, "no walls were found in the picture");
  close_gaps(map, chosen.thin, choice.covered, chosen.thickness_px, params);
  map.signs = signs.signs;
  map.you_are_here_px = signs.you_are_here_px;
  rescale(map, work.scale);
  map.width_px = reading.rectified.cols;
  map.height_px = reading.rectified.rows;
  map.rooms_px = find_rooms(map);
  if (options.metres_per_pixel)
    map.scale = LayoutScale{*options.metres_per_pixel, 0.02, true};
  else
    map.scale = scale_from_doors(map, params);
  Point2 low = map.corners.front().p_px, high = low;
  for (const auto& c : map.corners) low = low.cwiseMin(c.p_px), high = high.cwiseMax(c.p_px);
  add_warnings(map, chosen, (high - low).maxCoeff());
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
