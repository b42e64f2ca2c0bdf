#include "tests/bench/acg_data_figures.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include "acg/auto_complete_graph.hpp"
#include "slam/slam.hpp"
#include "tests/bench/acg_figures.hpp"
#include "tests/bench/halmstad_figures.hpp"
#include "tests/bench/plan_building_figures.hpp"

namespace smokemap::bench {
namespace {

constexpr double kSensorScale = 0.022;  ///< Halmstad, metres per pixel: its doors are then 0.9 m wide
constexpr double kLayoutScale = 0.027;
constexpr double kLinkRight_m = 0.45;

struct HalmstadScore {
  std::size_t pairs = 0;
  double before = 0, after = 0;  ///< median error of pairs not used, share of the extent
  double scatter = 0;            ///< of the pairs against each other, the same share
  double links_right = 0, fit = 0, cpu_s = 0;
  std::size_t links = 0;
};

/// The two pairs that are farthest apart.
std::pair<std::size_t, std::size_t> far_pairs(const PairedMaps& maps) {
  std::pair<std::size_t, std::size_t> best{0, 1};
  double apart = 0;
  for (std::size_t i = 0; i < maps.corners_px.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double d = (maps.corners_px[i].first - maps.corners_px[j].first).norm();
      if (d > apart) apart = d, best = {j, i};
    }
  return best;
}

/// What the pairs themselves are worth: the median miss, in pixels of the sensor map, of a pair that its ten nearest
/// others foretell with an affine map.
double scatter_px(const PairedMaps& maps) {
  constexpr std::size_t kOthers = 10;
  constexpr double kNear_px = 30;  // nearer others say no more
  std::vector<double> misses;
  for (const auto& [sensor, layout] : maps.corners_px) {
    std::vector<std::pair<Point2, Point2>> others = maps.corners_px;
    const auto away = [&, &here = layout](const auto& pair) { return (pair.second - here).norm(); };
    std::sort(others.begin(), others.end(), [&](const auto& a, const auto& b) { return away(a) < away(b); });
    others.erase(others.begin());  // itself
    others.resize(std::min(kOthers, others.size()));
    Eigen::MatrixX3d from(others.size(), 3);
    Eigen::MatrixX2d to(others.size(), 2);
    for (std::size_t k = 0; k < others.size(); ++k) {
      const double weight = 1 / (away(others[k]) + kNear_px);
      const auto row = static_cast<Eigen::Index>(k);
      from.row(row) =
          weight * Eigen::RowVector3d(others[k].second.x() - layout.x(), others[k].second.y() - layout.y(), 1);
      to.row(row) = weight * others[k].first.transpose();
    }
    const Eigen::Matrix<double, 3, 2> affine = from.colPivHouseholderQr().solve(to);
    misses.push_back((affine.row(2).transpose() - sensor).norm());
  }
  return median_of(misses);
}

/// Of the kept links whose corner a person paired: how many lie where the person says.
void score_links(const PairedMaps& maps, const LayoutMap& layout, const PixelFrame& sensor, const MergedMap& merged,
                 HalmstadScore& out) {
  std::size_t right = 0;
  for (const MapLink& link : merged.links) {
    if (link.state != LinkState::kKept) continue;
    const Point2 corner = layout.corners[static_cast<std::size_t>(link.layout_corner)].p_px;
    const auto truth = std::find_if(maps.corners_px.begin(), maps.corners_px.end(),
                                    [&](const auto& pair) { return (pair.second - corner).norm() < 8; });
    if (truth == maps.corners_px.end()) continue;
    ++out.links;
    right += (sensor.to_metres(truth->first) - link.p_map).norm() < kLinkRight_m;
  }
  out.links_right = out.links == 0 ? 1 : static_cast<double>(right) / static_cast<double>(out.links);
}

std::optional<HalmstadScore> run_halmstad(const PairedMaps& maps) {
  const auto layout = read_drawing(maps.layout_png, kLayoutScale);
  const PoseGraph graph = walk_in_picture(maps.sensor_png, kSensorScale);
  if (!layout || graph.nodes.empty()) return std::nullopt;
  const PixelFrame sensor{layout->height_px, kSensorScale};
  AutoCompleteGraph acg;
  if (!acg.set_plan(*layout)) return std::nullopt;
  const auto [one, two] = far_pairs(maps);
  std::vector<PointPair> used;
  for (const std::size_t i : {one, two}) {
    const auto& [p_sensor, p_layout] = maps.corners_px[i];
    acg.add_anchor(std::to_string(i), p_layout, sensor.to_metres(p_sensor));
    used.push_back({sensor.to_metres(p_sensor), layout->frame().to_metres(p_layout), 0.1});
  }
  const double begin = cpu_now_s();
  const auto merged = acg.update(graph);
  const auto rigid = fit_similarity(used);
  if (!merged || !rigid) return std::nullopt;
  HalmstadScore out;
  out.cpu_s = cpu_now_s() - begin;
  Point2 low = used.front().p_a, high = low;
  std::vector<double> before, after;
  for (std::size_t i = 0; i < maps.corners_px.size(); ++i) {
    const Point2 truth = sensor.to_metres(maps.corners_px[i].first);
    const Point2 p = layout->frame().to_metres(maps.corners_px[i].second);
    low = low.cwiseMin(truth), high = high.cwiseMax(truth);
    if (i == one || i == two) continue;
    before.push_back((*rigid * p - truth).norm());
    after.push_back((merged->layout_to_map(p) - truth).norm());
  }
  const double extent = (high - low).norm();
  out.pairs = before.size();
  out.scatter = kSensorScale * scatter_px(maps) / extent;
  out.before = median_of(before) / extent, out.after = median_of(after) / extent;
  out.fit = merged->fit.score;
  score_links(maps, *layout, sensor, *merged, out);
  return out;
}

void print_halmstad(const std::string& data, const std::string& floor) {
  std::printf("\n%-10s %5s  %16s %16s %16s  %8s %6s  %5s %6s\n", "Halmstad", "pairs", "two clicks, %", "merged, %",
              "pairs scatter, %", "links P", "links", "fit", "CPU s");
  std::vector<double> before, after, scatter, links;
  for (const PairedMaps& maps : read_paired_maps(data + "/floor_plans/halmstad", floor)) {
    const auto score = run_halmstad(maps);
    if (!score) {
      std::printf("%-10s no answer\n", maps.name.c_str());
      continue;
    }
    std::printf("%-10s %5zu  %16.2f %16.2f %16.2f  %8.2f %6zu  %5.2f %6.1f\n", maps.name.c_str(), score->pairs,
                100 * score->before, 100 * score->after, 100 * score->scatter, score->links_right, score->links,
                score->fit, score->cpu_s);
    std::fflush(stdout);
    before.push_back(score->before), after.push_back(score->after), scatter.push_back(score->scatter);
    links.push_back(score->links_right);
  }
  std::printf(
      "%-10s %5zu  %16.2f %16.2f %16.2f  %8.2f   median over maps of the median corner, per cent of the extent\n",
      floor.c_str(), before.size(), 100 * median_of(before), 100 * median_of(after), 100 * median_of(scatter),
      median_of(links));
}

/// Pixel of the drawing and metre of the robot's map (the data set's calibration/correspondences.json).
constexpr std::array<std::array<double, 4>, 4> kOerebro{
    {{786, 373, 19.36, 6.25}, {788, 311, 19.14, 2.25}, {614, 306, 7.64, 3.63}, {637, 529, 9.5, 16.0}}};

/// The drawing bent until the four pairs are in their places: a similarity and, by distance, what it leaves over.
class BentDrawing {
 public:
  explicit BentDrawing(const PixelFrame& frame) {
    for (const auto& p : kOerebro)
      pairs_.push_back({{p[2], -p[3]}, frame.to_metres({p[0], p[1]}), 0.1});  // its y axis points down
    similarity_ = *fit_similarity(pairs_);
  }
  Point2 operator()(const Point2& p_layout) const {
    Point2 sum = Point2::Zero();
    double weights = 1e-9;
    for (const PointPair& pair : pairs_) {
      const double d = (pair.p_b - p_layout).norm(), w = 1 / (d * d + 1e-6);
      sum += w * (pair.p_a - similarity_ * pair.p_b), weights += w;
    }
    return similarity_ * p_layout + sum / weights;
  }
  const std::vector<PointPair>& pairs() const { return pairs_; }

