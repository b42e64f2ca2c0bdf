#include "tests/bench/segmentation_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "core/random.hpp"
#include "matching/assignment.hpp"
#include "segmentation/maoris.hpp"
#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"

namespace smokemap::bench {
namespace {

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

double matthews(double both, double only_region, double only_room, double all) {
  const double neither = all - both - only_region - only_room;
  const double product = (both + only_region) * (both + only_room) * (neither + only_region) * (neither + only_room);
  if (product <= 0) return only_region == 0 && only_room == 0 && both > 0 ? 1 : 0;
  return std::max(0.0, (both * neither - only_region * only_room) / std::sqrt(product));
}

Eigen::MatrixXd overlaps(const cv::Mat& labels, const cv::Mat& truth) {
  double most_label = 0, most_room = 0;
  cv::minMaxLoc(labels, nullptr, &most_label);
  cv::minMaxLoc(truth, nullptr, &most_room);
  Eigen::MatrixXd overlap =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(most_label) + 1, static_cast<Eigen::Index>(most_room) + 1);
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) overlap(labels.at<unsigned short>(y, x), truth.at<unsigned short>(y, x)) += 1;
  return overlap;
}

struct JudgedSet {
  const char *name, *folder, *picture;
};
constexpr std::array kSets = {
    JudgedSet{"robot", "robot_maps", "map.png"}, JudgedSet{"survey", "robot_maps_survey", "map.png"},
    JudgedSet{"furniture", "robot_maps_survey", "map_furnitures.png"}, JudgedSet{"sketches", "sketches", "map.png"}};

struct SetTally {
  int maps = 0;
  double strict = 0, worst = 2, cpu_s = 0, slowest_s = 0, megapixels = 0;
  std::string worst_map;

  void add(const std::string& name, double score) {
    maps += 1, strict += score;
    if (score < worst) worst = score, worst_map = name;
  }
};

/// Every truth of one map (several people may have drawn one).
void judge_map(const std::filesystem::path& place, const char* picture, bool maoris, bool every_map, SetTally& tally) {
  const auto free_space = free_space_of_picture(cv::imread((place / picture).string(), cv::IMREAD_GRAYSCALE));
  if (!free_space) return;
  const std::clock_t begin = std::clock();
  const auto found = maoris ? segment_maoris(*free_space) : segment(*free_space);
  const double cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  tally.cpu_s += cpu_s, tally.slowest_s = std::max(tally.slowest_s, cpu_s);
  tally.megapixels += 1e-6 * static_cast<double>(free_space->total());
  for (const auto& file : std::filesystem::directory_iterator(place)) {
    const std::string name = file.path().filename().string();
    if (!name.starts_with("gt") || file.path().extension() != ".png") continue;
    const cv::Mat truth = rooms_of_drawing(cv::imread(file.path().string(), cv::IMREAD_GRAYSCALE));
    if (truth.size() != free_space->size()) continue;  // of another picture of the same place
    const double score = found ? strict_score(found->labels, truth) : 0;
    tally.add(place.filename().string(), score);
    if (every_map) std::printf("    %s %s  %.3f\n", place.filename().c_str(), name.c_str(), score);
  }
}

}  // namespace

double strict_score(const cv::Mat& labels, const cv::Mat& truth) {
  const Eigen::MatrixXd overlap = overlaps(labels, truth);
  const Eigen::VectorXd rooms = overlap.colwise().sum().transpose();
  const double all = rooms.tail(rooms.size() - 1).sum();
  std::vector<Eigen::Index> regions;  // those that touch a true room at all
  for (Eigen::Index i = 1; i < overlap.rows(); ++i)
    if (overlap.row(i).tail(overlap.cols() - 1).sum() > 0) regions.push_back(i);
  Eigen::MatrixXd score(static_cast<Eigen::Index>(regions.size()), overlap.cols() - 1);
  for (Eigen::Index i = 0; i < score.rows(); ++i) {
    const auto row = overlap.row(regions[static_cast<size_t>(i)]);
    const double area = row.tail(row.size() - 1).sum();
    for (Eigen::Index j = 0; j < score.cols(); ++j)
      score(i, j) = matthews(row(j + 1), area - row(j + 1), rooms(j + 1) - row(j + 1), all);
  }
  const std::vector<int> room_of = best_assignment(score);
  double sum = 0, pairs = 0;
  for (size_t i = 0; i < room_of.size(); ++i)
    if (room_of[i] >= 0) sum += score(static_cast<Eigen::Index>(i), room_of[i]), pairs += 1;
  const double known = static_cast<double>((rooms.tail(rooms.size() - 1).array() > 0).count());
  const double count = static_cast<double>(regions.size()) + known - pairs;
  return count > 0 ? sum / count : 0;
}

cv::Mat rooms_of_drawing(const cv::Mat& gray) {
  const cv::Mat kernel = cv::Mat::ones(3, 3, CV_8U);
  cv::Mat free_space, labels, rooms;
  cv::erode(gray > 250, free_space, kernel);
  cv::connectedComponents(free_space, labels, 8, CV_16U);
  cv::dilate(labels, rooms, kernel);
  return rooms;
}

void print_generated_segmentation() {
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

Result<Ok> print_judged_segmentation(const std::string& folder, bool every_map) {
  std::printf("%-10s %-7s %5s %7s %7s %-16s %12s %9s\n", "maps", "method", "truth", "strict", "worst", "(which)",
              "s/megapixel", "slowest s");
  bool any = false;
  for (const JudgedSet& set : kSets) {
    const std::filesystem::path where = std::filesystem::path(folder) / set.folder;
    if (!std::filesystem::is_directory(where)) continue;
    std::vector<std::filesystem::path> places;
    for (const auto& entry : std::filesystem::directory_iterator(where)) places.push_back(entry.path());
    std::sort(places.begin(), places.end());
    for (const bool maoris : {false, true}) {
      SetTally tally;
      for (const auto& place : places)
        if (std::filesystem::exists(place / set.picture)) judge_map(place, set.picture, maoris, every_map, tally);
      if (tally.maps == 0) continue;
      any = true;
      std::printf("%-10s %-7s %5d %7.3f %7.3f %-16.16s %12.2f %9.2f\n", set.name, maoris ? "maoris" : "cuts",
                  tally.maps, tally.strict / tally.maps, tally.worst, tally.worst_map.c_str(),
                  tally.cpu_s / tally.megapixels, tally.slowest_s);
      std::fflush(stdout);
    }
  }
  if (!any) return fail(Errc::kNotFound, folder + " has none of the folders robot_maps, robot_maps_survey, sketches");
  return Ok{};
}

}  // namespace smokemap::bench
