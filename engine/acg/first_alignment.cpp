#include "acg/first_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>
#include <utility>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kCell_m = 0.05;
constexpr double kMargin_m = 3;
constexpr std::size_t kMaxHits = 240;
constexpr int kMaxSide_cells = 4000;
constexpr double kMostLooks = 25;  ///< independent ones at most, however much was seen
constexpr double kLook_m = 1.0;    ///< hits nearer to each other are one look
constexpr std::size_t kKeep = 5;   ///< alignments that are handed on for a closer look

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
    cv::Mat walls(static_cast<int>(size.y() / cell_m_) + 1, static_cast<int>(size.x() / cell_m_) + 1, CV_8U,
                  cv::Scalar(255));
    for (const PlanEdge& w : plan.walls) {
      if (!w.usable) continue;
      const Point2 a = (plan.corners[static_cast<std::size_t>(w.corner_a)] - low_) / cell_m_;
      const Point2 b = (plan.corners[static_cast<std::size_t>(w.corner_b)] - low_) / cell_m_;
      const int thickness = std::max(1, static_cast<int>(std::lround(2 * w.half_thickness_m / cell_m_)));
      cv::line(walls, {static_cast<int>(a.x()), static_cast<int>(a.y())},
               {static_cast<int>(b.x()), static_cast<int>(b.y())}, cv::Scalar(0), thickness);
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

/// A way to lay the plan: p_layout = robot_layout + A diag(1 / scale) A^T R(-turn) (p_map - robot_map), A = plan axes.
struct Trial {
  Point2 robot_layout = Point2::Zero();
  double turn = 0;  ///< of the plan in map
  Eigen::Vector2d scale = Eigen::Vector2d::Ones();
  double score = -1;

  Eigen::Matrix2d layout_from_map(double axis_rad) const {
    const Eigen::Matrix2d axes = Pose2(0, 0, axis_rad).rotation();
    return axes * scale.cwiseInverse().asDiagonal() * axes.transpose() * Pose2(0, 0, -turn).rotation();
  }
};

double score_of(const WallField& field, double axis_rad, const std::vector<Point2>& hits_rel, const Trial& t) {
  const Eigen::Matrix2d m = t.layout_from_map(axis_rad);
  float sum = 0;
  for (const Point2& p : hits_rel)
    sum += field(t.robot_layout.x() + m(0, 0) * p.x() + m(0, 1) * p.y(),
                 t.robot_layout.y() + m(1, 0) * p.x() + m(1, 1) * p.y());
  return static_cast<double>(sum) / static_cast<double>(hits_rel.size());
}

struct Span {
  double reach = 0, step = 1;
};

/// What a guess costs against the share of hits on walls: half a squared sigma is worth one look among so many. It
/// holds to the end: a few hits along one wall do not turn the plan farther than the guess allows.
struct Prior {
  Trial guess;
  double looks = kMostLooks, sigma_m = 1, sigma_rad = 1, scale_sigma = 1;

  double cost(const Trial& t) const {
    return 0.5 / looks *
           ((t.robot_layout - guess.robot_layout).squaredNorm() / (sigma_m * sigma_m) +
            std::pow(wrap_angle(t.turn - guess.turn) / sigma_rad, 2) +
            (t.scale.array() / guess.scale.array()).log().matrix().squaredNorm() / (scale_sigma * scale_sigma));
  }
};

/// What the search needs at every step.
struct Scene {
  const WallField& field;
  double axis_rad = 0;
  const std::vector<Point2>& hits_rel;
  const Prior* prior = nullptr;  ///< null: anywhere is as good

  double score(const Trial& t) const { return score_of(field, axis_rad, hits_rel, t) - (prior ? prior->cost(t) : 0); }
};

/// How far apart two trials put the things around the robot.
bool alike(const Trial& a, const Trial& b, double metres) {
  return (a.robot_layout - b.robot_layout).norm() < metres && std::abs(wrap_angle(a.turn - b.turn)) < 0.3;
}

/// All trials on a lattice around the centre; the best few that are not alike, best first.
std::vector<Trial> lattice(const Scene& scene, const Trial& center, const Span& shift, const Span& turn,
                           const Span& scale, std::size_t keep, double apart_m) {
  std::vector<Trial> all;
  const auto steps = [](const Span& s) { return static_cast<int>(std::ceil(s.reach / s.step - 1e-9)); };
  for (int u = -steps(scale); u <= steps(scale); ++u)
    for (int v = -steps(scale); v <= steps(scale); ++v)
      for (int h = -steps(turn); h <= steps(turn); ++h)
        for (int y = -steps(shift); y <= steps(shift); ++y)
          for (int x = -steps(shift); x <= steps(shift); ++x) {
            Trial t = center;
            t.robot_layout += shift.step * Point2(x, y);
            t.turn += h * turn.step;
            t.scale = t.scale.cwiseProduct(Eigen::Vector2d(1 + u * scale.step, 1 + v * scale.step));
            t.score = scene.score(t);
            all.push_back(t);
          }
  std::stable_sort(all.begin(), all.end(), [](const Trial& a, const Trial& b) { return a.score > b.score; });
  std::vector<Trial> best;
  for (const Trial& t : all) {
    if (best.size() >= keep) break;
    if (std::none_of(best.begin(), best.end(), [&](const Trial& b) { return alike(b, t, apart_m); })) best.push_back(t);
  }
  return best;
}

Trial refine(const Scene& scene, Trial t) {
  for (const double step : {0.1, 0.04}) {
    const Trial best =
        lattice(scene, t, {step, step}, {0.3 * step, 0.15 * step}, {0.3 * step, 0.3 * step}, 1, 1).front();
    if (best.score > t.score) t = best;
  }
  return t;
}

/// Metres of surface, as squares of a metre that have hits.
double independent_looks(const std::vector<Point2>& hits_rel) {
  std::set<std::pair<int, int>> squares;
  for (const Point2& p : hits_rel)
    squares.emplace(static_cast<int>(std::floor(p.x() / kLook_m)), static_cast<int>(std::floor(p.y() / kLook_m)));
  return std::min(kMostLooks, static_cast<double>(squares.size()));
}

/// Everywhere on a lattice of half a metre, every 5 degrees; the best few dozen are refined.
std::vector<Trial> search_everywhere(const Scene& coarse, const Scene& fine) {
  std::vector<Trial> all;
  std::vector<Point2> few;
  for (std::size_t i = 0; i < coarse.hits_rel.size(); i += 3) few.push_back(coarse.hits_rel[i]);
  const Point2 low = coarse.field.low(), high = coarse.field.high();
  const double step = std::max(0.4, (high - low).maxCoeff() / 100);
  for (double y = low.y(); y < high.y(); y += step)
    for (double x = low.x(); x < high.x(); x += step)
      for (int h = 0; h < 72; ++h) {
        Trial t{{x, y}, h * kPi / 36, Eigen::Vector2d::Ones(), -1};
        t.score = score_of(coarse.field, coarse.axis_rad, few, t);
        all.push_back(t);
      }
  const std::size_t keep = std::min<std::size_t>(all.size(), 60);
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(keep), all.end(),
                    [](const Trial& a, const Trial& b) { return a.score > b.score; });
  all.resize(keep);
  std::vector<Trial> refined;
  for (Trial t : all) {
    t = lattice(coarse, t, {0.4, 0.2}, {0.08, 0.04}, {0.1, 0.1}, 1, 1).front();
    t.score = fine.score(t);
    refined.push_back(refine(fine, t));
  }
  return refined;
}

