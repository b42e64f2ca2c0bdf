#include "simulation/plan_picture.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "core/random.hpp"
#include "simulation/plan_canvas.hpp"
#include "simulation/plan_photo.hpp"
#include "simulation/wall_solids.hpp"

namespace smokemap {
namespace {

constexpr double kDimensionPx = 34;  ///< from the building to the first chain, times the sheet's unit

const cv::Scalar kWallInk(25, 25, 25), kThinInk(70, 70, 70), kRouteFill(205, 235, 205), kRouteGreen(80, 132, 0),
    kNameInk(110, 110, 110), kWhite(255, 255, 255);

class PlanPainter {
 public:
  PlanPainter(const FloorPlan& plan, const PlanPictureParams& params, PlanPicture& picture, PlanCanvas& canvas)
      : plan_(plan), params_(params), picture_(picture), canvas_(canvas), unit_(params.width_px / 1600.0) {}

  void paint(std::mt19937_64& random) {
    rule_paper(canvas_, params_.ruling, params_.ruling_spacing_m / picture_.metres_per_pixel, 1.2 * unit_);
    if (params_.route) fill_corridors();
    draw_walls();
    if (params_.windows) draw_windows();
    if (params_.dimensions) draw_all_dimensions();
    if (params_.doors) draw_doors();
    if (params_.room_names) write_names();
    if (params_.route) draw_route();
    if (params_.signs) place_signs(random);
    if (params_.you_are_here) {
      picture_.you_are_here_px = px(*params_.you_are_here);
      sign(PlanSymbol::kYouAreHere, *params_.you_are_here, 20);
    }
  }

 private:
  Point2 px(const Point2& p_plan) const { return picture_.to_pixels(p_plan); }
  Polygon px(const Polygon& ring) const {
    Polygon out;
    for (const Point2& p : ring) out.push_back(px(p));
    return out;
  }

  void fill_corridors() {
    for (std::size_t i = 0; i < plan_.rooms.size(); ++i)
      if (plan_.rooms[i].corridor) canvas_.fill(px(plan_.outline(static_cast<int>(i))), kRouteFill);
  }

  std::vector<double> drawn_thickness() const {
    std::vector<double> thickness;
    for (const PlanWall& wall : plan_.walls) {
      const int wanted = wall.outer ? params_.outer_wall_px : params_.inner_wall_px;
      const double least = (wall.outer ? 7 : 4) * picture_.metres_per_pixel;
      thickness.push_back(wanted > 0 ? wanted * picture_.metres_per_pixel : std::max(wall.thickness_m, least));
    }
    return thickness;
  }

  void draw_walls() {
    const std::vector<double> thickness = drawn_thickness();
    std::vector<Polygon> quads;
    for (const WallSolid& solid : wall_solids(plan_, thickness)) quads.push_back(px(solid.quad()));
    const double thickest = *std::max_element(thickness.begin(), thickness.end()) / picture_.metres_per_pixel;
    draw_cut_walls(canvas_, quads, params_.wall_fill, 1.3 * unit_, params_.hatch_spacing * thickest);
  }

  /// Along every side of the building one chain by corners and windows and one over all; inside, the width of rooms.
  void draw_all_dimensions() {
    std::vector<Point2> places = {};
    for (const Point2& p : plan_.corners) places.push_back(px(p));
    Point2 low = places.front(), high = low;
    for (const Point2& p : places) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const double first = kDimensionPx * unit_, second = 1.8 * first;
    for (int axis = 0; axis < 2; ++axis)
      for (const bool far : {false, true}) {
        const int other = 1 - axis;
        const double side = far ? high[other] : low[other], away = far ? 1 : -1;
        std::vector<Point2> chain;
        for (const Point2& p : places)
          if (std::abs(p[other] - side) < 0.5 / picture_.metres_per_pixel) chain.push_back(p);
        std::sort(chain.begin(), chain.end(), [&](const Point2& a, const Point2& b) { return a[axis] < b[axis]; });
        if (chain.size() < 2) continue;
        const auto at = [&](double off) {
          Point2 p = Point2::Zero(), q = p;
          p[other] = q[other] = side + away * off, q[axis] = 1;
          return Segment2{p, q};
        };
        draw_dimensions(canvas_, chain, at(first), true, unit_, picture_.metres_per_pixel);
        draw_dimensions(canvas_, {chain.front(), chain.back()}, at(second), true, unit_, picture_.metres_per_pixel);
      }
    for (std::size_t i = 0; i < plan_.rooms.size(); ++i) {
      if (plan_.rooms[i].corridor) continue;
      const Polygon ring = px(plan_.outline(static_cast<int>(i)));
      Point2 inner_low = ring.front(), inner_high = inner_low;
      for (const Point2& p : ring) inner_low = inner_low.cwiseMin(p), inner_high = inner_high.cwiseMax(p);
      const double y = inner_low.y() + 0.3 * (inner_high.y() - inner_low.y());
      const std::vector<Point2> width{{inner_low.x(), y}, {inner_high.x(), y}};
      draw_dimensions(canvas_, width, {width[0], width[1]}, false, unit_, picture_.metres_per_pixel);
    }
  }

