#include "slam/slam_params.hpp"

#include "core/check.hpp"

namespace smokemap {

Result<Ok> PointParams::validate() const {
  return ParamCheck("PointParams")
      .in_range("farthest_m", farthest_m, 1, 200)
      .in_range("spacing_m", spacing_m, 0.005, 1)
      .in_range("most_points", most_points, 20, 5000)
      .in_range("line_radius_m", line_radius_m, 0.02, 2)
      .in_range("line_steps", line_steps, 0, 50)
      .positive("line_rms_m", line_rms_m)
      .in_range("least_points", least_points, 3, most_points)
      .result();
}

Result<Ok> AlignParams::validate() const {
  return ParamCheck("AlignParams")
      .in_range("iterations", iterations, 1, 200)
      .in_range("last_gate_m", last_gate_m, 0.005, 5)
      .in_range("gate_m", gate_m, last_gate_m, 5)
      .in_range("reach_m", reach_m, 0.01, 5)
      .positive("sigma_point_m", sigma_point_m)
      .in_range("normals_within", normals_within, -1, 1)
      .positive("stop_m", stop_m)
      .positive("stop_rad", stop_rad)
      .result();
}

Result<Ok> FrontEndParams::validate() const {
  return ParamCheck("FrontEndParams")
      .in_range("cell_m", cell_m, 0.02, 2)
      .positive("node_every_m", node_every_m)
      .positive("node_every_rad", node_every_rad)
      .in_range("map_nodes", map_nodes, 1, 1000)
      .positive("map_reach_m", map_reach_m)
      .in_range("good_score", good_score, 0, 1)
      .in_range("least_score", least_score, 0, good_score)
      .in_range("fair_score", fair_score, 0, least_score)
      .positive("search_m", search_m)
      .in_range("search_rad", search_rad, 0, kPi)
      .positive("sparse_step_m", sparse_step_m)
      .positive("sparse_step_rad", sparse_step_rad)
      .in_range("sigma_odometry_share", sigma_odometry_share, 0, 10)
      .in_range("sigma_turn_share", sigma_turn_share, 0, 10)
      .positive("sigma_odometry_m", sigma_odometry_m)
      .positive("sigma_odometry_rad", sigma_odometry_rad)
      .positive("fastest_mps", fastest_mps)
      .positive("fastest_radps", fastest_radps)
      .in_range("lost_after_scans", lost_after_scans, 1, 10000)
      .result();
}

Result<Ok> LoopParams::validate() const {
  return ParamCheck("LoopParams")
      .positive("search_every_m", search_every_m)
      .positive("least_way_m", least_way_m)
      .in_range("within_sigmas", within_sigmas, 0.5, 20)
      .in_range("drift_share", drift_share, 0, 1)
      .positive("sigma_base_m", sigma_base_m)
      .positive("sigma_base_rad", sigma_base_rad)
      .in_range("search_most_m", search_most_m, 0.1, 50)
      .in_range("search_rad", search_rad, 0, kPi)
      .in_range("cell_m", cell_m, 0.02, 2)
      .in_range("least_search_score", least_search_score, 0, 1)
      .in_range("least_align_score", least_align_score, 0, 1)
      .in_range("unique_within", unique_within, 0.8, 1)
      .in_range("joint_nodes", joint_nodes, 1, 50)
      .in_range("most_through", most_through, 0, 1)
      .in_range("bold_sigmas", bold_sigmas, 0, within_sigmas)
      .in_range("most_through_bold", most_through_bold, 0, most_through)
      .in_range("bold_score_more", bold_score_more, 0, 1 - least_align_score)
      .positive("alike_apart_m", alike_apart_m)
      .result();
}

Result<Ok> GraphParams::validate() const {
  return ParamCheck("GraphParams")
      .positive("loop_kernel", loop_kernel)
      .in_range("agrees_within", agrees_within, 0, loop_kernel)
      .positive("pair_reach_m", pair_reach_m)
      .in_range("pairs_per_node", pairs_per_node, 0, 200)
      .in_range("least_pair_score", least_pair_score, 0, 1)
      .in_range("pair_information", pair_information, 1e-6, 1)
      .in_range("polish_rounds", polish_rounds, 0, 50)
      .result();
}

Result<Ok> RadarParams::validate() const {
  if (const Result<Ok> part = align.validate(); !part) return part;
  if (const Result<Ok> part = walkers.validate(); !part) return part;
  return ParamCheck("RadarParams")
      .in_range("strongest", strongest, 1, 200)
      .positive("least_power", least_power)
      .in_range("nearest_m", nearest_m, 0, 50)
      .in_range("farthest_m", farthest_m, nearest_m, 500)
      .positive("surface_radius_m", surface_radius_m)
      .in_range("surface_azimuths", surface_azimuths, 0, 50)
      .positive("spacing_m", spacing_m)
      .in_range("behind_share", behind_share, 0, 1)
      .positive("lasting_within_m", lasting_within_m)
      .in_range("cell_m", cell_m, 0.02, 2)
      .in_range("good_score", good_score, 0, 1)
      .in_range("least_score", least_score, 0, good_score)
      .in_range("fair_score", fair_score, 0, least_score)
      .in_range("least_search_score", least_search_score, 0, 1)
      .in_range("least_align_score", least_align_score, 0, 1)
      .in_range("least_pair_score", least_pair_score, 0, 1)
      .result();
}

Result<Ok> WalkerParams::validate() const {
  return ParamCheck("WalkerParams")
      .positive("widest_m", widest_m)
      .positive("together_m", together_m)
      .positive("apart_m", apart_m)
      .positive("same_place_m", same_place_m)
      .in_range("wheels_share", wheels_share, 0, 1)
      .in_range("proof_m", proof_m, same_place_m, 20)
      .in_range("most_share", most_share, 0, 1)
      .result();
}

SlamParams SlamParams::for_radar() const {
  SlamParams params = *this;
  params.align = radar.align;
  params.front_end.cell_m = radar.cell_m;
  params.front_end.good_score = radar.good_score;
  params.front_end.least_score = radar.least_score;
  params.front_end.fair_score = radar.fair_score;
  params.loops.least_search_score = radar.least_search_score;
  params.loops.least_align_score = radar.least_align_score;
  params.graph.least_pair_score = radar.least_pair_score;
  return params;
}

Result<Ok> SlamParams::validate() const {
  for (const Result<Ok>& part : {points.validate(), align.validate(), front_end.validate(), loops.validate(),
                                 graph.validate(), radar.validate(), walkers.validate()})
    if (!part) return part;
  return ParamCheck("SlamParams")
      .require("T_map_start", T_map_start.is_finite(), "must be finite")
      .in_range("beams.usable_range_m", beams.usable_range_m, 0, 1000)
      .result();
}

}  // namespace smokemap
