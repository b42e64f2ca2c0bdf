#include "tests/bench/plan_building_figures.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/random.hpp"
#include "layout/read_layout.hpp"

namespace smokemap::bench {
namespace {

constexpr double kCell_m = 0.1;
constexpr double kDoor_m = 1.0;
constexpr double kLeastRoom_m2 = 4.0;
constexpr double kOnWall_m = 0.25;
constexpr double kLeastGap_m = 0.4;
constexpr double kFar_m = 200;
constexpr double kBeside_m = 0.5;  ///< from a wall: where is looked for the room there

/// Free space in connected pieces; 0: wall, 1: outside or too small.
class Pieces {
 public:
  explicit Pieces(const FloorPlan& plan) {
    low_ = plan.corners.front();
    Point2 high = low_;
    for (const Point2& p : plan.corners) low_ = low_.cwiseMin(p), high = high.cwiseMax(p);
    low_.array() -= 1, high.array() += 1;
    cv::Mat free(static_cast<int>((high - low_).y() / kCell_m) + 1, static_cast<int>((high - low_).x() / kCell_m) + 1,
                 CV_8U, cv::Scalar(255));
    for (std::size_t w = 0; w < plan.walls.size(); ++w)
      for (const Segment2& piece : plan.wall_pieces(static_cast<int>(w)))
        cv::line(free, cell(piece.a), cell(piece.b), cv::Scalar(0),
                 std::max(2, static_cast<int>(plan.walls[w].thickness_m / kCell_m)));
    cv::Mat stats, centers;
    count_ = cv::connectedComponentsWithStats(free, labels_, stats, centers, 4);
    keep_.assign(static_cast<std::size_t>(count_), false);
    for (int i = 1; i < count_; ++i)
      keep_[static_cast<std::size_t>(i)] =
          i != labels_.at<int>(0, 0) && stats.at<int>(i, cv::CC_STAT_AREA) * kCell_m * kCell_m >= kLeastRoom_m2;
  }
  int count() const { return count_; }
  /// The piece of this place; 0 if it is none to live in.
  int at(const Point2& p) const {
    const cv::Point c = cell(p);
    if (c.x < 0 || c.y < 0 || c.x >= labels_.cols || c.y >= labels_.rows) return 0;
    const int label = labels_.at<int>(c);
    return keep_[static_cast<std::size_t>(label)] ? label : 0;
  }

