#include "acg/first_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace smokemap {
namespace {

constexpr double kCell_m = 0.05;
constexpr double kMargin_m = 3;
constexpr std::size_t kMaxHits = 240;
constexpr int kMaxSide_cells = 4000;

/// How well a point of the layout lies on a wall: 1 on a face, falling to 0.
class WallField {
 public:
  WallField(const PlanModel& plan, double sigma_m) {
    low_ = plan.corners.front();
    Point2 high = low_;
    for (const Point2& p : plan.corners) low_ = low_.cwiseMin(p), high = high.cwiseMax(p);
    low_.array() -= kMargin_m;
    const Point2 size = (high - low_).array() + kMargin_m;
    cell_m_ = std::max(kCell_m, size.maxCoeff() / kMaxSide_cells);
    cv::Mat walls(static_cast<int>(size.y() / cell_m_) + 1, static_cast<int>(size.x() / cell_m_) + 1, CV_8U, cv::Scalar(255));
    for (const PlanEdge& w : plan.walls) {
      if (!w.usable) continue;
      const Point2 a = (plan.corners[static_cast<std::size_t>(w.corner_a)] - low_) / cell_m_;
      const Point2 b = (plan.corners[static_cast<std::size_t>(w.corner_b)] - low_) / cell_m_;
      const int thickness = std::max(1, static_cast<int>(std::lround(2 * w.half_thickness_m / cell_m_)));
      cv::line(walls, {static_cast<int>(a.x()), static_cast<int>(a.y())}, {static_cast<int>(b.x()), static_cast<int>(b.y())},
               cv::Scalar(0), thickness);
    }
    cv::Mat distance;
    cv::distanceTransform(walls, distance, cv::DIST_L2, 5);
    value_.create(distance.size(), CV_32F);
    for (int y = 0; y < distance.rows; ++y)
      for (int x = 0; x < distance.cols; ++x) {
        const double d = distance.at<float>(y, x) * cell_m_ / sigma_m;
        value_.at<float>(y, x) = static_cast<float>(std::exp(-0.5 * d * d));
      }
  }
  float operator()(double x, double y) const {
    const int column = static_cast<int>((x - low_.x()) / cell_m_), row = static_cast<int>((y - low_.y()) / cell_m_);
    if (column < 0 || row < 0 || column >= value_.cols || row >= value_.rows) return 0;
    return value_.at<float>(row, column);
  }
  const Point2& low() const { return low_; }
  Point2 high() const { return low_ + cell_m_ * Point2(value_.cols, value_.rows); }

 private:
  Point2 low_ = Point2::Zero();
  double cell_m_ = kCell_m;
  cv::Mat value_;
};

/// The plan turned by -heading as seen from the robot: p_layout = robot_layout + R(-turn) (p_map - robot_map) / scale.
struct Trial {
  Point2 robot_layout = Point2::Zero();
  double turn = 0;   ///< of the plan in map
  double scale = 1;  ///< of the plan's metres
  double score = -1;
};

double score_of(const WallField& field, const std::vector<Point2>& hits_rel, const Trial& t) {
  const double c = std::cos(-t.turn) / t.scale, s = std::sin(-t.turn) / t.scale;
  float sum = 0;
  for (const Point2& p : hits_rel)
    sum += field(t.robot_layout.x() + c * p.x() - s * p.y(), t.robot_layout.y() + s * p.x() + c * p.y());
  return static_cast<double>(sum) / static_cast<double>(hits_rel.size());
}

struct Span {
  double reach = 0, step = 1;
};

/// All trials on a lattice around the centre, best few first; trials that are near a better one are left out.
std::vector<Trial> lattice(const WallField& field, const std::vector<Point2>& hits, const Trial& center, const Span& shift,
                           const Span& turn, const Span& scale, const AlignmentSearch* prior, std::size_t keep) {
  std::vector<Trial> all;
  const auto steps = [](const Span& s) { return static_cast<int>(std::ceil(s.reach / s.step - 1e-9)); };
  for (int k = -steps(scale); k <= steps(scale); ++k)
    for (int h = -steps(turn); h <= steps(turn); ++h)
      for (int y = -steps(shift); y <= steps(shift); ++y)
        for (int x = -steps(shift); x <= steps(shift); ++x) {
          Trial t = center;
          t.robot_layout += shift.step * Point2(x, y);
          t.turn += h * turn.step;
          t.scale *= 1 + k * scale.step;
          t.score = score_of(field, hits, t);
          if (prior != nullptr)
            t.score -= 0.02 * (std::pow(shift.step * std::hypot(x, y) / prior->sigma_m, 2) +
                               std::pow(h * turn.step / prior->sigma_rad, 2) + std::pow(std::log(t.scale) / prior->scale_sigma, 2));
          all.push_back(t);
        }
  std::stable_sort(all.begin(), all.end(), [](const Trial& a, const Trial& b) { return a.score > b.score; });
  std::vector<Trial> best;
  for (const Trial& t : all) {
    if (best.size() >= keep) break;
    const bool near = std::any_of(best.begin(), best.end(), [&](const Trial& b) {
      return (b.robot_layout - t.robot_layout).norm() < 0.8 && std::abs(wrap_angle(b.turn - t.turn)) < 0.3;
    });
    if (!near) best.push_back(t);
  }
  return best;
}

Trial refine(const WallField& field, const std::vector<Point2>& hits, Trial t) {
  for (const double step : {0.1, 0.04}) {
    Trial best = lattice(field, hits, t, {2 * step, step}, {0.3 * step, 0.15 * step}, {0.6 * step, 0.3 * step}, nullptr, 1).front();
    if (best.score > t.score) t = best;
  }
  return t;
}

/// Everywhere on a half-metre lattice, every 5 degrees; the best dozen are refined.
std::vector<Trial> search_everywhere(const WallField& coarse, const WallField& fine, const std::vector<Point2>& hits) {
  std::vector<Trial> all;
  std::vector<Point2> few;
  for (std::size_t i = 0; i < hits.size(); i += 3) few.push_back(hits[i]);
  const Point2 size = coarse.high() - coarse.low();
  const double step = std::max(0.4, size.maxCoeff() / 100);
  for (double y = coarse.low().y(); y < coarse.high().y(); y += step)
    for (double x = coarse.low().x(); x < coarse.high().x(); x += step)
      for (int h = 0; h < 72; ++h) {
        Trial t{{x, y}, h * kPi / 36, 1, -1};
        t.score = score_of(coarse, few, t);
        all.push_back(t);
      }
  const std::size_t keep = std::min<std::size_t>(all.size(), 60);
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(keep), all.end(),
                    [](const Trial& a, const Trial& b) { return a.score > b.score; });
  all.resize(keep);
  std::vector<Trial> refined;
  for (Trial t : all) {
    t = lattice(coarse, hits, t, {0.4, 0.2}, {0.08, 0.04}, {0.15, 0.05}, nullptr, 1).front();
    t.score = score_of(fine, hits, t);
    refined.push_back(refine(fine, hits, t));
  }
  std::stable_sort(refined.begin(), refined.end(), [](const Trial& a, const Trial& b) { return a.score > b.score; });
  return refined;
}

}  // namespace

