#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "geometry/similarity2.hpp"
#include "simulation/building.hpp"

namespace smokemap {

/// How wrong a plan is. Defaults: knowledge of real evacuation plans (thesis, Paper V: local scale varies by about 10
/// %).
struct PlanDistortionParams {
  double sigma_stretch = 0.10;  ///< of the local scale, per axis and per knot interval; 0.1 = ten percent
  double stretch_cut_sigmas = 2.5;
  double knot_spacing_m = 4.0;
  double sigma_corner_m = 0.03;  ///< every corner is off by this besides, per coordinate
  int missing_walls = 0;         ///< inner walls that stand but are not drawn
  int phantom_walls = 0;         ///< drawn, but not there (torn down)
  double min_wall_m = 2.0;       ///< length of missing and phantom walls
  double turn_rad = 0;           ///< of the whole drawing
  double scale = 1;
  Result<Ok> validate() const;
};

/// The smooth part of the distortion, world -> plan: piecewise linear and increasing per axis, then turn and scale.
/// Exactly invertible.
class PlanWarp {
 public:
  struct Axis {
    std::vector<double> knots;  ///< world, increasing
    std::vector<double> drawn;  ///< where they went, increasing
    double forward(double value) const;
    double backward(double value) const;
  };
  PlanWarp() = default;
  PlanWarp(Axis x, Axis y, const Similarity2& after) : x_(std::move(x)), y_(std::move(y)), after_(after) {}
  Point2 operator()(const Point2& p_world) const;
  Point2 inverse(const Point2& p_plan) const;

 private:
  Axis x_, y_;
  Similarity2 after_;
};

/// A wrong plan with the truth about it.
struct DistortedPlan {
  FloorPlan drawn;                   ///< frame: metres of the drawing
  PlanWarp warp;                     ///< without the jitter of the corners
  std::vector<Point2> corner_world;  ///< per drawn corner: its true place (of a phantom's end: where it would be)
  std::vector<int> wall_source;      ///< per drawn wall: index of the true wall, -1 = phantom
  std::vector<int> missing;          ///< true walls that are not drawn
};

/// Draws the plan wrongly. Walls that go missing are inner walls between two rooms; phantoms divide a room in two.
/// Fewer than asked for where the building has no fitting place (see `missing` and `wall_source`).
Result<DistortedPlan> distort(const FloorPlan& building, const PlanDistortionParams& params, std::mt19937_64& random);

}  // namespace smokemap