 private:
  cv::Point cell(const Point2& p) const {
    const Point2 c = (p - low_) / kCell_m;
    return {static_cast<int>(std::lround(c.x())), static_cast<int>(std::lround(c.y()))};
  }
  Point2 low_ = Point2::Zero();
  cv::Mat labels_;
  int count_ = 0;
  std::vector<bool> keep_;
};

void cut_doors(FloorPlan& plan, std::uint64_t seed) {
  const Pieces pieces(plan);
  std::vector<int> joined(static_cast<std::size_t>(pieces.count()));
  std::iota(joined.begin(), joined.end(), 0);
  const auto root = [&](int i) {
    while (joined[static_cast<std::size_t>(i)] != i) i = joined[static_cast<std::size_t>(i)];
    return i;
  };
  auto random = random_stream(seed, 5);
  std::vector<int> order(plan.walls.size());
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[uniform_index(random, i)]);
  for (const int wall : order) {
    const Segment2 line = plan.wall_line(wall);
    if (line.length() < kDoor_m + 0.6) continue;
    for (const double share : {0.5, 0.3, 0.7}) {
      const Point2 p = line.a + share * (line.b - line.a), n = kBeside_m * line.normal();
      const int left = pieces.at(p + n), right = pieces.at(p - n);
      if (left == 0 || right == 0 || root(left) == root(right)) continue;
      if (!add_door(plan, p, kDoor_m)) continue;
      joined[static_cast<std::size_t>(root(left))] = root(right);
      break;
    }
  }
}

/// The reader's rooms, on corners of walls.
void take_rooms(const LayoutMap& layout, FloorPlan& plan) {
  for (const Polygon& room_px : layout.rooms_px) {
    PlanRoom room{"room " + std::to_string(plan.rooms.size() + 1), {}, false};
    Polygon ring;
    for (const Point2& p_px : room_px) {
      const Point2 p = layout.frame().to_metres(p_px);
      const auto nearest =
          std::min_element(plan.corners.begin(), plan.corners.end(),
                           [&](const Point2& a, const Point2& b) { return (a - p).norm() < (b - p).norm(); });
      const int corner = static_cast<int>(nearest - plan.corners.begin());
      if ((*nearest - p).norm() > 0.6 || (!room.ring.empty() && room.ring.back() == corner)) continue;
      room.ring.push_back(corner), ring.push_back(*nearest);
    }
    if (room.ring.size() < 3) continue;
    if (signed_area(ring) < 0) std::reverse(room.ring.begin(), room.ring.end());
    if (std::abs(signed_area(ring)) >= kLeastRoom_m2) plan.rooms.push_back(std::move(room));
  }
  std::stable_sort(plan.rooms.begin(), plan.rooms.end(), [&](const PlanRoom& a, const PlanRoom& b) {
    const auto area = [&](const PlanRoom& r) {
      Polygon ring;
      for (const int c : r.ring) ring.push_back(plan.corners[static_cast<std::size_t>(c)]);
      return std::abs(signed_area(ring));
    };
    return area(a) > area(b);
  });
}

/// Along the edge of a room: where no wall stands.
std::vector<Segment2> gaps_along(const FloorPlan& plan, const Segment2& edge) {
  std::vector<Segment2> gaps;
  std::optional<double> since;
  const double length = edge.length();
  for (double s = 0; s <= length + kCell_m; s += kCell_m) {
    const Point2 p = edge.a + std::min(s, length) * edge.direction();
    bool walled = s > length;
    for (std::size_t w = 0; w < plan.walls.size() && !walled; ++w)
      walled = distance(plan.wall_line(static_cast<int>(w)), p) < kOnWall_m;
    if (!walled && !since) since = s;
    if (!walled || !since) continue;
    if (s - *since >= kLeastGap_m)
      gaps.push_back({edge.a + std::max(0.0, *since - kOnWall_m) * edge.direction(),
                      edge.a + std::min(length, s + kOnWall_m) * edge.direction()});
    since.reset();
  }
  return gaps;
}

int corner_at(FloorPlan& plan, const Point2& p) {
  const auto nearest =
      std::min_element(plan.corners.begin(), plan.corners.end(),
                       [&](const Point2& a, const Point2& b) { return (a - p).norm() < (b - p).norm(); });
  if ((*nearest - p).norm() < kOnWall_m) return static_cast<int>(nearest - plan.corners.begin());
  plan.corners.push_back(p);
  return static_cast<int>(plan.corners.size()) - 1;
}

/// Looking from here into the direction and a little beside it, most looks meet no wall.
bool is_outside(const FloorPlan& plan, const Point2& p, const Point2& direction) {
  int open = 0;
  for (const double aside : {-0.5, 0.0, 0.5}) {
    const Segment2 look{p, p + kFar_m * (Pose2(0, 0, aside).rotation() * direction)};
    bool walled = false;
    for (std::size_t w = 0; w < plan.walls.size() && !walled; ++w)
      walled = intersection(look, plan.wall_line(static_cast<int>(w))).has_value();
    open += !walled;
  }
  return open >= 2;
}

/// Gates that the drawing leaves open are shut: a robot is not to look for its way outside of the building.
void shut_gates(FloorPlan& plan) {
  std::vector<Segment2> gates;
  for (std::size_t r = 0; r < plan.rooms.size(); ++r) {
    const Polygon ring = plan.outline(static_cast<int>(r));
    for (std::size_t i = 0; i < ring.size(); ++i)
      for (const Segment2& gap : gaps_along(plan, {ring[i], ring[(i + 1) % ring.size()]})) {
        const Point2 outward = -gap.normal();  // rings go counter-clockwise
        if (is_outside(plan, gap.midpoint() + 0.1 * outward, outward)) gates.push_back(gap);
      }
  }
  for (const Segment2& gate : gates) {
    const int a = corner_at(plan, gate.a), b = corner_at(plan, gate.b);
    if (a != b) plan.walls.push_back({a, b, 0.10, Material::kWood, false});
  }
}

}  // namespace

Result<LayoutMap> read_drawing(const std::string& path, double metres_per_pixel) {
  cv::Mat picture = cv::imread(path, cv::IMREAD_GRAYSCALE);
  if (picture.empty()) return fail(Errc::kIo, "cannot read " + path);
  if (cv::mean(picture)[0] < 128) picture = 255 - picture;
  cv::threshold(picture, picture, 100, 255, cv::THRESH_BINARY);  // grey is outside, not wall
  LayoutOptions options;
  options.metres_per_pixel = metres_per_pixel;
  auto reading = read_layout(picture, options);
  if (!reading) return reading.error();
  return std::move(reading->layout);
}

Result<FloorPlan> building_of_plan(const LayoutMap& layout, std::uint64_t seed) {
  FloorPlan plan;
  plan.title = "building as drawn";
  const PixelFrame frame = layout.frame();
  for (const LayoutCorner& c : layout.corners) plan.corners.push_back(frame.to_metres(c.p_px));
  for (const LayoutWall& w : layout.walls) {
    if (w.corner_a == w.corner_b) continue;
    const double thickness = std::clamp(w.thickness_px * frame.metres_per_pixel, 0.10, 0.40);
    plan.walls.push_back({w.corner_a, w.corner_b, thickness, Material::kBrick, false});
  }
  if (plan.walls.empty()) return fail(Errc::kDegenerate, "the drawing has no walls");
  take_rooms(layout, plan);
  if (plan.rooms.empty()) return fail(Errc::kDegenerate, "the drawing has no rooms");
  shut_gates(plan);
  cut_doors(plan, seed);
  return plan;
}

const std::vector<RealPlan>& real_plans() {
  static const std::vector<RealPlan> plans{{"Hannover", "acg/layouts/hannover_walls.jpeg", 0.043},
                                           {"Dortmund", "acg/layouts/floor_dormund_walls.png", 0.0091},
                                           {"Oerebro", "acg/layouts/emergbasement_flipped_nodoor.png", 0.0623}};
  return plans;
}

}  // namespace smokemap::bench
