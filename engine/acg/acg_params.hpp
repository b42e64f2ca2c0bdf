#pragma once

#include "core/result.hpp"

namespace smokemap {

/// One set for all buildings.
struct AcgParams {
  // What a drawn plan is worth.
  double sigma_wall_log_length = 0.10;  ///< a wall may be drawn 10 % too long or short
  double sigma_wall_turn_rad = 0.01;    ///< against the turn of the whole plan, besides the error of its corners
  double sigma_corner_draw_m = 0.05;    ///< how far a corner is off its drawn line
  double stretch_length_m = 4.0;        ///< over this length the local stretch changes

  // What a sensor saw.
  double sigma_point_m = 0.03;        ///< lidar point to wall face
  double sigma_end_m = 0.05;          ///< end of a wall (door jamb) as seen
  double sigma_seen_corner_m = 0.08;  ///< crossing of two faces against the plan's corner
  double min_piece_m = 0.25;          ///< shorter straight pieces of a scan say nothing about a wall
  double node_spacing_m = 0.35;       ///< nodes nearer to the one before (and turned less than 20 degrees) are left out

  // Association.
  double gate_start_m = 1.0;
  double gate_end_m = 0.25;
  double gate_angle_rad = 0.35;
  int rounds = 4;         ///< of association and robust solving, for each update
  double mature_m = 0.8;  ///< a wall moves by itself only with evidence over this length (or 30 % of its own)

  // Structure.
  double new_wall_min_m = 1.0;
  double missing_share = 0.5;  ///< of a wall's length that beams went through
  double moved_m = 0.30;       ///< displacement above which a wall counts as moved rather than confirmed

  // Does the plan fit.
  double fits_above = 0.70;      ///< PlanFit::score: right merges of furnished buildings show 0.73 and more
  double fits_not_below = 0.50;  ///< plans of other buildings show 0.35 and less

  int covariance_every = 5;  ///< updates between full computations of sigmas; 1 = always
  Result<Ok> validate() const;
};

}  // namespace smokemap
