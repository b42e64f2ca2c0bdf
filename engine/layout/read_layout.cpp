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
#include "layout/drafting.hpp"
#include "layout/gaps.hpp"
#include "layout/ink_stroke.hpp"
#include "layout/median.hpp"
#include "layout/openings.hpp"
#include "layout/rooms.hpp"
#include "layout/scale.hpp"
#include "layout/sheet.hpp"
#include "layout/signs.hpp"
#include "layout/wall_graph.hpp"
#include "layout/wall_strokes.hpp"

namespace smokemap {
namespace {

constexpr double kAsGoodAsThePlan = 0.25;  ///< a drawing with so much of the best one's score deserves a question

constexpr double kAtTheLimit = 0.95;  ///< of the thickness that walls may have
constexpr double kWider = 1.5;        ///< is looked for then

constexpr double kSureOfTheSheet = 0.7;      ///< of the proposed corners: below people are told to look
constexpr double kThinnerThanHatched = 0.7;  ///< beside a hatched wall: what is as thick would be hatched too
constexpr double kFragment = 0.4;            ///< of the hatched walls: what was read may be anything
constexpr double kManyThinner = 0.7;         ///< of the length of hatched walls
constexpr double kLeastBesideOutline = 1.6;  ///< times an outline's thickness: walls, once the space between is filled

constexpr double kWithoutRooms = 0.49;  ///< what is said of walls then: all are doubtful
constexpr double kTrusted = 0.935;      ///< of well read plans the mean confidence is higher
constexpr double kNoneSure = 0.89;      ///< the most that is said of a wall in others

/// From pixels of the working picture to pixels of the layout.
void rescale(LayoutMap& map, double scale) {
  const auto back = [&](const Point2& p) { return Point2((p + Point2(0.5, 0.5)) / scale - Point2(0.5, 0.5)); };
  for (auto& c : map.corners) c.p_px = back(c.p_px);
  for (auto& w : map.walls) w.thickness_px /= scale;
  for (auto& o : map.openings) o.gap_px = {back(o.gap_px.a), back(o.gap_px.b)};
  for (auto& s : map.signs) s.p_px = back(s.p_px), s.radius_px /= scale;
  for (auto& d : map.drawings) d.low_px = back(d.low_px), d.high_px = back(d.high_px);
  if (map.you_are_here_px) map.you_are_here_px = back(*map.you_are_here_px);
}

/// Mean confidence of the walls by length.
double mean_confidence(const LayoutMap& map) {
  double sum = 0, all = 0;
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const double length = map.wall_px(static_cast<int>(w)).length();
    sum += length * map.walls[w].confidence, all += length;
  }
  return all > 0 ? sum / all : 0;
}

/// Lines that close no room may be the edges of the sheet, glare, or a plan drawn in a way that is not understood. So
/// may a fragment of a plan.
void doubt_lines_without_rooms(LayoutMap& map, bool fragment) {
  if (!map.rooms_px.empty() && !fragment) return;
  for (LayoutWall& wall : map.walls)
    if (!wall.by_person) wall.confidence *= kWithoutRooms;
  for (LayoutCorner& corner : map.corners) corner.confidence *= kWithoutRooms;
}

/// Of a drawing of which much is doubtful nothing is sure: of the lines of ruled paper, say, that do not look like it.
void doubt_crowded_drawings(LayoutMap& map) {
  if (mean_confidence(map) >= kTrusted) return;
  for (LayoutWall& wall : map.walls)
    if (!wall.by_person) wall.confidence = std::min(wall.confidence, kNoneSure);
}

void add_warnings(LayoutMap& map, bool bar) {
  const auto alike = std::count_if(map.drawings.begin(), map.drawings.end(),
                                   [](const LayoutDrawing& d) { return d.score > kAsGoodAsThePlan || d.chosen; });
  if (alike > 1)
    map.warnings.push_back("The sheet shows " + std::to_string(alike) +
                           " drawings that could be the plan: choose the floor.");
  if (map.walls.size() < 8) map.warnings.push_back("Few walls were found: check the plan against the picture.");
  if (mean_confidence(map) < kTrusted)
    map.warnings.push_back(
        "Much of what was read is doubtful: the drawing is crowded or hard to see. Check every wall.");
  if (map.rooms_px.empty()) map.warnings.push_back("No closed room was found: walls may be missing.");
  Point2 low = map.corners.front().p_px, high = low;
  for (const auto& c : map.corners) low = low.cwiseMin(c.p_px), high = high.cwiseMax(c.p_px);
  if ((high - low).maxCoeff() < 500)
    map.warnings.push_back("The plan is small in the picture: thin walls may be missing.");
  if (!map.scale)
    map.warnings.push_back("The scale is not known: measure one length.");
  else if (!map.scale->by_person)
    map.warnings.push_back(std::string("The scale is guessed from ") + (bar ? "a scale bar" : "doors or paper size") +
                           " to " + std::to_string(std::lround(100 * map.scale->relative_sigma)) +
                           " percent: measure one length.");
}

/// What is left to be read as lines.
struct Legible {
  cv::Mat darkness;  ///< without what has a colour, without signs and text: routes, headers and pictograms are no ink
  std::optional<double> bar_division_px;  ///< of a scale bar
};

Legible legible_ink(const PaperView& view, const cv::Mat& covered, const LayoutParams& params) {
  Legible out;
  cv::subtract(view.darkness, view.chroma, out.darkness);  // saturates at zero
  out.darkness.setTo(0, covered);
  out.darkness.setTo(0, find_headers(out.darkness, params));
  const cv::Mat ink = ink_mask(out.darkness, params);
  out.bar_division_px = find_scale_bar(ink);
  cv::Mat text;
  cv::dilate(find_text(ink), text, cv::Mat());
  out.darkness.setTo(0, text);
  return out;
}

struct Choice {
  WallStrokes walls;
  cv::Mat covered;        ///< CV_8UC1, 255 where signs and other figures hide the drawing
  bool fragment = false;  ///< of the walls that are hatched only a small part was read
};

/// What is left of a stroke that begins or ends in a filled figure, if that still is a stroke lying on ink.
std::optional<InkStroke> beside_blocks(const InkStroke& stroke, const cv::Mat& blocks, const cv::Mat& ink) {
  if (covered_share(stroke.axis, blocks) > 0.6) return std::nullopt;
  const Point2 u = stroke.axis.direction();
  const auto on = [&](const cv::Mat& mask, double t) {
    const Point2 p = stroke.axis.a + t * u;
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    return x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && mask.at<uchar>(y, x) != 0;
  };
  double from = 0, to = stroke.length();
  while (from < to && on(blocks, from)) from += 1;
  while (from < to && on(blocks, to)) to -= 1;
  if (to - from == stroke.length()) return stroke;
  double inked = 0;
  for (double t = from; t < to; t += 1) inked += on(ink, t);
  if (inked < 0.6 * (to - from) || to - from < stroke.thickness_px) return std::nullopt;
  InkStroke rest = stroke;
  rest.axis = {stroke.axis.a + from * u, stroke.axis.a + to * u};
  return rest;
}

/// Without the outlines of filled figures, which show only against the walls' thickness.
Choice without_blocks(const std::vector<InkStroke>& strokes, const cv::Mat& darkness, Choice first, double least_px,
                      const LayoutParams& params, const std::optional<Point2>& at) {
  const cv::Mat solid = darkness >= params.solid_share * usual_black(darkness);
  const cv::Mat blocks = find_blocks(solid, std::max(first.walls.thickness_px, first.walls.thickest_px));
  if (cv::countNonZero(blocks) == 0) return first;
  const cv::Mat ink = ink_mask(darkness, params);
  std::vector<InkStroke> free;
  for (const auto& s : strokes)
    if (const auto rest = beside_blocks(s, blocks, ink)) free.push_back(*rest);
  cv::Mat covered;
  cv::bitwise_or(first.covered, blocks, covered);
  return {select_walls(free, darkness.size(), params, least_px, at), covered};
}

/// Strokes of the drawing itself, without the paper's lines and without dimensions.
/// @param hatched  what is hatched, if wanted; where something is, dimensions stay: they look like hatching then
std::vector<InkStroke> traced(const cv::Mat& darkness, const LayoutParams& params,
                              std::vector<HatchedBand>* hatched = nullptr) {
  const double side = std::max(darkness.rows, darkness.cols);
  auto strokes = without_ruling(trace_strokes(darkness, params), darkness.size());
  if (hatched) {
    *hatched = find_hatching(strokes, kWider * params.max_wall_share * side);
    if (!hatched->empty()) return strokes;
  }
  return without_dimensions(strokes, ink_mask(darkness, params));
}

/// Closes gaps of paper up to so wide.
cv::Mat closed(const cv::Mat& darkness, double gap_px) {
  const int reach = static_cast<int>(std::lround(gap_px)) | 1;
  cv::Mat filled;
  cv::morphologyEx(darkness, filled, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_RECT, {reach, reach}));
  return filled;
}