/// Best first, those that ended in the same place once.
std::vector<Trial> distinct(std::vector<Trial> trials, double apart_m, std::size_t keep) {
  std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.score > b.score; });
  std::vector<Trial> out;
  for (const Trial& t : trials)
    if (out.size() < keep && std::none_of(out.begin(), out.end(), [&](const Trial& o) { return alike(o, t, apart_m); }))
      out.push_back(t);
  return out;
}

}  // namespace

Point2 PlanPlacement::operator*(const Point2& p_layout) const {
  const Eigen::Matrix2d axes = Pose2(0, 0, axis_rad).rotation();
  return shift_map + Pose2(0, 0, turn_rad).rotation() * axes * scale.asDiagonal() * axes.transpose() * p_layout;
}

Point2 PlanPlacement::inverse(const Point2& p_map) const {
  const Eigen::Matrix2d axes = Pose2(0, 0, axis_rad).rotation();
  return axes * scale.cwiseInverse().asDiagonal() * axes.transpose() * Pose2(0, 0, -turn_rad).rotation() *
         (p_map - shift_map);
}

PlanPlacement PlanPlacement::from(const Similarity2& s, double axis_rad) {
  return {s.T_a_b.heading(), Eigen::Vector2d::Constant(s.scale), axis_rad, s.T_a_b.translation()};
}

