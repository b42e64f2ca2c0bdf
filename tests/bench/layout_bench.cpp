// How well and how fast plans are read: random buildings drawn as evacuation plans (flat sheet, and photographed),
// walls scored by length within 0.5 % of the plan, as share found (recall) and share right (precision). Data:
// simulation, seeds below. One thread's CPU time.
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

double covered_share(const std::vector<Segment2>& these, const std::vector<Segment2>& those, double tolerance_px) {
  double covered = 0, all = 0;
  for (const auto& s : these)
    for (double t = 0.5; t < s.length(); t += 2) {
      const Point2 p = s.a + t * s.direction();
      all += 1;
      for (const auto& o : those)
        if (distance(o, p) < tolerance_px && line_angle_between(o.heading(), s.heading()) < radians(10)) {
          covered += 1;
          break;
        }
    }
  return all > 0 ? covered / all : 0;
}

Point2 through(const std::array<double, 9>& H, const Point2& p) {
  const double z = H[6] * p.x() + H[7] * p.y() + H[8];
  return {(H[0] * p.x() + H[1] * p.y() + H[2]) / z, (H[3] * p.x() + H[4] * p.y() + H[5]) / z};
}

}  // namespace

int main() {
  cv::setNumThreads(1);
  std::printf("%-6s %-6s %8s %10s %6s %8s %7s\n", "seed", "kind", "recall", "precision", "rooms", "drawn", "cpu s");
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
      const auto reading = read_layout(photo ? picture->photo : picture->sheet);
      const double cpu = cpu_seconds_now() - begin;
      if (!reading) {
        std::printf("%-6d %-6s %s\n", seed, photo ? "photo" : "sheet", reading.error().message.c_str());
        continue;
      }
      auto found = segments(reading->layout);
      if (photo)
        for (auto& s : found)
          s = {through(picture->homography.H_layout_photo, s.a), through(picture->homography.H_layout_photo, s.b)};
      const auto drawn = segments(truth.layout);
      const double tolerance = 0.005 * picture->sheet.cols;
      std::printf("%-6d %-6s %8.3f %10.3f %6zu %8zu %7.2f\n", seed, photo ? "photo" : "sheet",
                  covered_share(drawn, found, tolerance), covered_share(found, drawn, tolerance),
                  reading->layout.rooms_px.size(), truth.layout.rooms_px.size(), cpu);
    }
  }
}
