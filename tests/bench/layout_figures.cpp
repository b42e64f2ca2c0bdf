#include "tests/bench/layout_figures.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

namespace smokemap::bench {
namespace {

constexpr double kWallUnits = 5, kCornerUnits = 10, kTurnDeg = 10;

bool lies_on(const Point2& p, double heading, const std::vector<Segment2>& those, double tolerance_px) {
  return std::any_of(those.begin(), those.end(), [&](const Segment2& o) {
    return distance(o, p) < tolerance_px && line_angle_between(o.heading(), heading) < radians(kTurnDeg);
  });
}

/// Length of `s`, and how much of it lies on those.
std::pair<double, double> covered_length(const Segment2& s, const std::vector<Segment2>& those, double tolerance_px) {
  double on = 0, all = 0;
  for (double t = 0.5; t < s.length(); t += 1.5, all += 1.5)
    if (lies_on(s.a + t * s.direction(), s.heading(), those, tolerance_px)) on += 1.5;
  return {all, on};
}

double covered(const std::vector<Segment2>& these, const std::vector<Segment2>& those, double tolerance_px) {
  double on = 0, all = 0;
  for (const auto& s : these) {
    const auto [length, hit] = covered_length(s, those, tolerance_px);
    all += length, on += hit;
  }
  return all > 0 ? on / all : 0;
}

/// Walls of which a piece worth a correction (2 % of the plan, and half of the wall) is not in the others.
int corrections(const std::vector<Segment2>& these, const std::vector<Segment2>& those, double unit_px) {
  return static_cast<int>(std::count_if(these.begin(), these.end(), [&](const Segment2& s) {
    const auto [all, on] = covered_length(s, those, kWallUnits * unit_px);
    return all - on > 20 * unit_px && 2 * (all - on) > all;
  }));
}

/// Greedy pairs, nearest first.
std::vector<bool> paired(const std::vector<Point2>& these, const std::vector<Point2>& those, double reach_px) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> near;
  for (std::size_t i = 0; i < these.size(); ++i)
    for (std::size_t j = 0; j < those.size(); ++j)
      if (const double d = (these[i] - those[j]).norm(); d < reach_px) near.emplace_back(d, i, j);
  std::sort(near.begin(), near.end());
  std::vector<bool> one(these.size(), false), two(those.size(), false);
  for (const auto& [d, i, j] : near)
    if (!one[i] && !two[j]) one[i] = two[j] = true;
  return one;
}

double share(const std::vector<bool>& flags, std::size_t of) {
  return of ? static_cast<double>(std::count(flags.begin(), flags.end(), true)) / static_cast<double>(of) : 0;
}

/// Corners at which walls of different directions meet.
std::vector<std::size_t> turning_corners(const LayoutMap& map) {
  std::vector<std::vector<double>> headings(map.corners.size());
  for (std::size_t w = 0; w < map.walls.size(); ++w)
    for (const int c : {map.walls[w].corner_a, map.walls[w].corner_b})
      headings[static_cast<std::size_t>(c)].push_back(map.wall_px(static_cast<int>(w)).heading());
  std::vector<std::size_t> turning;
  for (std::size_t c = 0; c < headings.size(); ++c)
    if (std::any_of(headings[c].begin(), headings[c].end(),
                    [&](double h) { return line_angle_between(h, headings[c].front()) > radians(20); }))
      turning.push_back(c);
  return turning;
}

cv::Mat room_mask(const Polygon& room, const Point2& low, double scale, cv::Size size) {
  cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
  std::vector<cv::Point> ring;
  for (const auto& p : room) {
    const Point2 q = scale * (p - low);
    ring.emplace_back(static_cast<int>(std::lround(q.x())), static_cast<int>(std::lround(q.y())));
  }
  if (ring.size() >= 3) cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{ring}, cv::Scalar(255));
  return mask;
}

F1 room_figures(const std::vector<Polygon>& read, const std::vector<Polygon>& truth, const Point2& low, double extent) {
  const double scale = 400 / extent;
  const cv::Size size(440, 440);
  const Point2 origin = low - Point2(20, 20) / scale;
  std::vector<cv::Mat> one, two;
  for (const auto& r : read) one.push_back(room_mask(r, origin, scale, size));
  for (const auto& r : truth) two.push_back(room_mask(r, origin, scale, size));
  int hits = 0;
  for (const auto& t : two)
    hits += std::any_of(one.begin(), one.end(), [&](const cv::Mat& r) {
      return 2 * cv::countNonZero(t & r) >= cv::countNonZero(t | r) && cv::countNonZero(t) > 0;
    });
  return {read.empty() ? 0 : std::min(1.0, hits / static_cast<double>(read.size())),
          truth.empty() ? 0 : hits / static_cast<double>(truth.size())};
}