/// Thickness of walls drawn as two lines beside thicker hatched ones, where they are about as many; else 0.
double hollow_beside(const std::vector<HatchedBand>& bands, const WallStrokes& walls) {
  std::vector<double> thickness;
  double hatched = 0, hollow = 0, thickest = 0;
  for (const auto& band : bands) thickness.push_back(band.thickness_px), hatched += band.axis.length();
  const double usual = median_of(std::move(thickness));
  for (const auto& s : walls.walls)
    if (s.hollow && s.thickness_px < kThinnerThanHatched * usual)
      hollow += s.length(), thickest = std::max(thickest, s.thickness_px);
  return hollow > kManyThinner * hatched ? thickest : 0;
}

/// The drawing once more with what is hatched filled, and what is drawn as two lines beside it.
Choice choose_hatched(const cv::Mat& darkness, const std::vector<HatchedBand>& bands, const Choice& first,
                      const LayoutParams& params, const std::optional<Point2>& at) {
  cv::Mat filled = with_bands_filled(darkness, bands);
  double least_px = 0;
  if (const double gap = hollow_beside(bands, first.walls); gap > 0) {
    least_px = kLeastBesideOutline * first.walls.outline_px;
    filled = closed(filled, 1.1 * gap);
  }
  LayoutParams wider = params;
  wider.max_wall_share *= kWider;
  const auto strokes = traced(filled, wider);
  Choice second{select_walls(strokes, filled.size(), params, least_px, at), first.covered, false};
  if (second.walls.walls.empty()) return first;
  second = without_blocks(strokes, filled, std::move(second), least_px, params, at);
  second.fragment =  // not one floor of several
      second.walls.drawings.size() == 1 && share_read(bands, second.walls.walls) < kFragment;
  return second;
}

