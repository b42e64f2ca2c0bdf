#pragma once

#include <vector>

#include "core/result.hpp"
#include "maps/correspondence.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

enum class MatchMethod {
  kStructure,  ///< ours
  kUrsim,      ///< Robotics 8(2):43, 2019
  kVoronoi     ///< SSRR 2016
};

struct MatchParams {
  MatchMethod method = MatchMethod::kStructure;
  int candidates = 8;              ///< alignments bent and compared in full
  bool allow_many_to_many = true;  ///< two regions of one map may be one region of the other
  bool allow_mirror = false;       ///< a drawing seen from below; only when a person says so

  Result<Ok> validate() const;
};

/// Finds which regions of map a (a sketch, a layout, a robot's partial map) and of map b are the same places.
///
/// Neither scale nor heading nor completeness is assumed. Pins bind the regions they lie in; confirmed and rejected
/// verdicts are kept exactly. What cannot be told is left unmatched, and every pair says how sure it is.
///
/// @param pins      p_a_px on a, p_b_px on b; pins off free space bind the nearest region within 10 px, else nothing
/// @param verdicts  confirmed pairs come back confirmed with confidence 1; rejected ones come back rejected and are
/// never
///                  proposed; proposed ones are ignored; labels that do not exist are kConflict
/// @return pairs, worst confidence first. kDegenerate if a map has no region, kInvalidArgument for bad parameters.
/// Cost: milliseconds for some tens of regions, so it can be re-solved on every tap. Deterministic.
Result<Matching> match(const Segmentation& a, const Segmentation& b, const std::vector<Pin>& pins = {},
                       const std::vector<RegionPair>& verdicts = {}, const MatchParams& params = {});

}  // namespace smokemap
