#pragma once

#include "core/result.hpp"
#include "geometry/pose2.hpp"
#include "maps/laser_scan.hpp"

namespace smokemap {

/// From ranges to the points that are matched.
struct PointParams {
  double farthest_m = 20.0;     ///< hits beyond are drawn but not matched
  double spacing_m = 0.04;      ///< thinned to at least this distance along the scan ...
  int most_points = 180;        ///< ... and wider until at most this many are left
  double line_radius_m = 0.20;  ///< neighbours in which a surface direction is estimated
  double line_steps = 3.2;      ///< and at least this many beams to each side
  double line_rms_m = 0.06;     ///< rougher neighbourhoods have no direction
  int least_points = 20;        ///< fewer: the scan says nothing
  Result<Ok> validate() const;
};

/// Gauss-Newton of points on surfaces.
struct AlignParams {
  int iterations = 12;
  double gate_m = 0.40;          ///< a point this far across from its surface still counts in the first round ...
  double last_gate_m = 0.12;     ///< ... and this far in the last
  double reach_m = 0.60;         ///< a surface is looked for this far along it: points of far walls are sparse
  double sigma_point_m = 0.025;  ///< of a point against its surface
  double normals_within = 0.70;  ///< least cosine between the directions of point and surface
  double stop_m = 5e-4;          ///< a smaller step ends the search
  double stop_rad = 1e-4;
  Result<Ok> validate() const;
};

/// One scan after another.
struct FrontEndParams {
  double cell_m = 0.10;  ///< of the averaged surfaces of the local map
  double node_every_m = 0.30;
  double node_every_rad = 0.25;
  int map_nodes = 60;         ///< nodes that make the local map
  double map_reach_m = 8.0;   ///< and how far from the robot they may stand
  double good_score = 0.55;   ///< less: search instead of refining
  double least_score = 0.35;  ///< less: a match only where it agrees with the prediction
  double fair_score = 0.15;   ///< less: no match
  double search_m = 0.30;     ///< half window of the search, more for longer steps
  double search_rad = 0.35;
  double sparse_step_m = 0.50;  ///< longer steps between scans are always searched
  double sparse_step_rad = 0.40;
  double sigma_odometry_share = 0.10;  ///< of the way driven
  double sigma_turn_share = 0.15;      ///< of the angle turned
  double sigma_odometry_m = 0.03;
  double sigma_odometry_rad = 0.02;
  double fastest_mps = 3.0;  ///< odometry that moves faster has jumped
  double fastest_radps = 4.0;
  int lost_after_scans = 8;  ///< poor matches in a row before a new piece of map is begun
  Result<Ok> validate() const;
};

/// Closing loops.
struct LoopParams {
  double search_every_m = 0.8;  ///< way between nodes that search
  double least_way_m = 6.0;     ///< way driven between two ends of a loop
  double within_sigmas = 3.5;   ///< a loop may correct the graph's own error by this much
  double drift_share = 0.01;    ///< error that edges do not own up to, a metre of way ...
  double sigma_base_m = 0.15;   ///< ... and the least there is
  double sigma_base_rad = 0.03;
  double search_most_m = 6.0;
  double search_rad = 0.50;
  double cell_m = 0.10;              ///< of the search grid
  double least_search_score = 0.55;  ///< mean likelihood of the points
  double least_align_score = 0.60;
  double unique_within = 0.92;      ///< a second place this good makes the loop doubtful
  int joint_nodes = 4;              ///< nodes searched together as one scan
  double most_through = 0.12;       ///< share of the rays of one visit that may pass through what the other saw ...
  double bold_sigmas = 1.0;         ///< ... but of a loop that corrects the graph by more than this
  double most_through_bold = 0.05;  ///< fewer may, of those that tell places along a corridor apart,
  double bold_score_more = 0.10;    ///< and it must fit better by this
  double alike_apart_m = 1.5;       ///< places that look alike lie at least this far apart: see LoopProbation
  Result<Ok> validate() const;
};

/// Solving and polishing the graph.
struct GraphParams {
  double loop_kernel = 3.0;    ///< Cauchy width, in standard deviations
  double agrees_within = 1.0;  ///< sigmas: a loop this near to the graph as it is does not make it be solved at once
  double pair_reach_m = 8.0;   ///< nodes farther apart are not matched with each other
  int pairs_per_node = 10;
  double least_pair_score = 0.40;
  double pair_information = 0.10;  ///< share of the information of a pair's points that is independent
  int polish_rounds = 3;
  Result<Ok> validate() const;
};

/// Telling people who walk from what stands.
struct WalkerParams {
  double widest_m = 0.9;      ///< a person, with his load
  double together_m = 0.2;    ///< hits this near to each other are one thing
  double apart_m = 0.3;       ///< it stands before what the beams beside it hit by at least this
  double proof_m = 0.6;       ///< driven between two scans that show a thing at one place: then it stands
  double same_place_m = 0.1;  ///< along a beam ...
  double wheels_share = 0.1;  ///< ... and this share of the way between: what wheels may be off
  double most_share = 0.5;    ///< where more of the hits are at small things these have to be believed
  Result<Ok> validate() const;
};

/// Power over azimuth and range to points, and how they are matched where the radar works alone. Walls are a beam's
/// width wide and speckled: gates, cells and expectations are several times those of a lidar.
struct RadarParams {
  int strongest = 12;         ///< bins kept per azimuth
  double least_power = 12.0;  ///< times the receiver noise
  double nearest_m = 0.5;
  double farthest_m = 15.0;
  double surface_radius_m = 0.50;  ///< neighbours that make an oriented surface point ...
  double surface_azimuths = 2.5;   ///< ... and at least so many azimuths to each side: far walls are sparse
  double spacing_m = 0.25;
  double behind_share =
      0.5;  ///< an echo behind n others of its azimuth has the weight this^n: mirror images are behind
  double lasting_within_m = 0.30;  ///< echoes are drawn this near to what was seen from another place
  AlignParams align{.iterations = 15,
                    .gate_m = 0.60,
                    .last_gate_m = 0.25,
                    .reach_m = 0.80,
                    .sigma_point_m = 0.08,
                    .normals_within = 0.70,
                    .stop_m = 1e-3,
                    .stop_rad = 2e-4};
  double cell_m = 0.20;
  double good_score = 0.45, least_score = 0.25, fair_score = 0.12;  ///< as in FrontEndParams
  double least_search_score = 0.50, least_align_score = 0.45;       ///< as in LoopParams
  double least_pair_score = 0.30;                                   ///< as in GraphParams
  WalkerParams walkers{.widest_m = 1.4, .together_m = 0.3, .apart_m = 0.5, .same_place_m = 0.2};
  Result<Ok> validate() const;
};

/// One set for all maps. Lengths in metres, angles in radians, sigmas are standard deviations.
struct SlamParams {
  BeamConvention beams;
  Pose2 T_map_start;  ///< of the first scan's robot pose
  PointParams points;
  AlignParams align;
  FrontEndParams front_end;
  LoopParams loops;
  GraphParams graph;
  RadarParams radar;
  WalkerParams walkers;
  Result<Ok> validate() const;
  /// The same with matching as the radar alone needs it.
  SlamParams for_radar() const;
};

}  // namespace smokemap
