#include "tests/bench/halmstad_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "geometry/similarity2.hpp"
#include "grids/grid_frame.hpp"

namespace smokemap::bench {
namespace {

constexpr double kReach_m = 12;
constexpr double kClear_m = 0.35;
constexpr double kStep_m = 0.9;

/// A table of two columns of 8-byte numbers as NumPy stores it; empty for anything else.
template <typename T>
std::vector<std::array<T, 2>> read_npy(const std::string& path, const char* type) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (bytes.size() < 10 || bytes.compare(1, 5, "NUMPY") != 0) return {};
  const std::size_t header = 10 + static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]);
  const std::string description = bytes.substr(10, header - 10);
  if (description.find(type) == std::string::npos || description.find("'fortran_order': True") != std::string::npos)
    return {};
  std::vector<std::array<T, 2>> out((bytes.size() - header) / (2 * sizeof(T)));
  std::memcpy(out.data(), bytes.data() + header, out.size() * 2 * sizeof(T));
  return out;
}

double height_px(const std::string& png) { return cv::imread(png, cv::IMREAD_GRAYSCALE).rows; }

bool can_be_true(const std::vector<std::pair<Point2, Point2>>& corners) {
  std::vector<PointPair> pairs;
  Point2 low = corners.front().first, high = low;
  for (const auto& [sensor, layout] : corners) {
    pairs.push_back({sensor, layout, 1});
    low = low.cwiseMin(sensor), high = high.cwiseMax(sensor);
  }
  const auto fit = fit_similarity(pairs);
  if (!fit) return false;
  const auto near = std::count_if(pairs.begin(), pairs.end(), [&](const PointPair& p) {
    return (*fit * p.p_b - p.p_a).norm() < 0.05 * (high - low).norm();
  });
  return 10 * near >= 9 * static_cast<std::ptrdiff_t>(pairs.size());
}

/// Places with room for a robot, each near the one before.
std::vector<cv::Point> walk(const cv::Mat& picture, double metres_per_pixel) {
  cv::Mat clearance;
  cv::distanceTransform(picture > 200, clearance, cv::DIST_L2, 5);
  const int step = std::max(1, static_cast<int>(kStep_m / metres_per_pixel));
  std::vector<cv::Point> left, out;
  for (int y = step / 2; y < picture.rows; y += step)
    for (int x = step / 2; x < picture.cols; x += step)
      if (clearance.at<float>(y, x) * metres_per_pixel > kClear_m) left.emplace_back(x, y);
  while (!left.empty()) {
    const cv::Point here = out.empty() ? left[left.size() / 2] : out.back();
    const auto next = std::min_element(left.begin(), left.end(), [&](const cv::Point& a, const cv::Point& b) {
      return cv::norm(a - here) < cv::norm(b - here);
    });
    out.push_back(*next);
    left.erase(next);
  }
  return out;
}

PoseNode look(const cv::Mat& picture, const PixelFrame& frame, const cv::Point& at, int id) {
  auto hits = std::make_shared<std::vector<Point2>>(), free_ends = std::make_shared<std::vector<Point2>>();
  const double mpp = frame.metres_per_pixel;
  for (int i = 0; i < 720; ++i) {
    const double bearing = i * kPi / 360, c = std::cos(bearing), s = std::sin(bearing);
    double range = 0;
    bool hit = false, known = true;
    for (; range < kReach_m && !hit && known; range += 0.5 * mpp) {
      const int x = at.x + static_cast<int>(std::lround(c * range / mpp)),
                y = at.y - static_cast<int>(std::lround(s * range / mpp));
      if (x < 0 || y < 0 || x >= picture.cols || y >= picture.rows) break;
      hit = picture.at<uchar>(y, x) < 60;
      known = hit || picture.at<uchar>(y, x) > 200;
    }
    (hit ? hits : free_ends)->emplace_back(range * c, range * s);
  }
  PoseNode node;
  node.id = id;
  node.robot = "sensor map";
  node.stamp = from_seconds(id);
  node.T_map_robot = node.T_odom_robot = Pose2(frame.to_metres({at.x + 0.5, at.y + 0.5}), 0);
  node.hits_robot = hits;
  node.free_ends_robot = free_ends;
  return node;
}

}  // namespace

std::vector<PairedMaps> read_paired_maps(const std::string& folder, const std::string& floor) {
  std::vector<PairedMaps> out;
  const std::string base = folder + "/" + floor + "/", layout = floor + "_layout";
  const auto layout_px = read_npy<double>(base + "keypoints_" + layout + ".npy", "<f8");
  std::vector<std::string> names;
  if (!std::filesystem::is_directory(base)) return out;
  for (const auto& entry : std::filesystem::directory_iterator(base)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() == ".png" && stem != layout) names.push_back(stem);
  }
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) {
    PairedMaps maps{name, base + name + ".png", base + layout + ".png", {}};
    const auto sensor_px = read_npy<double>(base + "keypoints_" + name + ".npy", "<f8");
    const double sensor_height = height_px(maps.sensor_png), layout_height = height_px(maps.layout_png);
    for (const auto& [s, l] : read_npy<std::int64_t>(base + "association_" + name + "_" + layout + ".npy", "<i8")) {
      if (s < 0 || l < 0 || s >= static_cast<std::int64_t>(sensor_px.size()) ||
          l >= static_cast<std::int64_t>(layout_px.size()))
        continue;
      const auto &a = sensor_px[static_cast<std::size_t>(s)], &b = layout_px[static_cast<std::size_t>(l)];
      // The data set counts y upwards.
      maps.corners_px.push_back({{a[0], sensor_height - a[1]}, {b[0], layout_height - b[1]}});
    }
    if (maps.corners_px.size() >= 8 && can_be_true(maps.corners_px)) out.push_back(std::move(maps));
  }
  return out;
}

PoseGraph walk_in_picture(const std::string& sensor_png, double metres_per_pixel) {
  PoseGraph graph;
  const cv::Mat picture = cv::imread(sensor_png, cv::IMREAD_GRAYSCALE);
  if (picture.empty()) return graph;
  const PixelFrame frame{picture.rows, metres_per_pixel};
  for (const cv::Point& p : walk(picture, metres_per_pixel)) {
    graph.nodes.push_back(look(picture, frame, p, static_cast<int>(graph.nodes.size())));
    if (graph.nodes.size() < 2) continue;
    const PoseNode &before = graph.nodes[graph.nodes.size() - 2], &here = graph.nodes.back();
    PoseEdge edge;
    edge.from = before.id;
    edge.to = here.id;
    edge.T_from_to = before.T_map_robot.inverse() * here.T_map_robot;
    edge.sqrt_information = Eigen::Vector3d(1000, 1000, 5000).asDiagonal();
    graph.edges.push_back(edge);
  }
  return graph;
}

}  // namespace smokemap::bench