std::vector<Point2> first_hits(const std::vector<NodeView>& views, const GraphState& state, double way_m,
                               double reach_m) {
  std::vector<Point2> all;
  double way = 0;
  std::size_t before = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].robot != views.front().robot) continue;
    way += (state.pose(i).translation() - state.pose(before).translation()).norm();
    before = i;
    if (way > way_m) break;
    const Pose2 pose = state.pose(i);
    // Pieces rather than single hits: people and small things have none.
    for (const ScanPiece& p : views[i].pieces)
      for (double s = 0.05; s < p.segment.length(); s += 0.15) {
        const Point2 q = p.segment.a + s * p.segment.direction();
        if (q.norm() < reach_m) all.push_back(pose * q);
      }
  }
  std::vector<Point2> thinned;
  const std::size_t step = all.size() / kMaxHits + 1;
  for (std::size_t i = 0; i < all.size(); i += step) thinned.push_back(all[i]);
  return thinned;
}

Result<std::vector<PlanAlignment>> align_plan(const PlanModel& plan, const std::vector<Point2>& hits_map,
                                              const Point2& robot_map, const StartSearch& search) {
  if (hits_map.size() < 20) return fail(Errc::kDegenerate, "too little seen to align the plan");
  std::vector<Point2> hits_rel;
  for (const Point2& p : hits_map) hits_rel.push_back(p - robot_map);
  const WallField coarse_field(plan, 0.35), fine_field(plan, 0.15);
  std::optional<Prior> prior;
  if (search.guess)
    prior = Prior{{search.guess->inverse() * robot_map, search.guess->T_a_b.heading(),
                   Eigen::Vector2d::Constant(search.guess->scale), -1},
                  independent_looks(hits_rel),
                  search.sigma_m,
                  search.sigma_rad,
                  search.scale_sigma};
  const Prior* const held = prior ? &*prior : nullptr;
  const Scene coarse{coarse_field, plan.axis_rad, hits_rel, held}, fine{fine_field, plan.axis_rad, hits_rel, held};
  std::vector<Trial> trials;
  if (prior) {
    const double shift = std::clamp(2.5 * search.sigma_m, 0.2, 2.5),
                 turn = std::clamp(2.5 * search.sigma_rad, 0.05, 0.6);
    for (Trial t : lattice(coarse, prior->guess, {shift, std::max(0.15, shift / 8)}, {turn, std::max(0.03, turn / 6)},
                           {2 * search.scale_sigma, search.scale_sigma}, kKeep, 0.3)) {
      t.score = fine.score(t);
      trials.push_back(refine(fine, t));
    }
    trials = distinct(trials, 0.2, kKeep);
  } else {
    trials = distinct(search_everywhere(coarse, fine), 1.0, kKeep);
  }
  std::vector<PlanAlignment> out;
  for (const Trial& t : trials) {
    PlanAlignment a;
    a.placement = {t.turn, t.scale, plan.axis_rad, Point2::Zero()};
    a.placement.shift_map = robot_map - a.placement * t.robot_layout;
    if (!search.guess && trials.size() > 1)
      a.margin = (t.score - (&t == &trials.front() ? trials[1] : trials.front()).score) / std::max(1e-6, t.score);
    int near = 0;
    for (const Point2& p : hits_map) {
      const Point2 q = a.placement.inverse(p);
      near += fine_field(q.x(), q.y()) > std::exp(-0.5 * std::pow(0.2 / 0.15, 2));
    }
    a.explained = near / static_cast<double>(hits_map.size());
    out.push_back(a);
  }
  return out;
}

}  // namespace smokemap
