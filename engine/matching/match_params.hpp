#pragma once

#include "core/result.hpp"

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

}  // namespace smokemap
