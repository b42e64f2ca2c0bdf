#pragma once

#include <random>

#include "simulation/building.hpp"

namespace smokemap {

struct RandomBuildingParams {
  double length_m = 30.0;     ///< along the lower wing
  double depth_m = 20.0;      ///< lower wing plus the other one
  double corridor_m = 2.1;    ///< width between wall centre lines
  double room_depth_m = 4.8;  ///< of the rooms along the corridors, mean
  double min_room_m = 2.8;    ///< along the corridor
  double max_room_m = 6.5;
  double min_door_m = 0.95;  ///< clear width
  double max_door_m = 1.15;
  double double_door_share = 0.3;  ///< rooms with two doors, to the corridor or to a neighbour
  double split_share = 0.15;       ///< rooms divided into an outer and an inner one
  double leaf_share = 0.0;         ///< doors with a leaf that stands open in the true world
  int furniture = 0;               ///< boxes along the walls of rooms
  WallStyle walls;
  Result<Ok> validate() const;
};

/// A two-wing building (an L): a corridor in each wing that meets the other's, rooms of different size on both sides,
/// doors, windows, two exits; about 15 to 25 rooms with the defaults. Every room can be reached by a robot of 0.3 m
/// radius. Deterministic in `random`. kInvalidArgument for bad parameters.
Result<FloorPlan> random_building(const RandomBuildingParams& params, std::mt19937_64& random);

}  // namespace smokemap