std::vector<Point2> first_hits(const std::vector<NodeView>& views, const GraphState& state, double way_m) {
  std::vector<Point2> all;
  double way = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (i > 0) way += (state.pose(i).translation() - state.pose(i - 1).translation()).norm();
    if (way > way_m) break;
    const Pose2 pose = state.pose(i);
    // Pieces rather than single hits: furniture and people have few long ones.
    for (const ScanPiece& p : views[i].pieces)
      for (double s = 0.05; s < p.segment.length(); s += 0.15)
        all.push_back(pose * (p.segment.a + s * p.segment.direction()));
  }
  std::vector<Point2> thinned;
  const std::size_t step = all.size() / kMaxHits + 1;
  for (std::size_t i = 0; i < all.size(); i += step) thinned.push_back(all[i]);
  return thinned;
}

Result<PlanAlignment> align_plan(const PlanModel& plan, const std::vector<Point2>& hits_map, const Point2& robot_map,
                             const AlignmentSearch& search) {
  if (hits_map.size() < 20) return fail(Errc::kDegenerate, "too little seen to align the plan");
  std::vector<Point2> hits;
  for (const Point2& p : hits_map) hits.push_back(p - robot_map);
  const WallField coarse(plan, 0.35), fine(plan, 0.15);
  Trial best;
  PlanAlignment out;
  out.margin = 1;
  if (search.guess) {
    const Trial start{search.guess->inverse() * robot_map, search.guess->T_a_b.heading(), search.guess->scale, -1};
    const double shift = std::clamp(2.5 * search.sigma_m, 0.2, 2.5), turn = std::clamp(2.5 * search.sigma_rad, 0.05, 0.6);
    best = lattice(coarse, hits, start, {shift, std::max(0.15, shift / 8)}, {turn, std::max(0.03, turn / 8)},
                   {2 * search.scale_sigma, 0.5 * search.scale_sigma}, &search, 1)
               .front();
    best.score = score_of(fine, hits, best);
    best = refine(fine, hits, best);
  } else {
    const auto all = search_everywhere(coarse, fine, hits);
    best = all.front();
    for (const Trial& t : all)
      if ((t.robot_layout - best.robot_layout).norm() > 1.0 || std::abs(wrap_angle(t.turn - best.turn)) > 0.4) {
        out.margin = (best.score - t.score) / std::max(1e-6, best.score);
        break;
      }
  }
  Similarity2& s = out.map_from_layout;
  s.scale = best.scale;
  const Pose2 turn(0, 0, best.turn);
  s.T_a_b = Pose2(robot_map - best.scale * (turn * best.robot_layout), best.turn);
  int near = 0;
  const double exp_20cm = std::exp(-0.5 * std::pow(0.2 / 0.15, 2));
  for (const Point2& p : hits_map) {
    const Point2 q = s.inverse() * p;
    near += fine(q.x(), q.y()) > exp_20cm;
  }
  out.explained = near / static_cast<double>(hits_map.size());
  return out;
}

}  // namespace smokemap