/// Walls in the ink. Where the thickest are as thick as walls are looked for, thicker ones are looked for. Where a plan
/// draws them as two lines, the space between is filled and everything is traced once more: then thickness tells walls
/// from leaves and treads, as in plans with solid walls, and blur does no harm. The same where it hatches them.
/// @param at  the drawing at this place, if a person chose one
Choice choose_walls(const cv::Mat& legible, const cv::Mat& covered, const LayoutParams& params,
                    const std::optional<Point2>& at, const Progress& progress) {
  const cv::Mat darkness = with_cells_filled(legible, ink_mask(legible, params));
  std::vector<HatchedBand> hatched;
  auto strokes = traced(darkness, params, &hatched);
  progress.tell(0.7, "rooms");
  Choice choice{select_walls(strokes, darkness.size(), params, 0, at), covered};
  const double thickest_px = params.max_wall_share * std::max(darkness.rows, darkness.cols);
  if (choice.walls.thickest_px > kAtTheLimit * thickest_px) {
    LayoutParams wider = params;
    wider.max_wall_share *= kWider;
    strokes = traced(darkness, wider, &hatched);
    choice.walls = select_walls(strokes, darkness.size(), params, 0, at);
  }
  if (choice.walls.walls.empty() || progress.cancelled()) return choice;
  if (!hatched.empty()) return choose_hatched(darkness, hatched, choice, params, at);
  if (!choice.walls.hollow) return without_blocks(strokes, darkness, std::move(choice), 0, params, at);
  const double least_px = kLeastBesideOutline * choice.walls.outline_px;
  const cv::Mat filled = closed(darkness, 1.1 * choice.walls.hollow_px);
  const auto solid = traced(filled, params);
  Choice second{select_walls(solid, filled.size(), params, least_px, at), covered};
  if (second.walls.walls.empty()) return choice;
  second = without_blocks(solid, filled, std::move(second), least_px, params, at);
  second.walls.hollow = true;
  return second;
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
  const Choice choice = choose_walls(legible.darkness, signs.covered, params, at, progress);
  const WallStrokes& chosen = choice.walls;
  if (progress.cancelled()) return fail(Errc::kCancelled, "reading the plan was cancelled");
  progress.tell(0.85, "rooms");
  if (chosen.walls.empty()) return fail(Errc::kDegenerate, "no walls were found in the picture");

  LayoutMap& map = reading.layout;
  map = build_wall_graph(chosen.walls, chosen.thickness_px, params);
  if (map.walls.empty()) return fail(Errc::kDegenerate, "no walls were found in the picture");
  close_gaps(map, chosen.thin, choice.covered, chosen.thickness_px, params);
  grade_confidence(map);
  map.drawings = chosen.drawings;
  map.signs = signs.signs;
  map.you_are_here_px = signs.you_are_here_px;
  rescale(map, work.scale);
  map.width_px = reading.rectified.cols;
  map.height_px = reading.rectified.rows;
  map.rooms_px = find_rooms(map);
  doubt_lines_without_rooms(map, choice.fragment);
  doubt_crowded_drawings(map);
  ScaleEvidence evidence{door_widths(map), legible.bar_division_px, sheet_side(reading)};
  if (evidence.bar_division_px) *evidence.bar_division_px /= work.scale;
  map.scale =
      options.metres_per_pixel ? LayoutScale{*options.metres_per_pixel, 0.02, true} : guess_scale(evidence, params);
  add_warnings(map, evidence.bar_division_px.has_value());
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