 private:
  std::vector<PointPair> pairs_;
  Similarity2 similarity_;
};

/// The building that the published robot measured, as far as anybody can know it, and the drawing of it.
Result<DemoScenario> oerebro(const LayoutMap& layout, const BentDrawing& bent, std::uint64_t seed) {
  auto building = building_of_plan(layout, seed);
  if (!building) return building.error();
  DemoScenario demo;
  demo.seed = seed;
  demo.building = std::move(*building);
  // Doors cut wall pieces in two on the plan as well: the plan is what a perfect reader sees of the unbent building.
  demo.plan.drawn = demo.building;
  for (Point2& p : demo.building.corners) p = bent(p);
  demo.plan.corner_world = demo.building.corners;
  for (std::size_t w = 0; w < demo.building.walls.size(); ++w) demo.plan.wall_source.push_back(static_cast<int>(w));
  PlanPicture sheet;
  sheet.metres_per_pixel = layout.scale->metres_per_pixel;
  sheet.origin_plan = Point2(0, layout.height_px * sheet.metres_per_pixel);
  sheet.sheet = cv::Mat(layout.height_px, layout.width_px, CV_8U);
  demo.picture = sheet;
  demo.truth = true_layout(demo.plan, demo.picture);
  demo.world.walls = build_world(demo.building);
  return demo;
}

void print_oerebro(const std::string& data) {
  const RealPlan& plan = real_plans().back();
  const auto layout = read_drawing(data + "/" + plan.file, plan.metres_per_pixel);
  if (!layout) {
    std::printf("Oerebro: %s\n", layout.error().message.c_str());
    return;
  }
  const BentDrawing bent(layout->frame());
  std::vector<double> three, four, three_before, four_before;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    auto demo = oerebro(*layout, bent, seed);
    if (!demo) {
      std::printf("Oerebro seed %d: %s\n", static_cast<int>(seed), demo.error().message.c_str());
      continue;
    }
    const auto& pairs = bent.pairs();
    // Along the corridor past all four places.
    const Point2 corridor = bent(layout->frame().to_metres({700, 345}));
    demo->T_world_start = Pose2(corridor, 0);
    RunParams drive;
    drive.with_radar = false;
    drive.max_duration_s = 400;
    for (const PointPair& p : pairs)
      for (const Point2& off : {Point2(1.2, 1.2), Point2(-1.2, 1.2), Point2(1.2, -1.2), Point2(-1.2, -1.2)})
        drive.waypoints.push_back(p.p_a + off);
    const auto run = record_run(*demo, drive);
    if (!run) {
      std::printf("Oerebro seed %d: %s\n", static_cast<int>(seed), run.error().message.c_str());
      continue;
    }
    Slam slam;
    for (const auto& item : run->items) {
      if (const auto* odometry = std::get_if<Odometry>(&item)) slam.add_odometry(*odometry);
      if (const auto* scan = std::get_if<LaserScan>(&item)) (void)slam.add_scan(*scan).ok();
    }
    slam.polish();
    AutoCompleteGraph acg;
    if (const auto set = acg.set_plan(demo->truth.layout); !set) {
      std::printf("Oerebro seed %d: %s\n", static_cast<int>(seed), set.error().message.c_str());
      continue;
    }
    for (const std::size_t i : {0u, 1u})
      acg.add_anchor(std::to_string(i), {kOerebro[i][0], kOerebro[i][1]}, demo->to_map(pairs[i].p_a));
    const auto merged = acg.update(slam.graph());
    const auto rigid = fit_similarity({pairs[0], pairs[1]});
    if (!merged || !rigid) {
      std::printf("Oerebro seed %d: %s\n", static_cast<int>(seed),
                  (merged ? rigid.error() : merged.error()).message.c_str());
      continue;
    }
    const auto error = [&](std::size_t i) {
      return (merged->layout_to_map(pairs[i].p_b) - demo->to_map(pairs[i].p_a)).norm();
    };
    three.push_back(error(2)), four.push_back(error(3));
    three_before.push_back((*rigid * pairs[2].p_b - pairs[2].p_a).norm());
    four_before.push_back((*rigid * pairs[3].p_b - pairs[3].p_a).norm());
  }
  std::printf(
      "\nOerebro pixel pairs, 1 and 2 used, %zu runs: third %.2f m (two clicks %.2f), fourth %.2f m (%.2f), worst %.2f "
      "m\n",
      three.size(), median_of(three), median_of(three_before), median_of(four), median_of(four_before),
      three.empty()
          ? 0
          : std::max(*std::max_element(three.begin(), three.end()), *std::max_element(four.begin(), four.end())));
}

}  // namespace

const std::vector<std::string>& data_rows() {
  static const std::vector<std::string> names{"Halmstad E5", "Halmstad F5", "Oerebro pixel pairs"};
  return names;
}

void print_data_rows(const std::string& data, const std::string& only) {
  for (const std::string& name : data_rows()) {
    if (name.find(only) == std::string::npos) continue;
    if (name == "Oerebro pixel pairs")
      print_oerebro(data);
    else
      print_halmstad(data, name.substr(name.size() - 2));
  }
}

}  // namespace smokemap::bench