void count_signs(const LayoutMap& read, const PlanTruth& truth, const cv::Rect2d& plan, PlanFigures& out) {
  auto found = read.signs;
  std::erase_if(found, [&](const LayoutSign& s) { return !plan.contains({s.p_px.x(), s.p_px.y()}); });
  out.signs_true = static_cast<int>(truth.signs.size());
  for (const auto& sign : truth.signs) {
    const auto hit = std::find_if(found.begin(), found.end(), [&](const LayoutSign& s) {
      return (s.colour == sign.colour || s.colour == "grey") && (s.p_px - sign.p_px).norm() < 1.2 * sign.radius_px;
    });
    if (hit != found.end()) out.signs_found += 1, found.erase(hit);
  }
  out.signs_wrong = static_cast<int>(found.size());
}

}  // namespace

PlanFigures measure_plan(const LayoutMap& read, const PlanTruth& truth) {
  PlanFigures out;
  if (truth.walls.empty()) return out;
  Point2 low = truth.walls.front().a, high = low;
  for (const auto& s : truth.walls) low = low.cwiseMin(s.a).cwiseMin(s.b), high = high.cwiseMax(s.a).cwiseMax(s.b);
  const double extent = (high - low).maxCoeff(), unit = extent / 1000;
  std::vector<Segment2> walls;
  for (std::size_t w = 0; w < read.walls.size(); ++w) walls.push_back(read.wall_px(static_cast<int>(w)));
  auto allowed = truth.walls;
  allowed.insert(allowed.end(), truth.openings.begin(), truth.openings.end());
  out.walls = {covered(walls, allowed, kWallUnits * unit), covered(truth.walls, walls, kWallUnits * unit)};
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const auto [all, on] = covered_length(walls[w], allowed, kWallUnits * unit);
    out.said_walls.emplace_back(read.walls[w].confidence, 2 * on > all);
  }
  out.taps = corrections(truth.walls, walls, unit) + corrections(walls, allowed, unit);
  std::vector<Point2> corners;
  const auto turning = turning_corners(read);
  for (const std::size_t c : turning) corners.push_back(read.corners[c].p_px);
  const auto hit = paired(corners, truth.corners, kCornerUnits * unit);
  out.corners = {share(hit, corners.size()), share(hit, truth.corners.size())};
  for (std::size_t i = 0; i < turning.size(); ++i)
    out.said_corners.emplace_back(read.corners[turning[i]].confidence, hit[i]);
  out.rooms = room_figures(read.rooms_px, truth.rooms, low, extent);
  out.rooms_off = std::abs(static_cast<int>(read.rooms_px.size()) - static_cast<int>(truth.rooms.size()));
  const double margin = 0.03 * extent;
  count_signs(read, truth,
              {low.x() - margin, low.y() - margin, high.x() - low.x() + 2 * margin, high.y() - low.y() + 2 * margin},
              out);
  return out;
}

PlanTruth read_truth(const std::string& path, std::string* image) {
  PlanTruth truth;
  std::ifstream file(path);
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_object() || !json.contains("walls")) return truth;
  const auto segments = [&](const char* field) {
    std::vector<Segment2> out;
    for (const auto& s : json.value(field, nlohmann::json::array()))
      if (s.is_array() && s.size() >= 4)
        out.push_back({{s[0].get<double>(), s[1].get<double>()}, {s[2].get<double>(), s[3].get<double>()}});
    return out;
  };
  truth.walls = segments("walls");
  truth.openings = segments("doors");
  for (const auto& c : json.value("corners", nlohmann::json::array()))
    truth.corners.emplace_back(c[0].get<double>(), c[1].get<double>());
  for (const auto& ring : json.value("rooms", nlohmann::json::array())) {
    Polygon room;
    for (const auto& p : ring) room.emplace_back(p[0].get<double>(), p[1].get<double>());
    truth.rooms.push_back(std::move(room));
  }
  if (truth.corners.empty())
    for (std::size_t i = 0; i < truth.walls.size(); ++i)
      for (std::size_t j = i + 1; j < truth.walls.size(); ++j) {
        const auto &a = truth.walls[i], &b = truth.walls[j];
        if (line_angle_between(a.heading(), b.heading()) < radians(20)) continue;
        const auto p = line_intersection(a, b);
        if (!p || distance(a, *p) > 4 || distance(b, *p) > 4) continue;
        const bool known = std::any_of(truth.corners.begin(), truth.corners.end(),
                                       [&](const Point2& c) { return (c - *p).norm() < 4; });
        if (!known) truth.corners.push_back(*p);
      }
  if (image) *image = json.value("image", std::string());
  return truth;
}

}  // namespace smokemap::bench
