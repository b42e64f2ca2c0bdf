#include "tests/bench/judged_pairs.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <utility>

#include "core/random.hpp"
#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"
#include "tests/support/plan_sketches.hpp"

namespace smokemap::bench {
namespace {

bool is_member(const std::vector<int>& labels, int label) {
  return std::find(labels.begin(), labels.end(), label) != labels.end();
}

Point2 middle_of(const std::vector<Point2>& points) {
  Point2 sum = Point2::Zero();
  for (const Point2& p : points) sum += p;
  return sum / static_cast<double>(std::max<size_t>(1, points.size()));
}

std::vector<Point2> points_of(const nlohmann::json& list) {
  std::vector<Point2> points;
  for (const auto& p : list) points.emplace_back(p[0].get<double>(), p[1].get<double>());
  return points;
}

struct Timed {
  Segmentation segmentation;
  double ms = 0;
};

Result<Timed> segment_timed(const cv::Mat& free_space, const Segmenter& segmenter) {
  const std::clock_t begin = std::clock();
  auto segmentation = segmenter(free_space);
  const double ms = 1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  if (!segmentation) return segmentation.error();
  return Timed{std::move(*segmentation), ms};
}

Result<Timed> read_and_segment(const std::string& path, const Segmenter& segmenter) {
  const auto free_space = free_space_of_picture(cv::imread(path, cv::IMREAD_GRAYSCALE));
  if (!free_space) return fail(free_space.error().code, path + ": " + free_space.error().message);
  return segment_timed(*free_space, segmenter);
}

cv::Mat read_labels(const std::string& path) {
  cv::Mat labels = cv::imread(path, cv::IMREAD_UNCHANGED), wide;
  if (labels.channels() > 1) cv::extractChannel(labels, labels, 0);
  labels.convertTo(wide, CV_16U);
  return wide;
}

/// The room of the truth that most pixels of a region lie in, 0 if none.
int room_of(const cv::Mat& labels, int label, const cv::Mat& truth) {
  std::map<int, int> count;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (labels.at<unsigned short>(y, x) == label && truth.at<unsigned short>(y, x) != 0)
        ++count[truth.at<unsigned short>(y, x)];
  int best = 0, found = 0;
  for (const auto& [room, pixels] : count)
    if (pixels > best) best = pixels, found = room;
  return found;
}

/// A click into the middle of every drawn room, and where it lies on the plan.
std::vector<JudgedGroup> drawn_rooms(const test::PlanPicture& plan, const test::PlanSketch& sketch) {
  std::vector<JudgedGroup> groups;
  for (int room = 1; room <= static_cast<int>(plan.boxes.size()); ++room) {
    const std::vector<Point2> drawn = pixels_of(sketch.picture.rooms, {room});
    if (drawn.size() < 30) continue;
    const cv::Rect box = plan.boxes[static_cast<size_t>(room - 1)];
    const Point2 middle(box.x + box.width / 2, box.y + box.height / 2);
    const Point2 click = *std::min_element(drawn.begin(), drawn.end(), [&](const Point2& one, const Point2& two) {
      return (sketch.on_plan(one) - middle).squaredNorm() < (sketch.on_plan(two) - middle).squaredNorm();
    });
    groups.push_back({{click}, {middle}, {room}, {room}});
  }
  return groups;
}

}  // namespace

std::vector<Point2> pixels_of(const cv::Mat& labels, const std::vector<int>& members) {
  std::vector<Point2> pixels;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (const int label = labels.at<unsigned short>(y, x); label != 0 && is_member(members, label))
        pixels.emplace_back(x, y);
  return pixels;
}

Eigen::Matrix2d best_rotation(const std::vector<Point2>& from, const std::vector<Point2>& to) {
  const Point2 mean_from = middle_of(from), mean_to = middle_of(to);
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (size_t i = 0; i < from.size(); ++i) moment += (to[i] - mean_to) * (from[i] - mean_from).transpose();
  if (moment.norm() < 1e-9) return Eigen::Matrix2d::Identity();
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Eigen::Vector2d(1, sign).asDiagonal() * svd.matrixV().transpose();
}

Matching true_matching(const JudgedPair& pair) {
  Matching matching;
  std::vector<int> rooms_a, rooms_b;
  for (const Region& a : pair.a.regions) rooms_a.push_back(room_of(pair.a.labels, a.label, pair.truth_a));
  for (const Region& b : pair.b.regions) rooms_b.push_back(room_of(pair.b.labels, b.label, pair.truth_b));
  std::vector<Point2> from, to;
  for (size_t i = 0; i < rooms_a.size(); ++i)
    for (size_t j = 0; j < rooms_b.size(); ++j) {
      const bool same = std::any_of(pair.groups.begin(), pair.groups.end(), [&](const JudgedGroup& group) {
        return is_member(group.labels_a, rooms_a[i]) && is_member(group.labels_b, rooms_b[j]);
      });
      if (!same) continue;
      matching.pairs.push_back({pair.a.regions[i].label, pair.b.regions[j].label, 1, Verdict::kProposed});
      from.push_back(pair.a.regions[i].centroid_px), to.push_back(pair.b.regions[j].centroid_px);
    }
  if (from.size() > 1) matching.turn_b_a = best_rotation(from, to);
  return matching;
}

Result<std::vector<JudgedPair>> read_judged_pairs(const std::string& folder, const std::string& set,
                                                  const Segmenter& segmenter) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path where = std::filesystem::path(folder) / set / "gt";
  if (!std::filesystem::is_directory(where)) return fail(Errc::kNotFound, "there is no folder " + where.string());
  for (const auto& entry : std::filesystem::directory_iterator(where))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<JudgedPair> pairs;
  std::map<std::string, Timed> known;  // the metric map is the same for many
  for (const auto& file : files) {
    std::ifstream stream(file);
    const nlohmann::json record = nlohmann::json::parse(stream, nullptr, false);
    if (record.is_discarded()) return fail(Errc::kCorrupt, file.string() + " is not JSON");
    const auto path_of = [&](const char* key) { return folder + "/" + record[key].get<std::string>(); };
    for (const char* key : {"sketch", "metric"}) {
      if (known.contains(path_of(key))) continue;
      auto segmentation = read_and_segment(path_of(key), segmenter);
      if (!segmentation) return segmentation.error();
      known[path_of(key)] = std::move(*segmentation);
    }
    const Timed &a = known[path_of("sketch")], &b = known[path_of("metric")];
    for (const auto& [annotator, said] : record["annotators"].items()) {
      JudgedPair pair{set, file.stem().string(), annotator, a.segmentation, b.segmentation, {}, {}, {},
                      {},  a.ms + b.ms};
      pair.truth_a = read_labels(path_of("sketch_labels"));
      pair.truth_b = read_labels(path_of("metric_labels"));
      for (const auto& group : said["groups"])
        pair.groups.push_back({points_of(group["sketch_points"]), points_of(group["metric_points"]),
                               group["sketch_labels"].get<std::vector<int>>(),
                               group["metric_labels"].get<std::vector<int>>()});
      pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

std::vector<JudgedPair> generated_pairs(int count, std::uint64_t first_seed, const Segmenter& segmenter, Wear wear) {
  std::vector<JudgedPair> pairs;
  for (std::uint64_t seed = first_seed; static_cast<int>(pairs.size()) < count; ++seed) {
    std::mt19937_64 random(seed);
    const test::PlanPicture plan =
        seed % 2 ? test::hall_plan(random) : test::office_plan(random, 2 + static_cast<int>(uniform_index(random, 4)));
    const auto worn = [&] {
      const auto most = static_cast<std::uint64_t>(plan.boxes.size() / 3);
      return wear == Wear::kNone ? plan
                                 : test::with_stubs(plan, static_cast<int>(uniform_index(random, 1 + most)), random);
    };
    const test::PlanPicture map = worn(), remembered = worn();
    const test::PlanSketch sketch = test::sketch_of(remembered, test::random_habits(random), random);
    auto a = segment_timed(sketch.picture.free_space, segmenter), b = segment_timed(map.free_space, segmenter);
    if (!a || !b) continue;
    JudgedPair pair{wear == Wear::kNone ? "generated" : "stubs",
                    std::to_string(seed),
                    "truth",
                    std::move(a->segmentation),
                    std::move(b->segmentation),
                    sketch.picture.rooms,
                    plan.rooms,
                    sketch.to_plan,
                    {},
                    a->ms + b->ms};
    pair.groups = drawn_rooms(plan, sketch);
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace smokemap::bench
