#pragma once

#include <vector>

#include "maps/correspondence.hpp"
#include "matching/hypotheses.hpp"

namespace smokemap {

/// What speaks for a pair, each 0..1.
struct PairEvidence {
  double certainty = 0;  ///< against the alternatives of the region, all weighed together
  double likeness = 0;   ///< place and size
  double agreement = 0;  ///< of the other hypotheses, weighted by how good they are
};

/// How likely a hypothesis is for each time that the best one is, 0..1.
double weight_beside(const Hypothesis& hypothesis, const Hypothesis& best);

PairEvidence weigh_pair(const RegionPair& pair, const std::vector<Hypothesis>& all);

/// How sure a pair is: of those said to be 0.9 sure, nine in ten are right.
///
/// A logistic of the evidence, given that both maps are of one building (same_building.hpp, with whose sketches it was
/// fitted, none, one and two rooms tapped; nothing was lowered for caution). `./run bench interpretation` prints what
/// came true of other generated sketches and of KTH and E5.
double confidence_of(const PairEvidence& evidence);

}  // namespace smokemap