  /// White between the faces, three thin lines along.
  void draw_windows() {
    const std::vector<double> thickness = drawn_thickness();
    for (const PlanWindow& window : plan_.windows) {
      const Segment2 line = plan_.wall_line(window.wall);
      const WallSolid gap{{line.a + window.from * (line.b - line.a), line.a + window.to * (line.b - line.a)},
                          thickness[static_cast<std::size_t>(window.wall)] / 2,
                          window.wall};
      canvas_.fill(px(gap.quad()), kWhite);
      const Point2 side = gap.half_thickness_m * gap.line.normal();
      for (const double at : {-0.9, 0.0, 0.9})
        canvas_.line(px(Point2(gap.line.a + at * side)), px(Point2(gap.line.b + at * side)), 1.2 * unit_, kWallInk);
      if (params_.wall_fill != WallFill::kSolid)
        for (const Point2& end : {gap.line.a, gap.line.b})
          canvas_.line(px(Point2(end - side)), px(Point2(end + side)), 1.2 * unit_, kWallInk);
    }
  }

  /// The leaf at right angles and the quarter circle of its edge.
  void draw_doors() {
    for (std::size_t i = 0; i < plan_.doors.size(); ++i) {
      const PlanDoor& door = plan_.doors[i];
      Segment2 gap = plan_.door_gap(static_cast<int>(i));
      if (door.hinge_at_to) std::swap(gap.a, gap.b);
      const double sign = door.swings_left != door.hinge_at_to ? 1 : -1;
      const double width = gap.length(), shut = gap.heading(), open = shut + sign * kPi / 2;
      const Point2 edge = gap.a + width * Point2(std::cos(open), std::sin(open));
      canvas_.line(px(gap.a), px(edge), 1.6 * unit_, kThinInk);
      canvas_.arc(px(gap.a), width / picture_.metres_per_pixel, shut, open, 1.0 * unit_, kThinInk);
    }
  }

  void write_names() {
    for (std::size_t i = 0; i < plan_.rooms.size(); ++i) {
      if (plan_.rooms[i].corridor) continue;
      const Point2 at = px(centroid(plan_.outline(static_cast<int>(i))));
      canvas_.text(plan_.rooms[i].name, at + Point2(0, 5 * unit_), 9 * unit_, kNameInk, PlanCanvas::Anchor::kCenter);
    }
  }

  std::vector<Point2> exits() const {
    std::vector<Point2> places;
    for (std::size_t i = 0; i < plan_.doors.size(); ++i) {
      const auto [left, right] = plan_.rooms_beside(plan_.doors[i].wall);
      if (left < 0 || right < 0) places.push_back(plan_.door_gap(static_cast<int>(i)).midpoint());
    }
    return places;
  }

  /// Arrows along every corridor towards the nearest exit, short ones out of the rooms.
  void draw_route() {
    const std::vector<Point2> out = exits();
    for (std::size_t i = 0; i < plan_.rooms.size() && !out.empty(); ++i) {
      if (!plan_.rooms[i].corridor) continue;
      const Polygon ring = plan_.outline(static_cast<int>(i));
      Point2 low = ring.front(), high = low;
      for (const Point2& p : ring) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
      const int axis = high.x() - low.x() > high.y() - low.y() ? 0 : 1;
      for (double at = low[axis] + 1.2; at < high[axis] - 1.2; at += 2.8) {
        Point2 p = 0.5 * (low + high);
        p[axis] = at;
        const Point2 exit = *std::min_element(out.begin(), out.end(), [&](const Point2& a, const Point2& b) {
          return (a - p).squaredNorm() < (b - p).squaredNorm();
        });
        Point2 way = Point2::Zero();
        way[axis] = exit[axis] > at ? 0.55 : -0.55;
        canvas_.arrow(px(Point2(p - way)), px(Point2(p + way)), 6 * unit_, kRouteGreen);
      }
    }
    for (std::size_t i = 0; i < plan_.doors.size(); ++i) {
      const auto [left, right] = plan_.rooms_beside(plan_.doors[i].wall);
      if (left < 0 || right < 0) continue;
      const bool left_corridor = plan_.rooms[static_cast<std::size_t>(left)].corridor;
      if (left_corridor == plan_.rooms[static_cast<std::size_t>(right)].corridor) continue;
      const Segment2 gap = plan_.door_gap(static_cast<int>(i));
      const Point2 outwards = left_corridor ? gap.normal() : Point2(-gap.normal());
      canvas_.arrow(px(Point2(gap.midpoint() - 1.5 * outwards)), px(Point2(gap.midpoint() - 0.6 * outwards)), 4 * unit_,
                    kRouteGreen);
    }
  }

