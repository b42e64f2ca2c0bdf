// How well and how fast plans are read: random buildings drawn as evacuation plans (flat sheet, and photographed).
// Walls are scored by length within 0.5 % of the sheet, as share found (recall) and share right (precision); the
// sheet's corners in percent of its side; signs by colour; taps = what a scripted person would do from the first
// reading to the right plan: one to erase a false wall, one drag for a missing one, a drag for each sheet corner off by
// over half a percent. Data: simulation, seeds below. One thread's CPU time.
#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "layout/read_layout.hpp"
#include "simulation/plan_picture.hpp"
#include "simulation/random_building.hpp"

namespace {

using namespace smokemap;

double cpu_seconds_now() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<Segment2> segments(const LayoutMap& map) {
  std::vector<Segment2> walls;
  for (std::size_t w = 0; w < map.walls.size(); ++w) walls.push_back(map.wall_px(static_cast<int>(w)));
  return walls;
}

double uncovered_length(const Segment2& s, const std::vector<Segment2>& those, double tolerance_px) {
  double uncovered = 0;
  for (double t = 0.5; t < s.length(); t += 2) {
    const Point2 p = s.a + t * s.direction();
    const bool covered = std::any_of(those.begin(), those.end(), [&](const Segment2& o) {
      return distance(o, p) < tolerance_px && line_angle_between(o.heading(), s.heading()) < radians(10);
    });
    if (!covered) uncovered += 2;
  }
  return std::min(uncovered, s.length());
}

double covered_share(const std::vector<Segment2>& these, const std::vector<Segment2>& those, double tolerance_px) {
  double uncovered = 0, all = 0;
  for (const auto& s : these) all += s.length(), uncovered += uncovered_length(s, those, tolerance_px);
  return all > 0 ? 1 - uncovered / all : 0;
}

/// Walls of which at least a piece worth a correction (2 % of the sheet, and half of the wall) is not in the others.
int corrections(const std::vector<Segment2>& these, const std::vector<Segment2>& those, double sheet_px) {
  return static_cast<int>(std::count_if(these.begin(), these.end(), [&](const Segment2& s) {
    const double uncovered = uncovered_length(s, those, 0.005 * sheet_px);
    return uncovered > 0.02 * sheet_px && 2 * uncovered > s.length();
  }));
}

Point2 through(const std::array<double, 9>& H, const Point2& p) {
  const double z = H[6] * p.x() + H[7] * p.y() + H[8];
  return {(H[0] * p.x() + H[1] * p.y() + H[2]) / z, (H[3] * p.x() + H[4] * p.y() + H[5]) / z};
}

/// Signs of the drawing found with their colour, and signs found where the drawing has none of that colour.
struct SignCount {
  int truth = 0, found = 0, wrong = 0;
};
SignCount count_signs(const LayoutMap& truth, std::vector<LayoutSign> found, const cv::Rect2d& plan) {
  SignCount count{static_cast<int>(truth.signs.size()), 0, 0};
  std::erase_if(found, [&](const LayoutSign& s) { return !plan.contains({s.p_px.x(), s.p_px.y()}); });
  for (const auto& sign : truth.signs) {
    const auto hit = std::find_if(found.begin(), found.end(), [&](const LayoutSign& s) {
      return s.colour == sign.colour && (s.p_px - sign.p_px).norm() < 1.2 * sign.radius_px;
    });
    if (hit != found.end()) count.found += 1, found.erase(hit);
  }
  count.wrong = static_cast<int>(found.size());
  return count;
}

struct Row {
  double recall = 0, precision = 0, corner_percent = 0, cpu_s = 0;
  int rooms = 0, true_rooms = 0, taps = 0;
  SignCount signs;
};

Row measure(LayoutReading reading, const PlanPicture& picture, const LayoutMap& truth, bool photo) {
  const auto& H = picture.homography.H_layout_photo;
  Row row;
  auto found = segments(reading.layout);
  if (photo) {
    for (auto& s : found) s = {through(H, s.a), through(H, s.b)};
    for (auto& s : reading.layout.signs) s.p_px = through(H, s.p_px);
    const double w = picture.sheet.cols - 1, h = picture.sheet.rows - 1;
    const std::array<Point2, 4> corners{Point2(0, 0), Point2(w, 0), Point2(w, h), Point2(0, h)};
    for (std::size_t i = 0; i < 4; ++i) {
      const double off = 100 * (through(H, reading.sheet_corners_px[i]) - corners[i]).norm() / w;
      row.corner_percent = std::max(row.corner_percent, off);
      row.taps += off > 0.5;
    }
  }
  const auto drawn = segments(truth);
  std::vector<Segment2> allowed = drawn;  // a wall read across an opening costs nothing here: taps for gaps are few
  for (const auto& o : truth.openings) allowed.push_back(o.gap_px);
  const double sheet = picture.sheet.cols;
  row.recall = covered_share(drawn, found, 0.005 * sheet);
  row.precision = covered_share(found, allowed, 0.005 * sheet);
  row.taps += corrections(drawn, found, sheet) + corrections(found, allowed, sheet);
  row.rooms = static_cast<int>(reading.layout.rooms_px.size());
  row.true_rooms = static_cast<int>(truth.rooms_px.size());
  Point2 low = drawn.front().a, high = low;
  for (const auto& s : drawn) low = low.cwiseMin(s.a).cwiseMin(s.b), high = high.cwiseMax(s.a).cwiseMax(s.b);
  const double margin = 0.03 * sheet;
  row.signs = count_signs(
      truth, reading.layout.signs,
      {low.x() - margin, low.y() - margin, high.x() - low.x() + 2 * margin, high.y() - low.y() + 2 * margin});
  return row;
}

}  // namespace

int main() {
  cv::setNumThreads(1);
  std::printf("%-5s %-6s %7s %10s %7s %9s %7s %8s %5s %6s\n", "seed", "kind", "recall", "precision", "rooms",
              "corners %", "signs", "wrong", "taps", "cpu s");
  std::vector<int> taps;
  for (int seed = 1; seed <= 6; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const auto building = random_building({}, random);
    if (!building) return 1;
    const auto plan = distort(*building, {}, random);
    if (!plan) return 1;
    PlanPictureParams params;
    params.width_px = 2400;
    params.photo = true;
    const auto picture = draw_plan(plan->drawn, params, random);
    if (!picture) return 1;
    const auto truth = true_layout(*plan, *picture);
    for (const bool photo : {false, true}) {
      const double begin = cpu_seconds_now();
      auto reading = read_layout(photo ? picture->photo : picture->sheet);
      const double cpu_s = cpu_seconds_now() - begin;
      const char* kind = photo ? "photo" : "sheet";
      if (!reading) {
        std::printf("%-5d %-6s %s\n", seed, kind, reading.error().message.c_str());
        continue;
      }
      const Row row = measure(std::move(*reading), *picture, truth.layout, photo);
      taps.push_back(row.taps);
      std::printf("%-5d %-6s %7.3f %10.3f %3d/%-3d %9.2f %3d/%-3d %8d %5d %6.2f\n", seed, kind, row.recall,
                  row.precision, row.rooms, row.true_rooms, row.corner_percent, row.signs.found, row.signs.truth,
                  row.signs.wrong, row.taps, cpu_s);
    }
  }
  std::sort(taps.begin(), taps.end());
  if (!taps.empty()) std::printf("taps, median: %d\n", taps[taps.size() / 2]);
}
