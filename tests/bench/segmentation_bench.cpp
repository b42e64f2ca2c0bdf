// How well and how fast free space is split into rooms: random office plans with known rooms, clean, with chairs, with
// a pixel of noise on the walls, and turned. Rooms found are those of which one region covers the room by more than
// half of their union. Ours beside MAORIS. Data: generated, seeds below. One thread's CPU time.
#include <array>
#include <cstdio>
#include <ctime>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "core/random.hpp"
#include "segmentation/maoris.hpp"
#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"

namespace {

using namespace smokemap;

constexpr int kPlans = 12;

void add_chairs(cv::Mat& map, std::mt19937_64& random) {
  for (int i = 0; i < 150; ++i) {
    const int x = static_cast<int>(uniform(random, 0, map.cols - 4)),
              y = static_cast<int>(uniform(random, 0, map.rows - 4));
    const cv::Mat around =
        map(cv::Rect(std::max(0, x - 5), std::max(0, y - 5), std::min(13, map.cols - x), std::min(13, map.rows - y)));
    if (cv::countNonZero(around) == static_cast<int>(around.total())) map(cv::Rect(x, y, 3, 3)).setTo(0);
  }
}

void roughen(cv::Mat& map, std::mt19937_64& random) {
  cv::Mat grown;
  cv::dilate(map, grown, cv::Mat());
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.cols; ++x)
      if (grown.at<unsigned char>(y, x) != map.at<unsigned char>(y, x) && uniform01(random) < 0.3)
        map.at<unsigned char>(y, x) = 255;
}

void turn(test::PlanPicture& plan, double angle_deg) {
  const cv::Point2f middle(0.5f * static_cast<float>(plan.free_space.cols),
                           0.5f * static_cast<float>(plan.free_space.rows));
  cv::Mat motion = cv::getRotationMatrix2D(middle, angle_deg, 1);
  motion.at<double>(0, 2) += 150;
  motion.at<double>(1, 2) += 200;
  const cv::Size size(plan.free_space.cols + 300, plan.free_space.rows + 400);
  cv::warpAffine(plan.free_space.clone(), plan.free_space, motion, size, cv::INTER_NEAREST);
  cv::warpAffine(plan.rooms.clone(), plan.rooms, motion, size, cv::INTER_NEAREST);
}

struct Tally {
  double rooms = 0, regions = 0, found = 0, cpu_s = 0, megapixels = 0;

  void add(const test::PlanPicture& plan, bool maoris) {
    const std::clock_t begin = std::clock();
    const Result<Segmentation> result = maoris ? segment_maoris(plan.free_space) : segment(plan.free_space);
    cpu_s += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    megapixels += 1e-6 * static_cast<double>(plan.free_space.total());
    rooms += static_cast<double>(plan.boxes.size());
    if (!result) return;
    regions += static_cast<double>(result->regions.size());
    for (const Region& region : result->regions)
      found += test::true_room(result->labels, region.label, plan.rooms).overlap > 0.5;
  }
};

}  // namespace

int main() {
  cv::setNumThreads(1);
  std::printf("%-8s %-7s %6s %8s %8s %10s %12s\n", "plans", "method", "rooms", "regions", "recall", "precision",
              "s/megapixel");
  for (const char* kind : {"clean", "chairs", "rough", "turned"})
    for (const bool maoris : {false, true}) {
      Tally tally;
      for (int seed = 1; seed <= kPlans; ++seed) {
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        test::PlanPicture plan = test::office_plan(random);
        if (kind[0] == 'c' && kind[1] == 'h') add_chairs(plan.free_space, random);
        if (kind[0] == 'r') roughen(plan.free_space, random);
        if (kind[0] == 't') turn(plan, 7.0 * seed);
        tally.add(plan, maoris);
      }
      std::printf("%-8s %-7s %6.0f %8.0f %8.3f %10.3f %12.2f\n", kind, maoris ? "maoris" : "cuts", tally.rooms,
                  tally.regions, tally.found / tally.rooms, tally.found / tally.regions,
                  tally.cpu_s / tally.megapixels);
    }
}
