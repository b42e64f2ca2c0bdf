#include "layout/doubts.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/angle.hpp"
#include "layout/drawings.hpp"

namespace smokemap {
namespace {

constexpr double kAsGoodAsThePlan = 0.25;  ///< a drawing with so much of the best one's score deserves a question
constexpr double kWithoutRooms = 0.49;     ///< what is said of walls then: all are doubtful
constexpr double kTrusted = 0.935;         ///< of well read plans the mean confidence is higher
constexpr double kNoneSure = 0.89;         ///< the most that is said of a wall in others
constexpr double kLongLine = 0.05;         ///< of the plan's extent: shorter ones are furniture, letters, leaves
constexpr double kFrame = 0.8;             ///< of the plan's extent
constexpr double kMuchUnread = 0.45;       ///< of the walls' length: of well read plans it is under 0.33
constexpr double kFewBorder = 0.6;         ///< of the walls' length bounds a room; of well read plans over 0.62
constexpr double kTangled = 0.4;           ///< of the meetings of walls; of plans it is under 0.1
constexpr double kAskew = 0.2;             ///< rad, off the directions of most walls
constexpr std::size_t kFewMeetings = 8;

double extent_of(const LayoutMap& map) {
  if (map.corners.empty()) return 1;
  Point2 low = map.corners.front().p_px, high = low;
  for (const auto& c : map.corners) low = low.cwiseMin(c.p_px), high = high.cwiseMax(c.p_px);
  return std::max(1.0, (high - low).maxCoeff());
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

bool in_a_room(const LayoutMap& map, const Point2& p) {
  return std::any_of(map.rooms_px.begin(), map.rooms_px.end(), [&](const Polygon& room) { return contains(room, p); });
}

/// The place on a line is a wall of like direction, or an opening.
bool is_read(const LayoutMap& map, const InkStroke& line, const Point2& p, double extent_px) {
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const Segment2 wall = map.wall_px(static_cast<int>(w));
    if (distance(wall, p) < 1.2 * map.walls[w].thickness_px + 0.5 * line.thickness_px + 2 &&
        line_angle_between(wall.heading(), line.axis.heading()) < radians(12))
      return true;
  }
  return std::any_of(map.openings.begin(), map.openings.end(),
                     [&](const LayoutOpening& o) { return distance(o.gap_px, p) < 0.02 * extent_px; });
}

/// Nearly as long as the whole drawing and clear of it: the frame of the sheet, or a line of ruled paper.
bool is_frame(const LayoutMap& map, const InkStroke& line, double extent_px) {
  if (line.length() < kFrame * extent_px) return false;
  Point2 low = map.corners.front().p_px, high = low;
  for (const auto& c : map.corners) low = low.cwiseMin(c.p_px), high = high.cwiseMax(c.p_px);
  const Point2 p = closest_point(line.axis, 0.5 * (low + high)), margin = Point2::Constant(0.05 * extent_px);
  return ((p - low + margin).array() < 0).any() || ((high + margin - p).array() < 0).any();
}

/// Calls `f` for places along the segment, `step` apart.
template <typename F>
void for_places(const Segment2& s, double step, const F& f) {
  for (double t = 0.5 * step; t < s.length(); t += step) f(Point2(s.a + t * s.direction()));
}

void cap_confidence(LayoutMap& map, double most) {
  for (LayoutWall& wall : map.walls)
    if (!wall.by_person) wall.confidence = std::min(wall.confidence, most);
}

}  // namespace

Completeness completeness_of(const LayoutMap& map, const std::vector<InkStroke>& strokes) {
  const double extent = extent_of(map), step = 0.01 * extent;
  double all = 0, bordering = 0, unread = 0;
  std::vector<InkStroke> drawing;
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const Segment2 wall = map.wall_px(static_cast<int>(w));
    const Point2 aside = 0.5 * (map.walls[w].thickness_px + step) * wall.normal();
    for_places(wall, step, [&](const Point2& p) {
      all += step;
      if (in_a_room(map, p + aside) || in_a_room(map, p - aside)) bordering += step;
    });
    drawing.emplace_back();
    drawing.back().axis = wall, drawing.back().thickness_px = map.walls[w].thickness_px;
  }
  const std::size_t walls = drawing.size();
  for (const auto& s : strokes)
    if (s.length() > 0.3 * kLongLine * extent) drawing.push_back(s);
  for (const auto& region : connected_regions(drawing, 0.02 * extent, extent)) {
    if (std::none_of(region.members.begin(), region.members.end(), [&](std::size_t m) { return m < walls; })) continue;
    for (const std::size_t m : region.members) {
      const InkStroke& line = drawing[m];
      if (m < walls || line.length() < kLongLine * extent || is_frame(map, line, extent)) continue;
      for_places(line.axis, step, [&](const Point2& p) {
        if (!is_read(map, line, p, extent) && !in_a_room(map, p)) unread += step;
      });
    }
  }
  return all > 0 ? Completeness{bordering / all, unread / all} : Completeness{};
}