  void sign(PlanSymbol symbol, const Point2& p_plan, double size_px) {
    draw_symbol(canvas_, symbol, px(p_plan), size_px * unit_);
    picture_.signs.push_back({px(p_plan), size_px * unit_ / 2, colour_word(symbol), 1.0});
  }

  void place_signs(std::mt19937_64& random) {
    Point2 middle = Point2::Zero();
    for (const Point2& p : plan_.corners) middle += p / static_cast<double>(plan_.corners.size());
    for (std::size_t i = 0; i < plan_.doors.size(); ++i) {
      const auto [left, right] = plan_.rooms_beside(plan_.doors[i].wall);
      if (left >= 0 && right >= 0) continue;
      const Segment2 gap = plan_.door_gap(static_cast<int>(i));
      sign(PlanSymbol::kExit, gap.midpoint() + (left < 0 ? 0.8 : -0.8) * gap.normal(), 24);
    }
    int placed = 0;
    const PlanSymbol kinds[] = {PlanSymbol::kExtinguisher, PlanSymbol::kAlarm, PlanSymbol::kExtinguisher,
                                PlanSymbol::kFirstAid};
    std::vector<Point2> taken;
    for (int attempt = 0; attempt < 300 && placed < 6; ++attempt) {
      const auto wall = static_cast<int>(uniform_index(random, plan_.walls.size()));
      const auto [left, right] = plan_.rooms_beside(wall);
      const bool on_left = left >= 0 && plan_.rooms[static_cast<std::size_t>(left)].corridor;
      const bool on_right = right >= 0 && plan_.rooms[static_cast<std::size_t>(right)].corridor;
      if (on_left == on_right) continue;
      const Segment2 line = plan_.wall_line(wall);
      const Point2 p =
          line.a + uniform(random, 0.1, 0.9) * (line.b - line.a) + (on_left ? 0.42 : -0.42) * line.normal();
      bool crowded = false;
      for (const Point2& other : taken) crowded = crowded || (other - p).norm() < 2.5;
      for (std::size_t d = 0; d < plan_.doors.size(); ++d)
        crowded = crowded || distance(plan_.door_gap(static_cast<int>(d)), p) < 0.9;
      for (int w = 0; w < static_cast<int>(plan_.walls.size()); ++w)
        crowded = crowded || distance(plan_.wall_line(w), p) < 0.4;
      if (params_.you_are_here) crowded = crowded || (*params_.you_are_here - p).norm() < 1.2;
      if (crowded) continue;
      sign(kinds[placed % 4], p, 20);
      taken.push_back(p);
      ++placed;
    }
  }

  const FloorPlan& plan_;
  const PlanPictureParams& params_;
  PlanPicture& picture_;
  PlanCanvas& canvas_;
  double unit_;
};

/// Where the plan goes on the sheet: as large as fits into its area, centred.
void lay_out(const FloorPlan& plan, const PlanPictureParams& params, int height_px, PlanPicture& picture) {
  Point2 low = plan.corners.front(), high = low;
  for (const Point2& p : plan.corners) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double margin = params.dimensions ? 3.5 : 1.3;  // room for wall thickness, signs at the exits, dimensions
  low -= Point2(margin, margin);
  high += Point2(margin, margin);
  const double unit = params.width_px / 1600.0;
  const Point2 area_low = params.sheet ? Point2(40, 120) * unit : Point2(10, 10) * unit;
  const Point2 area_high = params.sheet ? Point2(params.width_px - 430 * unit, height_px - 75 * unit)
                                        : Point2(params.width_px - 10 * unit, height_px - 10 * unit);
  const Point2 area = area_high - area_low, size = high - low;
  picture.metres_per_pixel = std::max(size.x() / area.x(), size.y() / area.y());
  const Point2 center_px = 0.5 * (area_low + area_high), center = 0.5 * (low + high);
  picture.origin_plan = {center.x() - center_px.x() * picture.metres_per_pixel,
                         center.y() + center_px.y() * picture.metres_per_pixel};
}

}  // namespace

Result<Ok> PlanPictureParams::validate() const {
  return ParamCheck("PlanPictureParams")
      .in_range("width_px", width_px, 300, 8000)
      .in_range("outer_wall_px", outer_wall_px, 0, 100)
      .in_range("inner_wall_px", inner_wall_px, 0, 100)
      .in_range("hatch_spacing", hatch_spacing, 0.1, 10)
      .in_range("ruling_spacing_m", ruling_spacing_m, 0.05, 20)
      .in_range("tilt", tilt, 0, 0.2)
      .in_range("shade", shade, 0, 0.9)
      .in_range("sigma_noise", sigma_noise, 0, 50)
      .in_range("glare", glare, 0, 1)
      .result();
}

Point2 PlanPicture::to_pixels(const Point2& p_plan) const {
  return {(p_plan.x() - origin_plan.x()) / metres_per_pixel, (origin_plan.y() - p_plan.y()) / metres_per_pixel};
}
Point2 PlanPicture::to_plan(const Point2& p_px) const {
  return {origin_plan.x() + p_px.x() * metres_per_pixel, origin_plan.y() - p_px.y() * metres_per_pixel};
}

Result<PlanPicture> draw_plan(const FloorPlan& plan, const PlanPictureParams& params, std::mt19937_64& random) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  if (plan.walls.empty()) return fail(Errc::kDegenerate, "the plan has no walls to draw");
  PlanPicture picture;
  const int height_px = static_cast<int>(std::lround(params.width_px / std::sqrt(2.0)));
  lay_out(plan, params, height_px, picture);
  PlanCanvas canvas(params.width_px, height_px);
  if (params.sheet) draw_sheet(canvas, params.title, plan.title + ", ground floor");
  PlanPainter(plan, params, picture, canvas).paint(random);
  picture.sheet = canvas.picture();
  if (params.photo) photograph(params, random, picture);
  return picture;
}

