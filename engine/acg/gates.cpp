#include "acg/gates.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kNearest_m = 0.20;
constexpr double kPerMetre = 0.30;  ///< three sigma of ten percent
constexpr double kSideways = 0.10;  ///< how much less a known wall tells when it lies beside, not opposite
constexpr double kNothingKnown_m = 0.5;

/// How many metres of unknown stretch lie between two walls of like direction, in the drawing.
double apart_m(const PlanModel& plan, const PlanEdge& wall, const PlanEdge& known) {
  const auto at = [&](int c) -> const Point2& { return plan.corners[static_cast<std::size_t>(c)]; };
  const Segment2 k{at(known.corner_a), at(known.corner_b)};
  const Point2 middle = 0.5 * (at(wall.corner_a) + at(wall.corner_b));
  const double half = 0.5 * wall.length_m, s = along(k, middle) * k.length();
  const double beside = std::max({0.0, -s - half, s - k.length() - half});
  return std::abs(signed_line_distance(k, middle)) + kSideways * beside;
}

}  // namespace

double plan_tension(const PlanModel& plan, const GraphState& state, const AcgParams& params) {
  double sum = 0;
  const double corners = std::sqrt(2.0) * params.sigma_corner_draw_m;
  for (const PlanEdge& wall : plan.walls) {
    const Segment2 now = state.segment(wall);
    const Point2 d = Pose2(0, 0, -state.turn - wall.heading_rad) * Point2(now.b - now.a);
    sum += std::pow((d.x() - wall.length_m) / std::hypot(params.sigma_wall_log_length * wall.length_m, corners), 2) +
           std::pow(d.y() / std::hypot(params.sigma_wall_turn_rad * wall.length_m, corners), 2);
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, plan.walls.size()));
}

std::vector<bool> tense_walls(const PlanModel& plan, const GraphState& state, const AcgParams& params) {
  std::vector<bool> tense;
  for (const PlanEdge& wall : plan.walls) {
    const Segment2 now = state.segment(wall);
    const double heading = state.turn + wall.heading_rad;
    const double across = -std::sin(heading) * (now.b - now.a).x() + std::cos(heading) * (now.b - now.a).y();
    tense.push_back(std::abs(across) > 3 * std::hypot(params.sigma_wall_turn_rad * wall.length_m,
                                                      std::sqrt(2.0) * params.sigma_corner_draw_m));
  }
  return tense;
}

bool mature(const PlanEdge& wall, double linked_m, const AcgParams& params) {
  return linked_m >= std::min(params.mature_m, std::max(0.15, 0.3 * wall.length_m));
}

std::vector<double> wall_gates_m(const PlanModel& plan, const std::vector<WallState>& walls,
                                 const std::vector<double>& linked_m, const AcgParams& params) {
  std::vector<std::size_t> known;
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (walls[w] == WallState::kConfirmed && linked_m[w] > 0.5) known.push_back(w);
  std::vector<double> gates(walls.size(), 0);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    double gate = known.empty() ? kNothingKnown_m : params.gate_start_m;
    for (const std::size_t k : known) {
      if (line_angle_between(plan.walls[w].heading_rad, plan.walls[k].heading_rad) > radians(20)) continue;
      gate = std::min(gate, kNearest_m + kPerMetre * apart_m(plan, plan.walls[w], plan.walls[k]));
    }
    gates[w] = std::clamp(gate, params.gate_end_m, params.gate_start_m);
  }
  return gates;
}

void drop_immature(const std::vector<double>& linked_m, const PlanModel& plan, const AcgParams& params,
                   std::vector<PieceLink>& links) {
  for (PieceLink& link : links) {
    const auto w = static_cast<std::size_t>(link.wall);
    if (!mature(plan.walls[w], linked_m[w], params)) link.weight = 0;
  }
}

void drop_immature(const std::vector<double>& linked_m, const PlanModel& plan, const AcgParams& params,
                   std::vector<CornerLink>& links) {
  for (CornerLink& link : links)
    for (const int wall : link.walls) {
      const auto w = static_cast<std::size_t>(wall);
      if (!mature(plan.walls[w], linked_m[w], params)) link.weight = 0;
    }
}

}  // namespace smokemap