double tangle_of(const LayoutMap& map) {
  Point2 main = Point2::Zero();
  std::vector<std::vector<double>> headings(map.corners.size());
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const Segment2 s = map.wall_px(static_cast<int>(w));
    main += s.length() * Point2(std::cos(4 * s.heading()), std::sin(4 * s.heading()));
    for (const int c : {map.walls[w].corner_a, map.walls[w].corner_b})
      headings[static_cast<std::size_t>(c)].push_back(s.heading());
  }
  const double usual = 0.25 * std::atan2(main.y(), main.x());
  const auto askew = [&](double heading) {
    const double turn = line_angle_between(heading, usual);
    return std::min(turn, kPi / 2 - turn) > kAskew;
  };
  std::size_t meetings = 0, tangled = 0;
  for (const auto& at : headings) {
    if (at.size() < 3) continue;
    meetings += 1;
    tangled += at.size() > 3 && std::any_of(at.begin(), at.end(), askew);
  }
  return meetings < kFewMeetings ? 0 : static_cast<double>(tangled) / static_cast<double>(meetings);
}

ReadingDoubts doubt_reading(LayoutMap& map, const std::vector<InkStroke>& strokes, bool fragment) {
  const Completeness completeness = completeness_of(map, strokes);
  ReadingDoubts doubts;
  doubts.no_rooms = map.rooms_px.empty();
  doubts.part_read = fragment || completeness.unread > kMuchUnread || completeness.bordering < kFewBorder;
  doubts.tangled = tangle_of(map) > kTangled;
  if (doubts.no_rooms || fragment) {
    for (LayoutWall& wall : map.walls)
      if (!wall.by_person) wall.confidence *= kWithoutRooms;
    for (LayoutCorner& corner : map.corners) corner.confidence *= kWithoutRooms;
  }
  doubts.crowded = mean_confidence(map) < kTrusted;
  if (doubts.part_read || doubts.tangled || doubts.crowded) cap_confidence(map, kNoneSure);
  return doubts;
}

void add_warnings(LayoutMap& map, const ReadingDoubts& doubts, bool bar) {
  const auto alike = std::count_if(map.drawings.begin(), map.drawings.end(),
                                   [](const LayoutDrawing& d) { return d.score > kAsGoodAsThePlan || d.chosen; });
  if (alike > 1)
    map.warnings.push_back("The sheet shows " + std::to_string(alike) +
                           " drawings that could be the plan: choose the floor.");
  if (map.walls.size() < 8) map.warnings.push_back("Few walls were found: check the plan against the picture.");
  if (doubts.tangled)
    map.warnings.push_back("The lines cross one another as in no building: this may be no plan. Check every wall.");
  else if (doubts.part_read && !doubts.no_rooms)
    map.warnings.push_back("Only a part of the drawing was understood: walls and rooms are missing. Check every wall.");
  else if (doubts.crowded)
    map.warnings.push_back(
        "Much of what was read is doubtful: the drawing is crowded or hard to see. Check every wall.");
  if (doubts.no_rooms) map.warnings.push_back("No closed room was found: walls may be missing.");
  if (extent_of(map) < 500) map.warnings.push_back("The plan is small in the picture: thin walls may be missing.");
  if (!map.scale)
    map.warnings.push_back("The scale is not known: measure one length.");
  else if (!map.scale->by_person)
    map.warnings.push_back(std::string("The scale is guessed from ") + (bar ? "a scale bar" : "doors or paper size") +
                           " to " + std::to_string(std::lround(100 * map.scale->relative_sigma)) +
                           " percent: measure one length.");
}

}  // namespace smokemap