TrueLayout true_layout(const DistortedPlan& plan, const PlanPicture& picture) {
  TrueLayout truth;
  LayoutMap& layout = truth.layout;
  const FloorPlan& drawn = plan.drawn;
  layout.width_px = picture.sheet.cols;
  layout.height_px = picture.sheet.rows;
  layout.signs = picture.signs;
  layout.you_are_here_px = picture.you_are_here_px;
  layout.scale = LayoutScale{picture.metres_per_pixel, 0.05, true};
  for (std::size_t i = 0; i < drawn.corners.size(); ++i) {
    layout.corners.push_back({picture.to_pixels(drawn.corners[i]), 0, 1.0});
    truth.corner_world.push_back(plan.corner_world[i]);
  }
  const auto world_on = [&](const PlanWall& wall, double share) -> Point2 {
    const Point2 &a = plan.corner_world[static_cast<std::size_t>(wall.corner_a)],
                 &b = plan.corner_world[static_cast<std::size_t>(wall.corner_b)];
    return a + share * (b - a);
  };
  const auto jamb = [&](const PlanWall& wall, const Point2& p, double share) {
    layout.corners.push_back({picture.to_pixels(p), 0, 1.0});
    truth.corner_world.push_back(world_on(wall, share));
    return static_cast<int>(layout.corners.size()) - 1;
  };
  for (std::size_t i = 0; i < drawn.walls.size(); ++i) {
    const PlanWall& wall = drawn.walls[i];
    std::vector<std::size_t> doors;
    for (std::size_t d = 0; d < drawn.doors.size(); ++d)
      if (drawn.doors[d].wall == static_cast<int>(i)) doors.push_back(d);
    std::sort(doors.begin(), doors.end(),
              [&](std::size_t a, std::size_t b) { return drawn.doors[a].from < drawn.doors[b].from; });
    const auto add_piece = [&](int from, int to) {
      layout.walls.push_back({from, to, wall.thickness_m / picture.metres_per_pixel, 1.0, false});
      truth.wall_source.push_back(plan.wall_source[i]);
      for (const int corner : {from, to}) ++layout.corners[static_cast<std::size_t>(corner)].degree;
    };
    int from = wall.corner_a;
    for (const std::size_t d : doors) {
      const Segment2 gap = drawn.door_gap(static_cast<int>(d));
      add_piece(from, jamb(wall, gap.a, drawn.doors[d].from));
      layout.openings.push_back({{picture.to_pixels(gap.a), picture.to_pixels(gap.b)}, OpeningKind::kDoor, 1.0});
      from = jamb(wall, gap.b, drawn.doors[d].to);
    }
    add_piece(from, wall.corner_b);
  }
  for (const PlanWindow& window : drawn.windows) {
    const Segment2 line = drawn.wall_line(window.wall);
    layout.openings.push_back({{picture.to_pixels(line.a + window.from * (line.b - line.a)),
                                picture.to_pixels(line.a + window.to * (line.b - line.a))},
                               OpeningKind::kWindow,
                               1.0});
  }
  for (std::size_t i = 0; i < drawn.rooms.size(); ++i) {
    Polygon ring;
    for (const Point2& p : drawn.outline(static_cast<int>(i))) ring.push_back(picture.to_pixels(p));
    std::reverse(ring.begin(), ring.end());  // y down: keeps them counter-clockwise in numbers
    layout.rooms_px.push_back(std::move(ring));
  }
  return truth;
}

}  // namespace smokemap
